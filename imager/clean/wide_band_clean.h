#pragma once

#include <vector>

#include "imager/clean/clean.h"
#include "imager/clean/multi_term.h"
#include "imager/taylor/taylor_expansion.h"

namespace misfit::imager {

/// The Taylor terms of what is to be cleaned.
struct WideBand {
  TaylorExpansion expansion;
  const std::vector<Image>& further_dirty;  ///< R_t [t − 1], see TaylorImages
  const std::vector<const Image*>& psf;     ///< P_k [k]
};

/// clean() of several Taylor terms: minor cycles find components with spectra, major cycles predict Σ_t x^t A I_t and image
/// what is left for each term. `input` has those of the first term. Peaks, noise, thresholds and masks are those of R_0, as in
/// tclean; minor cycles go as deep in |y| of TaylorBasis. Throws what clean() does, and std::invalid_argument unless terms,
/// images and `minor` agree.
CleanResult clean(const CleanInput& input, const WideBand& band, const MultiTerm& minor, const CleanOptions& options,
                  CleanState state, const Progress& progress, const CycleProgress& cycle_progress, StageTimes& times);

}  // namespace misfit::imager
