#pragma once

#include <memory>
#include <vector>

#include "imager/taylor/taylor_expansion.h"
#include "imager/transform/transform.h"

namespace misfit::imager {

/// V = Σ_t x^t A I_t, for a model image of each term.
class TaylorPrediction : public Prediction {
 public:
  /// Throws std::invalid_argument unless there is a model for each term.
  TaylorPrediction(const Transform& transform, std::vector<Image> models, const TaylorExpansion& expansion);

  std::vector<std::complex<double>> at(const SampleCoordinates& coordinates) const override;
  std::vector<std::complex<double>> at_usable(const VisibilityBlock& block) const override;
  std::vector<std::vector<std::complex<double>>> at_usable_of(const std::vector<const VisibilityBlock*>& blocks) const override;
  std::size_t samples_at_once() const override;
  double fft_s() const override;

 private:
  TaylorExpansion expansion_;
  std::vector<std::unique_ptr<Prediction>> term_;
};

/// Sets x^k V [k − first][row][channel] of visibilities [row][channel], for each power k in [first, last].
struct TaylorPowers {
  int first = 0;
  int last = 0;
};
std::vector<std::vector<std::complex<double>>> taylor_sets(const TaylorExpansion& expansion,
                                                           const SampleCoordinates& coordinates,
                                                           const std::vector<std::complex<double>>& visibility,
                                                           const TaylorPowers& powers);

}  // namespace misfit::imager
