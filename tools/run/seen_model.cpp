#include "tools/run/seen_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <set>
#include <stdexcept>
#include <utility>

#include "imager/numerics/constants.h"
#include "imager/plan/planned_transform.h"
#include "imager/pointing/seen_image.h"
#include "imager/pointing/seen_sources.h"
#include "tools/base/numbers.h"
#include "tools/run/field_beams.h"

namespace misfit::tools {
namespace {

std::vector<imager::AxisFrame> frames_of(const std::vector<ms_io::FieldPointing>& pointings,
                                         const imager::SkyDirection& centre) {
  std::vector<imager::AxisFrame> frames;
  for (const ms_io::FieldPointing& pointing : pointings) {
    const auto place = static_cast<std::size_t>(pointing.id);
    if (frames.size() <= place) frames.resize(place + 1, imager::AxisFrame({}, centre.dec_rad));
    try {
      frames[place] = {imager::direction_cosines(pointing.direction, centre), centre.dec_rad};
    } catch (const std::invalid_argument&) {
      throw std::runtime_error("antennas of field " + field_words(pointing, pointings) +
                               " pointed more than 90 degrees away from the model; expected --field without it");
    }
  }
  return frames;
}

/// The data that a prediction through beams needs as long as it is used.
struct SeenPlanes {
  std::array<imager::Image, 4> plane;
  imager::PlannedTransform transform;
  imager::RowBeams beams;
  std::array<std::unique_ptr<imager::SeenImage>, 4> seen;

  SeenPlanes(const imager::GriddingRequest& request, imager::RowBeams of_rows)
      : transform(imager::plan_gridding(request)), beams(std::move(of_rows)) {}
};

/// The ends and the middle of its band.
std::vector<double> frequencies_in(const imager::Observation& observation) {
  const double middle = observation.frequency_hz, half = observation.bandwidth_hz / 2;
  return {middle - half, middle, middle + half};
}

std::vector<double> frequencies_of(const ms_io::MeasurementSet& set) {
  std::vector<double> all;
  for (const ms_io::SpectralWindow& window : set.spectral_windows())
    all.insert(all.end(), window.frequency_hz.begin(), window.frequency_hz.end());
  return all;
}

}  // namespace

SetBeams set_beams(const ms_io::MeasurementSet& set, const DishBeams& beams) {
  constexpr double beside = 0.01;
  const ms_io::BeamRows rows = set.beam_rows();
  if (rows.sorts.empty())
    throw std::runtime_error("no row of two antennas is selected; expected some, of which --apply-beam takes the beam");
  std::vector<std::string> doubts;
  std::vector<imager::Pattern> patterns =
      patterns_of(set.antennas(), {rows.sorts, beams, set.observation().frequency_hz}, doubts);
  const double width_rad = narrowest_rad(patterns, set.observation().frequency_hz);
  if (rows.beam_offset_rad() > beside * width_rad)
    throw std::runtime_error("FEED's column BEAM_OFFSET says that beams point " + angle_text(rows.beam_offset_rad(), 3) +
                             " beside the field's direction; expected beams on the axis of their dishes");
  require_still(rows.pointings, width_rad);
  std::vector<int> fields;
  for (const ms_io::FieldPointing& pointing : rows.pointings) fields.push_back(pointing.id);
  return {
      {std::move(patterns), frames_of(rows.pointings, set.observation().phase_centre)}, std::move(fields), std::move(doubts)};
}

std::vector<double> told_apart_by(const SetBeams& beams, const imager::Observation& observation) {
  constexpr int radii = 64, angles = 12;
  std::vector<double> numbers;
  std::map<const imager::VoltagePattern*, double> known;
  for (const imager::Pattern& pattern : beams.rows.of_antennas()) {
    const auto [number, is_new] = known.insert({pattern.get(), static_cast<double>(known.size())});
    numbers.push_back(number->second);
    if (!is_new || !pattern) continue;
    const double reach = std::min(1.0, 4 * pattern->detail_sine(observation.frequency_hz));
    for (const double hz : frequencies_in(observation))
      for (int r = 0; r <= radii; ++r)
        for (int a = 0; a < angles; ++a)
          numbers.push_back(pattern->voltage_at(reach * r / radii, 2 * imager::pi * a / angles, hz));
  }
  for (const int field : beams.fields) {
    const imager::AxisFrame& frame = beams.rows.of_fields()[static_cast<std::size_t>(field)];
    for (const imager::DirectionCosines at : {imager::DirectionCosines{0, 0}, {1e-3, 0}, {0, 1e-3}})
      numbers.push_back(frame.sine(at));
    numbers.push_back(field);
  }
  return numbers;
}

bool sees_any(const SetBeams& beams, const std::vector<imager::DirectionCosines>& places,
              const imager::Observation& observation) {
  constexpr double nothing = 1e-9;
  const std::vector<imager::Pattern>& patterns = beams.rows.of_antennas();
  const std::set<imager::Pattern> different(patterns.begin(), patterns.end());
  for (const int field : beams.fields)
    for (const imager::Pattern& pattern : different) {
      if (!pattern) continue;
      const imager::PairBeam beam{pattern, pattern, beams.rows.of_fields()[static_cast<std::size_t>(field)], 0};
      for (const double hz : frequencies_in(observation))
        if (std::any_of(places.begin(), places.end(), [&](const auto& at) { return beam.power(at, hz) > nothing; }))
          return true;
    }
  return false;
}

ms_io::Predict seen_sources(std::vector<std::vector<imager::Source>> sources, imager::RowBeams beams, int threads) {
  return [sources = std::move(sources), beams = std::move(beams), threads](const imager::SampleCoordinates& at) {
    ms_io::StokesVisibilities visibilities(imager::predict_seen_sources(sources[0], beams, at, threads));
    for (std::size_t k = 1; k < sources.size(); ++k)
      if (!sources[k].empty()) visibilities.plane[k] = imager::predict_seen_sources(sources[k], beams, at, threads);
    return visibilities;
  };
}

ModelVisibilities seen_image(const StokesPlanes& planes, const imager::ImageGeometry& geometry,
                             const imager::GriddingRequest& request, const ms_io::MeasurementSet& set, imager::RowBeams beams) {
  constexpr double part_of_accuracy = 0.1;
  constexpr std::size_t bytes = std::size_t{1} << 32;
  const auto state = std::make_shared<SeenPlanes>(prediction_request(request, geometry, set), std::move(beams));
  const auto different = static_cast<std::size_t>(std::count_if(planes.begin(), planes.end(), [](const auto* p) { return p; }));
  const imager::SeenImageOptions options{part_of_accuracy * (request.accuracy > 0 ? request.accuracy : 1e-6),
                                         bytes / std::max<std::size_t>(1, different), request.threads};
  ModelVisibilities model;
  for (std::size_t k = 0; k < planes.size(); ++k) {
    if (planes[k] == nullptr) continue;
    state->plane[k] = *planes[k];
    state->seen[k] = std::make_unique<imager::SeenImage>(state->transform, state->plane[k], geometry, state->beams,
                                                         frequencies_of(set), options);
    model.samples_at_once = std::max<std::uint64_t>(model.samples_at_once, state->seen[k]->samples_at_once());
  }
  model.predict = [state](const imager::SampleCoordinates& at) {
    ms_io::StokesVisibilities visibilities;
    for (std::size_t k = 0; k < state->seen.size(); ++k)
      if (state->seen[k]) visibilities.plane[k] = state->seen[k]->at(at);
    return visibilities;
  };
  return model;
}

}  // namespace misfit::tools
