#pragma once

#include <memory>
#include <vector>

#include "imager/clean/active_terms.h"
#include "imager/clean/convolution.h"
#include "imager/clean/minor_cycle.h"
#include "imager/clean/scale_places.h"

namespace misfit::imager {

/// The minor cycle of wide-band CLEAN (Rau & Cornwell 2011, A&A 532, A71): components have spectra of n Taylor terms, and are
/// found in the residuals R_q of all of them with the 2n − 1 spectral PSFs P_k,
///
///     R_q = Σ_t P_{q+t} ⋆ I_t + noise.
///
/// The next component lies where a source would take most off χ², which is where |y| of TaylorBasis is largest, and takes
/// `gain` times the principal solution there. Not where the principal solution's I_0 is largest: with three terms over an even
/// band its noise is half as large again as that of R_0, while |y| weighs what the data tell. With one term |y| is the
/// residual's magnitude, and what follows is Clark's CLEAN, or the multiscale one.
///
/// Components are points, or Gaussians of several scales as in Multiscale, with the merit |y|²/P_ss of a scale's own basis.
/// They are found among the brightest pixels (ActiveTerms) and then taken off all residuals, convolved with the whole of the
/// spectral PSFs.
class MultiTerm : public MinorCycle {
 public:
  /// Of PSFs P_k [k], images of one size. Throws std::invalid_argument as Multiscale does, and what TaylorBasis does.
  MultiTerm(const std::vector<const Image*>& psf, const MultiscaleOptions& options);

  const std::vector<double>& scale_pixels() const override { return options_.scale_pixels; }

 private:
  struct Scale {
    double bias;
    double psf_peak;  ///< of P_0, convolved twice
    TermCores cores;
  };
  /// The scale of largest merit.
  struct Choice {
    std::size_t scale = 0;
    double merit = 0;
    double next_merit = 0;        ///< of the best of the others
    std::vector<Image> residual;  ///< [term], convolved with it
    Image brightness;             ///< |y| of that, NaN where it may not be put
  };
  /// The threshold is one of |y|, which |R_0| never exceeds.
  MinorCycleReport find(const std::vector<const Image*>& residual, const MinorCycleOptions& options) const override;
  Choice choose(const std::vector<Image>& left, const ScalePlaces& places) const;
  void find_of_scale(Choice choice, const MinorCycleOptions& options, const MinorCycleWatch& watch,
                     MinorCycleReport& report) const;
  void subtract(const ComponentModel& found, std::vector<Image>& left) const;

  MultiscaleOptions options_;
  TaylorBasis point_;
  std::vector<Scale> scale_;
  std::vector<std::unique_ptr<Convolution<float>>> convolution_;  ///< [k]
};

}  // namespace misfit::imager
