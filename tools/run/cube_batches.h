#pragma once

#include <vector>

#include "imager/cube/channel_map.h"
#include "imager/plan/plan.h"
#include "ms_io/spectral_frame.h"
#include "tools/run/run_plan.h"

namespace misfit::tools {

/// Samples that a row gives to one plane, at most.
int samples_of_a_row(const imager::CubeSampling& sampling, const std::vector<ms_io::SpectralWindow>& windows);

/// How a cube's planes come to their visibilities.
struct CubeBatches {
  int planes = 1;           ///< whose visibilities are gathered in one pass and held
  bool read_again = false;  ///< there is no room for those of one: it reads the set in every pass of its own
  double memory_bytes = 0;  ///< at the peak
  imager::Decision decision;
};

/// As many as take a quarter of a GiB together, and fit in --memory, or half of the machine's, beside what one plane's images
/// need.
CubeBatches plan_batches(const RunScene& scene, const RunPlan& plan);

/// The planes in batches of nearly the same size, at most `most`.
std::vector<imager::PlaneRange> batches_of(int planes, int most);

}  // namespace misfit::tools
