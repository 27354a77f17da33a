#pragma once

#include <complex>
#include <deque>
#include <vector>

#include "imager/clean/components.h"
#include "imager/clean/padded_fft.h"
#include "imager/clean/scaled_psf.h"
#include "imager/data/image.h"

namespace misfit::imager {

/// Fourier transforms by which residuals of several Taylor terms are convolved with scales, and components taken off them.
class ScaledFft {
 public:
  /// Takes PSFs P_k [k].
  ScaledFft(const std::vector<const Image*>& psf, const std::vector<LookedAt>& scales, int threads);

  using Half = PaddedFft<float>::Half;
  using Read = PaddedFft<float>::Read;
  using Write = PaddedFft<float>::Write;

  void forward(const Read& read, Half& to) const { fft_.forward(read, to); }
  /// Convolves an image with a scale, in the pixels at which that scale is looked at.
  void convolve(const Half& image, std::size_t scale, const Write& write) const;
  /// Σ_t P_{q+t} ⋆ model_t, convolved with a scale. `model` [term].
  void respond(const std::vector<const Half*>& model, std::size_t term, std::size_t scale, const Write& write) const;

 private:
  void filter(int u, std::size_t scale, std::complex<float>* value) const;

  std::vector<LookedAt> scale_;
  PaddedFft<float> fft_;
  std::deque<PaddedFft<float>::Spectrum> psf_;  ///< [k], over the number of pixels of the FFT
  std::vector<std::vector<float>> along_u_;     ///< [scale][u], part of a wave that the Gaussian leaves; empty for points
  std::vector<std::vector<float>> along_v_;
};

/// The residuals of all Taylor terms, convolved with each scale, in single precision: NaN where no component may lie. Its
/// units make the brightest pixel as good as 1.
class ScaledResidual {
 public:
  /// `residual` [term]; components may lie where `mask`, if there is one, allows, and no residual is NaN.
  ScaledResidual(const std::vector<const Image*>& residual, const Image* mask, const ScaledPsf& psf, const ScaledFft& fft,
                 int threads);

  struct Plane {
    int step = 1;
    int width = 0, height = 0;             ///< pixels looked at
    std::deque<BigArray<float>> residual;  ///< [term][row][column]

    const float* row(std::size_t term, int r) const { return residual[term].data() + static_cast<std::ptrdiff_t>(r) * width; }
    float* row(std::size_t term, int r) { return residual[term].data() + static_cast<std::ptrdiff_t>(r) * width; }
  };
  const Plane& plane(std::size_t scale) const { return plane_[scale]; }
  double unit_jy() const { return unit_jy_; }
  int width() const { return width_; }
  int height() const { return height_; }

  /// Robust noise of the first term where components may lie, of a sample of its pixels.
  double noise_jy() const;

  /// Takes components off everything.
  void subtract(const ComponentModel& found);

 private:
  void load(std::size_t term, const Image& residual);
  void transform(const ComponentModel& found, int term, ScaledFft::Half& to) const;
  void forbid(const std::vector<const Image*>& residual, const Image* mask);

  const ScaledPsf& psf_;
  const ScaledFft& fft_;
  int threads_;
  int width_;
  int height_;
  double unit_jy_ = 1;
  std::deque<Plane> plane_;  ///< [scale]
};

}  // namespace misfit::imager
