#pragma once

#include <memory>

#include "imager/extent.h"
#include "imager/imaging.h"
#include "imager/plan.h"
#include "ms_io/measurement_set.h"

namespace misfit::tools {

/// Visibilities ready for any number of passes, and what one pass over them told.
struct LoadedVisibilities {
  const imager::VisibilitySource* source = nullptr;  ///< in memory, or the MeasurementSet itself
  std::unique_ptr<imager::VisibilitySource> memory;
  imager::SampleCounts counts;
  imager::WSpread w_spread;
  imager::Plan decisions;
};

/// Reads the set once. What fits half of the machine's memory is kept there; more is read again in every pass. Stage timed:
/// "read". Throws std::runtime_error that counts the reasons when no sample is usable.
LoadedVisibilities load_visibilities(const ms_io::MeasurementSet& set, const imager::Progress& progress,
                                     imager::StageTimes& times);

}  // namespace misfit::tools
