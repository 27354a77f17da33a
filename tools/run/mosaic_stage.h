#pragma once

#include <memory>
#include <string>
#include <vector>

#include "imager/plan/gridding_choice.h"
#include "imager/plan/plan.h"
#include "ms_io/measurement_set.h"
#include "tools/run/image_options.h"

namespace misfit::tools {

/// True if --gridder auto makes a mosaic of these sets: fields that point apart, of antennas whose beams are known, are phased
/// to one centre, and are not to be averaged.
bool is_mosaic(const ImageOptions& options, const ms_io::MeasurementSet& set);

/// The largest angle between antennas' directions that count as one pointing. Reads antennas of all rows.
double pointing_tolerance_rad(const ImageOptions& options, const ms_io::MeasurementSet& set);

/// The request for a mosaic, made from what sets tell of antennas and pointings.
struct MosaicStage {
  std::shared_ptr<const imager::MosaicRequest> request;
  imager::Plan decisions;
  std::vector<std::string> warnings;
};

/// Makes the stage for sets that tell the sights of their rows, with |w| ≤ max_abs_w in wavelengths. Throws std::runtime_error
/// that names the antenna or field where antennas have no simple beam, feeds point beside the axes of their dishes, an antenna
/// pointed more than 90° away, or a field moves past the image.
MosaicStage mosaic_stage(const ImageOptions& options, const ms_io::MeasurementSet& set, const imager::ImageGeometry& geometry,
                         double max_abs_w);

/// The request by which a mosaic's model is predicted for one set, whose rows tell antennas and fields by their ids.
std::shared_ptr<const imager::MosaicRequest> seen_request(const ImageOptions& options, const ms_io::MeasurementSet& set,
                                                          const imager::ImageGeometry& geometry);

/// The primary beam of a mosaic as it is written: NaN below --pblimit.
imager::Image limited_beam(const imager::Image& beam, const TypedPrimaryBeam& options);

}  // namespace misfit::tools
