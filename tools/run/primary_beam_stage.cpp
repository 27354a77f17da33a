#include "tools/run/primary_beam_stage.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "imager/numerics/constants.h"
#include "tools/base/numbers.h"
#include "tools/run/dish_beams.h"
#include "tools/run/field_beams.h"

namespace misfit::tools {
namespace {

constexpr std::uint32_t degrees = 360;

double apart_rad(imager::DirectionCosines a, imager::DirectionCosines b) {
  const double chord = std::hypot(a.l - b.l, a.m - b.m, imager::n_minus_1(a) - imager::n_minus_1(b));
  return 2 * std::asin(std::min(1.0, chord / 2));
}

imager::DirectionCosines on_image(const ms_io::FieldPointing& pointing, const BeamScene& scene) {
  try {
    return imager::direction_cosines(pointing.direction, scene.geometry.phase_centre);
  } catch (const std::invalid_argument&) {
    throw NoPrimaryBeam("antennas of field " + field_words(pointing, scene.rows.pointings) +
                        " pointed more than 90 degrees away from the image; expected one within its hemisphere");
  }
}

}  // namespace

PrimaryBeamStage::PrimaryBeamStage(const TypedPrimaryBeam& o, BeamScene scene, int threads) : scene_(std::move(scene)) {
  view_.limit = o.limit();
  view_.threads = threads;
  if (scene_.rows.sorts.empty()) throw NoPrimaryBeam("no row of two antennas is selected, and a primary beam needs one");
  const DishBeams beams(o.beam);
  for (const imager::AntennaSort& sort : scene_.rows.sorts) {
    try {
      models_.push_back(beams.of(sort));
    } catch (const imager::NoSimpleBeam& error) {
      throw NoPrimaryBeam(error.what());
    }
  }
  const bool round = std::all_of(models_.begin(), models_.end(), [](const auto& model) { return model.pattern->is_round(); });
  if (!round && scene_.zenith_turns) turn_rad_ = scene_.zenith_turns();
  find_pointing();
}

/// Finds the pointing. All fields must point alike, to a thousandth of the beam: at its half-power points that changes it by
/// 0.15%.
void PrimaryBeamStage::find_pointing() {
  constexpr double beside = 0.01;
  width_rad_ = nominal_beam(scene_.frequency_hz).half_power_width_rad();
  const std::vector<ms_io::FieldPointing>& all = scene_.rows.pointings;
  const ms_io::FieldPointing& first = all.front();
  view_.pointing = on_image(first, scene_);
  for (const ms_io::FieldPointing& other : all) {
    const double apart = apart_rad(view_.pointing, on_image(other, scene_));
    const bool itself = other.set == first.set && other.id == first.id;  // at another time
    if (apart > same_pointing_beams * width_rad_)
      throw NoPrimaryBeam(
          "antennas of fields " + field_words(first, all) + " and " + field_words(other, all) + " pointed " +
          angle_text(apart, 3) + " apart" +
          (itself ? "; field and image move past each other: choose some of its time with --timerange, or an image "
                    "that moves as the field does, without --phasecenter or with TRACKFIELD"
                  : "; --gridder mosaic makes one image of them, or select one with " +
                        std::string(first.set == other.set ? "--field" : "--vis")));
  }
  if (scene_.rows.beam_offset_rad() > beside * width_rad_)
    throw NoPrimaryBeam("FEED's column BEAM_OFFSET says that beams point " + angle_text(scene_.rows.beam_offset_rad(), 3) +
                        " beside the field's direction; expected beams on the axis of their dishes");
}

std::uint32_t PrimaryBeamStage::kinds() const {
  const auto sorts = static_cast<std::uint32_t>(models_.size());
  return sorts * sorts * (turn_rad_.empty() ? 1 : degrees);
}

std::uint32_t PrimaryBeamStage::kind_of(std::uint64_t row) const {
  const ms_io::SortPair pair = scene_.rows.pairs.empty() ? ms_io::SortPair{} : scene_.rows.pairs[row];
  const auto of_pair = static_cast<std::uint32_t>(pair.one) * static_cast<std::uint32_t>(models_.size()) + pair.other;
  if (turn_rad_.empty()) return of_pair;
  const long turn = std::lround(turn_rad_[row] * degrees / (2 * imager::pi));
  return of_pair * degrees + static_cast<std::uint32_t>((turn + degrees) % degrees);
}

imager::BeamShare PrimaryBeamStage::beam_share(std::uint32_t kind, double frequency_hz, double weight) const {
  const auto sorts = static_cast<std::uint32_t>(models_.size());
  const std::uint32_t pair = turn_rad_.empty() ? kind : kind / degrees;
  const double turn_rad = turn_rad_.empty() ? 0 : (kind % degrees) * 2 * imager::pi / degrees;
  return {models_[pair / sorts].pattern, models_[pair % sorts].pattern, frequency_hz, weight, turn_rad};
}

imager::PrimaryBeam PrimaryBeamStage::nominal_beam(double frequency_hz) const {
  std::vector<double> rows(kinds());  // [kind]
  for (std::uint64_t row = 0; row < std::max(scene_.rows.pairs.size(), turn_rad_.size()); ++row) ++rows[kind_of(row)];
  if (std::all_of(rows.begin(), rows.end(), [](double count) { return count == 0; })) rows[0] = 1;
  std::vector<imager::BeamShare> shares;
  for (std::uint32_t kind = 0; kind < rows.size(); ++kind) shares.push_back(beam_share(kind, frequency_hz, rows[kind]));
  return imager::PrimaryBeam(shares);
}

imager::Decision PrimaryBeamStage::decision() const {
  std::string because;
  for (const imager::BeamModel& model : models_)
    if (because.find(model.because) == std::string::npos) because += (because.empty() ? "" : "; ") + model.because;
  const double away_rad = apart_rad(view_.pointing, {});
  if (away_rad > 0) because += "; its axis is " + angle_text(away_rad, 3) + " from the phase centre";
  return {"primary beam",
          angle_text(width_rad_, 4) + " wide at half power at " + significant(scene_.frequency_hz / 1e9, 6) +
              " GHz, where it is " + significant(view_.limit, 3) + " or more",
          because};
}

std::vector<std::string> PrimaryBeamStage::doubts() const {
  std::vector<std::string> doubts;
  for (const imager::BeamModel& model : models_) {
    const std::string doubt = model.doubt_at(scene_.frequency_hz);
    if (!doubt.empty() && std::find(doubts.begin(), doubts.end(), doubt) == doubts.end()) doubts.push_back(doubt);
  }
  return doubts;
}

void PrimaryBeamStage::weigh(const imager::VisibilitySource& source) {
  imager::ShareOptions options{scene_.geometry.cell_rad, {}, view_.threads};
  if (kinds() > 1) options.kind_of = [this](std::uint64_t row) { return kind_of(row); };
  shares_ = imager::weight_shares(source, options);
}

std::vector<imager::BeamShare> PrimaryBeamStage::beam_shares() const {
  std::vector<imager::BeamShare> shares;
  for (const imager::WeightShare& s : shares_) shares.push_back(beam_share(s.kind, s.frequency_hz, s.weight));
  return shares;
}

imager::Image PrimaryBeamStage::whole_band() const {
  return image_of(imager::PrimaryBeam(beam_shares()));
}

imager::TaylorBeam PrimaryBeamStage::of_terms(const imager::TaylorExpansion& expansion) const {
  return {beam_shares(), expansion, scene_.geometry, view_};
}

imager::Image PrimaryBeamStage::at(double frequency_hz) const {
  return image_of(nominal_beam(frequency_hz));
}

imager::Image PrimaryBeamStage::image_of(const imager::PrimaryBeam& beam) const {
  return imager::primary_beam_image(beam, scene_.geometry, view_);
}

std::string PrimaryBeamStage::warning_of(const imager::Image& beam) const {
  if (!std::all_of(beam.pixel.begin(), beam.pixel.end(), [](double value) { return std::isnan(value); })) return "";
  return "the primary beam is below --pblimit " + significant(view_.limit, 3) + " in all of the image: the antennas pointed " +
         angle_text(apart_rad(view_.pointing, {}), 3) + " from its phase centre";
}

}  // namespace misfit::tools
