#pragma once

#include <string>
#include <vector>

#include "imager/data/geometry.h"
#include "imager/plan/plan.h"
#include "ms_io/measurement_set.h"
#include "tools/run/dish_beams.h"
#include "tools/run/image_options.h"

namespace misfit::tools {

/// Fields point alike where the directions of their antennas are less apart than this part of a beam between its half-power
/// points: at these points that changes a beam by 0.15%.
constexpr double same_pointing_beams = 1e-3;

/// The angle between two directions of one frame.
double angle_between(const imager::SkyDirection& one, const imager::SkyDirection& other);

/// A field in words, "3 (M51) of a.ms"; without its set where all `pointings` are of one.
std::string field_words(const ms_io::FieldPointing& pointing, const std::vector<ms_io::FieldPointing>& pointings);

/// Throws std::runtime_error where a field's antennas pointed in directions further apart than same_pointing_beams of a beam's
/// width.
void require_still(const std::vector<ms_io::FieldPointing>& pointings, double width_rad);

/// How the antennas of the fields of an image see its centre.
struct FieldNotes {
  imager::Plan decisions;
  std::vector<std::string> warnings;
};

/// How fields that point apart are looked at.
struct ApartOptions {
  double frequency_hz = 0;
  bool force = false;    ///< take fields that do not see the image, too
  DishBeams beams = {};  ///< of the fields' antennas
};

/// Lists fields that point apart: each field's distance from the image's centre and
/// its beam there, that of PrimaryBeamStage for the field's own rows; the distance alone where its antennas have no simple
/// beam. Throws std::runtime_error that names the fields whose dishes all have the centre beyond their first null, unless
/// forced: they dim whatever other fields see.
FieldNotes notes_on_apart_fields(const ms_io::BeamRows& rows, const ApartOptions& options);

/// Lists feeds in use whose BEAM_OFFSETs differ by more than pointings of fields may: each feed's distance from the axis of its
/// dish and its beam at the field's direction. A feed counts as not seeing the image only if no turn of its mount lets it see
/// it.
FieldNotes notes_on_feeds(const ms_io::BeamRows& rows, const ApartOptions& options);

/// Notes on the fields of a run: on fields and feeds that point apart; where all point alike, on antennas that hardly see the
/// image; or on a FIELD or ANTENNA that does not say where they pointed. Throws what notes_on_apart_fields() does without
/// --force-average, and what MeasurementSet::beam_rows() does. Reads antennas of all rows where fields point apart.
FieldNotes notes_on_fields(const ImageOptions& options, const ms_io::MeasurementSet& set,
                           const imager::ImageGeometry& geometry);

}  // namespace misfit::tools
