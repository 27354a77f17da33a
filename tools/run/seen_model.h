#pragma once

#include <string>
#include <vector>

#include "imager/beams/row_beams.h"
#include "imager/data/source.h"
#include "imager/plan/gridding_plan.h"
#include "ms_io/measurement_set.h"
#include "ms_io/model_writer.h"
#include "tools/formats/model_image.h"
#include "tools/run/dish_beams.h"

namespace misfit::tools {

/// How the rows of a set see what lies about its phase centre.
struct SetBeams {
  imager::RowBeams rows;
  std::vector<int> fields;          ///< that are selected
  std::vector<std::string> doubts;  ///< what may be wrong with the beams, a sentence each
};

/// The beams of the antennas of a set, each where its row's field points. Throws std::runtime_error that names the antenna or
/// field where antennas have no simple beam, FEED has beams beside the axes of dishes, a field's antennas pointed more than 90°
/// from the phase centre, or a field moves past it.
SetBeams set_beams(const ms_io::MeasurementSet& set, const DishBeams& beams);

/// Numbers that tell beams apart, however they were asked for: the values of patterns at many places over a band, and where
/// they point.
std::vector<double> told_apart_by(const SetBeams& beams, const imager::Observation& observation);

/// True if any field's antennas see any of these places, seen from the phase centre, anywhere in the band.
bool sees_any(const SetBeams& beams, const std::vector<imager::DirectionCosines>& places,
              const imager::Observation& observation);

/// The visibilities of sources [Stokes I, Q, U, V] that dishes see; a list may be empty.
ms_io::Predict seen_sources(std::vector<std::vector<imager::Source>> sources, imager::RowBeams beams, int threads);

/// The visibilities of a model image that dishes see, its planes as image_visibilities() takes them, with the best number of
/// samples_at_once. ModelVisibilities::transform stays empty.
ModelVisibilities seen_image(const StokesPlanes& planes, const imager::ImageGeometry& geometry,
                             const imager::GriddingRequest& request, const ms_io::MeasurementSet& set, imager::RowBeams beams);

}  // namespace misfit::tools
