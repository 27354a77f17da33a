#pragma once

#include <memory>
#include <string>
#include <vector>

#include "imager/data/ranks.h"
#include "imager/files/image_reader.h"
#include "ms_io/measurement_set.h"

namespace misfit::tools {

/// A set that a model is predicted for, and remarks for users on the direction that it is phased to.
struct PhasedSet {
  std::unique_ptr<ms_io::MeasurementSet> set;
  std::vector<std::string> remarks;
};

struct PhasedSetRequest {
  std::string vis;
  std::string phasecenter;  ///< as ms_io::phased_to() takes it; may be empty
  ms_io::Selection selection;
  double accuracy = 1e-6;  ///< of what is predicted
};

/// Throws std::runtime_error where the image `file`, which `path` names, moves along with another target than the set, as far
/// as its way is told. `sets` names them.
void require_same_target(const std::string& path, const imager::ImageReader& file, const ms_io::MeasurementSet& set,
                         const std::string& sets);

/// This rank's part of the set, phased to `phasecenter`, or else to the direction that the components of a list are about.
/// Directions on the sky stand still where a field moves, and offsets from the phase centre move along.
PhasedSet set_for_components(const PhasedSetRequest& request, const std::string& list, const imager::Ranks& ranks);

/// This rank's part of the set, phased to the reference of the image at `model`, about which its pixels lie exactly where its
/// header has them. Images of what a field follows move along with it, as do all where `phasecenter` is TRACKFIELD; others
/// stand still. Throws std::runtime_error where an image that moves along is for data that do not, or `phasecenter` is more
/// than a pixel away from its reference.
PhasedSet set_for_image(const PhasedSetRequest& request, const std::string& model, const imager::Ranks& ranks);

}  // namespace misfit::tools
