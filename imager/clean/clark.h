#pragma once

#include <vector>

#include "imager/clean/convolution.h"
#include "imager/clean/minor_cycle.h"
#include "imager/clean/psf_core.h"

namespace misfit::imager {

/// Clark's CLEAN (Clark 1980, A&A 89, 377): components are found among the brightest pixels with the core of the PSF, until
/// the sidelobes beyond the core could have brought another pixel up to them; then all components so far are convolved with the
/// whole PSF and taken off the residual, and the brightest pixels of that are chosen anew. What is left is the residual of the
/// components to single precision; the order in which they were found may differ from Högbom's.
class Clark : public MinorCycle {
 public:
  Clark(const Image& psf, int threads);

  const std::vector<double>& scale_pixels() const override { return scale_pixels_; }

 private:
  MinorCycleReport find(const std::vector<const Image*>& residual, const MinorCycleOptions& options) const override;

  std::vector<double> scale_pixels_{0};
  PsfCore core_;
  Convolution<float> convolution_;
  int threads_;
};

}  // namespace misfit::imager
