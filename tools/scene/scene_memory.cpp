#include "tools/scene/scene_memory.h"

#include <cmath>
#include <complex>
#include <stdexcept>

#include "imager/plan/gridding_plan.h"
#include "imager/plan/memory_use.h"
#include "ms_io/measurement_set.h"
#include "tools/base/memory.h"
#include "tools/base/numbers.h"
#include "tools/run/gridding_options.h"
#include "tools/run/weighting_options.h"

namespace misfit::tools {
namespace {

/// The bytes in GiB, rounded up, so that they are enough.
std::string gib_text(double bytes) {
  return significant(std::ceil(bytes / gib * 100) / 100, 6) + " GiB";
}

imager::TransformMemory largest_transform(const ImageOptions& scene, const ms_io::MeasurementSet& set,
                                          const imager::ImageGeometry& geometry) {
  imager::GriddingRequest request = gridding_request(scene.gridding, 1);
  request.geometry = geometry;
  request.samples = set.samples();
  request.max_abs_w = set.reach().max_abs_w;
  request.psf = false;
  request.accuracy = 0;
  request.kernel_width = 8;
  request.padding = 2;
  request.precision = imager::Precision::double_precision;
  return imager::memory_of(imager::plan_gridding(request));
}

}  // namespace

void check_scene_memory(const ImageOptions& scene) {
  const ms_io::MeasurementSet set(scene.vis, selection_of(scene), scene.datacolumn);
  const imager::ImageGeometry geometry = geometry_of(scene, set.observation().phase_centre);
  const auto samples = static_cast<double>(set.samples());
  const imager::MemoryUse use =
      imager::peak_memory({.transform = largest_transform(scene, set, geometry),
                           .pixels = static_cast<double>(geometry.pixels()),
                           .rows = static_cast<double>(set.rows()),
                           .samples = samples,
                           .block_samples = static_cast<double>(ms_io::MeasurementSet::usual_block_samples),
                           .verify = true,
                           .density = weighting_options(scene.weighting).needs_density()},
                          {.keep = true});
  const double predicted = samples * sizeof(std::complex<double>);
  const double needed = use.total() + predicted;
  const double most = scene.memory_gib > 0 ? scene.memory_gib * gib : physical_memory_bytes();
  if (needed <= most) return;
  throw std::invalid_argument("--imsize " + std::to_string(geometry.width) + " " + std::to_string(geometry.height) +
                              ": expected an image that fits " + (scene.memory_gib > 0 ? "--memory " : "this machine's ") +
                              significant(most / gib, 3) + " GiB; this one needs " + gib_text(needed) +
                              ", of which visibilities take " + gib_text(use.visibilities + predicted));
}

}  // namespace misfit::tools
