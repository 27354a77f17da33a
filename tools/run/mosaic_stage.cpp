#include "tools/run/mosaic_stage.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>
#include <utility>

#include "imager/numerics/constants.h"
#include "ms_io/celestial_frames.h"
#include "ms_io/phase_centre.h"
#include "tools/base/numbers.h"
#include "tools/base/option_checks.h"
#include "tools/run/cube_options.h"
#include "tools/run/dish_beams.h"
#include "tools/run/field_beams.h"
#include "tools/run/seen_model.h"

namespace misfit::tools {
namespace {

/// The tolerance of beams between frequencies, from the accuracy; smaller for beams that turn, which they do in steps.
double beam_tolerance(const ImageOptions& o, const std::vector<imager::Pattern>& patterns) {
  const bool turn = std::any_of(patterns.begin(), patterns.end(), [](const auto& p) { return p && !p->is_round(); });
  const double accuracy = o.gridding.accuracy > 0 ? o.gridding.accuracy : 1e-6;
  return (turn ? 0.01 : 0.1) * accuracy;
}

/// A warning that some pointings see nothing of the image; else empty.
std::string unseeing(const imager::MosaicBeams& beams, const std::vector<ms_io::FieldPointing>& pointings) {
  std::set<imager::Pattern> patterns(beams.rows().of_antennas().begin(), beams.rows().of_antennas().end());
  patterns.erase(nullptr);
  std::string names;
  for (std::size_t p = 0; p < pointings.size(); ++p) {
    const imager::AxisFrame& frame = beams.rows().of_fields()[p];
    if (std::none_of(patterns.begin(), patterns.end(), [&](const auto& pattern) {
          return beams.window({pattern, pattern, frame, 0}).has_value();
        }))
      names += (names.empty() ? "" : ", ") + field_words(pointings[p], pointings);
  }
  return names.empty() ? "" : "antennas of field " + names + " see nothing of the image: their samples add nothing to it";
}

std::vector<imager::AxisFrame> frames_of(const std::vector<ms_io::FieldPointing>& pointings,
                                         const imager::SkyDirection& centre) {
  std::vector<imager::AxisFrame> frames;
  for (const ms_io::FieldPointing& pointing : pointings) {
    try {
      frames.emplace_back(imager::direction_cosines(pointing.direction, centre), centre.dec_rad);
    } catch (const std::invalid_argument&) {
      throw std::runtime_error("antennas of field " + field_words(pointing, pointings) +
                               " pointed more than 90 degrees away from the mosaic; expected --field without it");
    }
  }
  return frames;
}

std::vector<double> frequencies_of(const ms_io::MeasurementSet& set) {
  std::vector<double> all;
  for (const ms_io::SpectralWindow& window : set.spectral_windows())
    all.insert(all.end(), window.frequency_hz.begin(), window.frequency_hz.end());
  return all;
}

/// A pixel, and the reason for it.
struct PsfPixel {
  int row = 0;
  int column = 0;
  std::string where;
};

bool sees(const imager::MosaicBeams& beams, imager::DirectionCosines at) {
  constexpr double enough = 0.5;
  for (const imager::AxisFrame& frame : beams.rows().of_fields())
    for (const imager::Pattern& pattern : beams.rows().of_antennas())
      if (pattern && beams.power({pattern, pattern, frame, 0}, at, beams.low_hz()) >= enough) return true;
  return false;
}

/// The pixel nearest to a direction. Throws std::runtime_error where it is none of the image's.
PsfPixel pixel_at(imager::DirectionCosines at, const imager::ImageGeometry& g, std::string where) {
  const double column = g.centre_column() - (at.l - g.centre.l) / g.cell_rad;
  const double row = g.centre_row() + (at.m - g.centre.m) / g.cell_height_rad();
  if (!(column >= 0 && column <= g.width - 1 && row >= 0 && row <= g.height - 1))
    throw std::runtime_error(where + " lies outside the image; expected a direction within it");
  return {static_cast<int>(std::lround(row)), static_cast<int>(std::lround(column)), std::move(where)};
}

PsfPixel psf_pixel(const ImageOptions& o, const imager::MosaicBeams& beams) {
  const imager::ImageGeometry& g = beams.geometry();
  if (!o.mosaic.psfphasecenter.empty()) {
    const std::string where = "--psfphasecenter " + o.mosaic.psfphasecenter;
    ms_io::Selection centred;
    try {
      centred = ms_io::phased_to({}, o.mosaic.psfphasecenter, o.vis);
    } catch (const std::runtime_error&) {  // which names --phasecenter
    }
    if (!centred.phase_centre)
      throw std::runtime_error(where +
                               ": expected a direction, such as 'J2000 12h30m49.4s +12d23m28s', or a field that stands "
                               "still, by its id or name");
    try {
      return pixel_at(imager::direction_cosines(ms_io::in_frame(*centred.phase_centre, g.phase_centre.frame), g.phase_centre),
                      g, where);
    } catch (const std::invalid_argument&) {
      throw std::runtime_error(where + " lies more than 90 degrees from the image; expected a direction within it");
    }
  }
  if (sees(beams, g.centre)) return {g.centre_row(), g.centre_column(), "the middle of the image"};
  const auto distance = [&](const imager::AxisFrame& frame) {
    return std::hypot(frame.axis().l - g.centre.l, frame.axis().m - g.centre.m);
  };
  const std::vector<imager::AxisFrame>& frames = beams.rows().of_fields();
  const auto nearest =
      std::min_element(frames.begin(), frames.end(), [&](const auto& a, const auto& b) { return distance(a) < distance(b); });
  const imager::DirectionCosines at = nearest->axis();
  const auto within = [](double value, double low, double high) {
    return std::clamp(value, std::min(low, high), std::max(low, high));
  };
  return pixel_at({within(at.l, g.l(0), g.l(g.width - 1)), within(at.m, g.m(0), g.m(g.height - 1))}, g,
                  "the pointing nearest to the middle, which no beam sees above half its peak");
}

}  // namespace

bool is_mosaic(const ImageOptions& o, const ms_io::MeasurementSet& set) {
  if (o.gridding.gridder != "auto" || o.force_average || o.phasecenter.empty()) return false;
  try {
    const ms_io::BeamRows rows = set.beam_rows();
    const ApartOptions apart{set.observation().frequency_hz, true, DishBeams(o.primary_beam.beam)};
    if (rows.sorts.empty() || rows.pointings.size() < 2 || notes_on_apart_fields(rows, apart).decisions.empty()) return false;
    for (const imager::AntennaSort& sort : rows.sorts) apart.beams.of(sort);
    for (const ms_io::FieldPointing& one : rows.pointings)
      for (const ms_io::FieldPointing& other : rows.pointings)
        if (&one != &other && one.set == other.set && one.id == other.id) return false;  // it moves
  } catch (const std::runtime_error&) {                                                  // averaging reports it
    return false;
  }
  return true;
}

double pointing_tolerance_rad(const ImageOptions& o, const ms_io::MeasurementSet& set) {
  const DishBeams dishes(o.primary_beam.beam);
  std::vector<imager::Pattern> patterns;
  for (const imager::AntennaSort& sort : set.beam_rows().sorts) patterns.push_back(dishes.of(sort).pattern);
  return std::max(o.gridding.accuracy, same_pointing_beams) * narrowest_rad(patterns, set.observation().frequency_hz);
}

MosaicStage mosaic_stage(const ImageOptions& o, const ms_io::MeasurementSet& set, const imager::ImageGeometry& geometry,
                         double max_abs_w) {
  constexpr double beside = 0.01;
  MosaicStage stage;
  const ms_io::BeamRows rows = set.beam_rows();
  if (rows.sorts.empty())
    throw std::runtime_error("no row of two antennas is selected; expected some, whose beams make a mosaic");
  const ms_io::SightTable& table = set.sight_table();
  const double hz = set.observation().frequency_hz;
  const DishBeams dishes(o.primary_beam.beam);
  std::vector<imager::Pattern> patterns;
  try {
    patterns = patterns_of(table.antennas, {rows.sorts, dishes, hz}, stage.warnings);
  } catch (const imager::NoSimpleBeam& none) {
    throw std::runtime_error(std::string("--gridder mosaic: ") + none.what());
  }
  const double width_rad = narrowest_rad(patterns, hz);
  if (rows.beam_offset_rad() > beside * width_rad)
    throw std::runtime_error("FEED's column BEAM_OFFSET says that beams point " + angle_text(rows.beam_offset_rad(), 3) +
                             " beside the field's direction; expected beams on the axis of their dishes");
  if (!o.mosaic.usepointing) require_still(rows.pointings, width_rad);
  const double tolerance = beam_tolerance(o, patterns);
  const auto beams = std::make_shared<const imager::MosaicBeams>(
      imager::MosaicScene{geometry, imager::RowBeams(std::move(patterns), frames_of(table.pointings, geometry.phase_centre)),
                          frequencies_of(set), o.cube.is_cube(), o.mosaic.beam_cut, tolerance, max_abs_w});
  const PsfPixel psf = psf_pixel(o, *beams);
  stage.request = std::make_shared<const imager::MosaicRequest>(
      imager::MosaicRequest{beams, psf.row, psf.column, o.mosaic.normtype == "flatnoise"});
  if (const std::string blind = unseeing(*beams, table.pointings); !blind.empty()) stage.warnings.push_back(blind);
  stage.decisions = {
      {"pointings", std::to_string(table.pointings.size()),
       o.mosaic.usepointing ? "where POINTING says that antennas looked, grouped to " +
                                  angle_text(pointing_tolerance_rad(o, set), 3) + ", which changes beams by " +
                                  significant(150 * pointing_tolerance_rad(o, set) / width_rad, 2) + "% of their peak at most"
                            : "fields, whose antennas looked where FIELD says"},
      {"mosaic's PSF", "of a source at pixel " + std::to_string(psf.column) + ", " + std::to_string(psf.row), psf.where},
      {"normtype", o.mosaic.normtype,
       stage.request->flat_noise ? "images are the sky times .pb, the same noise everywhere; so is .model"
                                 : "images are the sky, with more noise where beams see less"}};
  return stage;
}

std::shared_ptr<const imager::MosaicRequest> seen_request(const ImageOptions& o, const ms_io::MeasurementSet& set,
                                                          const imager::ImageGeometry& geometry) {
  imager::RowBeams rows = set_beams(set, DishBeams(o.primary_beam.beam)).rows;
  const double tolerance = beam_tolerance(o, rows.of_antennas());
  const auto beams = std::make_shared<const imager::MosaicBeams>(
      imager::MosaicScene{geometry, std::move(rows), frequencies_of(set), false, o.mosaic.beam_cut, tolerance});
  return std::make_shared<const imager::MosaicRequest>(imager::MosaicRequest{beams});
}

imager::Image limited_beam(const imager::Image& beam, const TypedPrimaryBeam& o) {
  imager::Image limited = beam;
  for (double& pixel : limited.pixel)
    if (!(pixel >= o.limit())) pixel = std::nan("");
  return limited;
}

}  // namespace misfit::tools
