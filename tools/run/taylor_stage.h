#pragma once

#include <optional>
#include <vector>

#include "imager/beams/beam.h"
#include "imager/clean/clean.h"
#include "imager/data/geometry.h"
#include "imager/plan/accurate_imaging.h"
#include "imager/taylor/spectral_index.h"
#include "imager/taylor/taylor_basis.h"
#include "imager/taylor/taylor_imaging.h"

namespace misfit::tools {

/// CLEAN's result of Taylor terms, at the beam's resolution.
struct RestoredTerms {
  imager::Image first;                 ///< the model seen with the beam, and the principal solution of the residuals
  std::vector<imager::Image> further;  ///< [term − 1], the same
  imager::SpectralImages spectra;
};

/// Images of terms after the first that are taken instead of new ones, at rank 0; see TaylorImages.
struct TakenTerms {
  imager::TakenImages which;  ///< the images read are in `images`
  imager::TaylorImages images;
};

/// The Taylor terms of a run of --nterms above 1. As tclean does, restored images have the principal solution H⁻¹ R of the
/// residuals R, whose files have R itself. Stages timed: those of make_taylor_images, and "restore".
class TaylorStage {
 public:
  TaylorStage(const imager::TaylorExpansion& expansion, int threads) : expansion_(expansion), threads_(threads) {}

  const imager::TaylorExpansion& expansion() const { return expansion_; }

  /// Makes the images of further terms, in a pass over the same samples, by the same transforms as the dirty image and the PSF.
  /// The promise of an accuracy holds for these two alone: terms of odd order are weak against their data. Throws
  /// std::runtime_error where the samples' frequencies do not tell the terms apart. `made` stays where it is until CLEAN is
  /// over. Images
  /// that are taken are compared, but for residuals of a model. Throws UnlikeSamples.
  void make_images(const imager::ImagedData& imaged, const imager::AccurateImages& made, TakenTerms taken,
                   const imager::Context& context);
  const std::vector<const imager::Image*>& psf() const { return psf_; }  ///< [k]
  imager::TaylorImages& images() { return images_; }

  /// RMS of x over the samples, to a power: about the size of an image of x^power over the size of the first term's.
  double distance_rms(std::size_t power) const;

  /// H⁻¹ R, Jy/beam [term], of the dirty images.
  std::vector<imager::Image> principal_solution(const imager::Image& dirty) const;
  /// Restores all terms of a result.
  RestoredTerms restore(const imager::CleanResult& cleaned, const imager::Beam& beam, double cell_rad) const;

 private:
  std::vector<imager::Image> principal_solution(const std::vector<const imager::Image*>& residual) const;
  void take(TakenTerms taken, const imager::ComparedPixels& pixels, const imager::AccurateImages& made);

  double x_rms_ = 0;  ///< of the samples
  imager::TaylorExpansion expansion_;
  int threads_;
  imager::TaylorImages images_;
  std::vector<const imager::Image*> psf_;  ///< [k]
  std::optional<imager::TaylorBasis> basis_;
};

}  // namespace misfit::tools
