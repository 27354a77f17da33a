#pragma once

#include <Eigen/Core>
#include <functional>

#include "kernels/piecewise_polynomial.h"

namespace misfit::kernels {

/// Everything here is derived from the taps alone, however they are evaluated.

/// h at many x.
using Correction = std::function<Eigen::VectorXd(const Eigen::VectorXd& x)>;

/// How taps are judged.
struct JudgeOptions {
  /// The taps are smooth in t only between multiples of 1/(2·steps_per_cell), as are the taps of a lookup table of
  /// steps_per_cell entries a cell; 0 = smooth over the cell. For taps that carry the rounding of single precision, 64 average
  /// it to 2%.
  int steps_per_cell = 0;
  Correction correction = {};  ///< h that the image is multiplied by; empty = the optimal one
};

/// The optimal correction h(x) = c(x) / Σ_n c(x−n)², where c(x) = ∫ C(u) exp(2πiux) du: it minimises the map error at every x
/// (Ye, Gull, Tan & Nikolic 2020, MNRAS 491, 1146). The image is multiplied by h(x)·h(y); x is the pixel's offset from the
/// phase centre over the size of the FFT. For `steps_per_cell` see JudgeOptions.
Eigen::VectorXd optimal_correction(const TapFunction& taps, const Eigen::VectorXd& x, int steps_per_cell = 0);

/// The map error ℓ(x) = ∫ dν |1 − h(x) Σ_r C(r−ν) exp(2πi(r−ν)x)|² (ibid.), as a sum of squares: exact down to the
/// square of the rounding of doubles.
Eigen::VectorXd map_error(const TapFunction& taps, const Eigen::VectorXd& x, const JudgeOptions& options = {});
/// The taper c(x) = ∫ C(u) exp(2πiux) du that gridding leaves on an image; the correction in common use is 1/c.
Eigen::VectorXd image_taper(const TapFunction& taps, const Eigen::VectorXd& x, int steps_per_cell = 0);

/// The correction in common use, 1/c(x).
Correction reciprocal_taper(const TapFunction& taps);

/// The correction in common use of gridders that divide a visibility's taps by their sum, whose taper is about c(x)/c(0):
/// c(0)/c(x).
Correction relative_reciprocal_taper(const TapFunction& taps);

/// How far a kernel is from the exact transform over |x| ≤ x0; squares of relative errors of a one-dimensional transform.
struct Misfit {
  double mean = 0;        ///< E: mean of ℓ over |x| ≤ x0
  double max = 0;         ///< largest ℓ over |x| ≤ x0
  double worst_mean = 0;  ///< mean over |x| ≤ x0 of the squared error at the worst position of a visibility in its cell
  double worst = 0;       ///< largest squared error over |x| ≤ x0 and all positions
};

Misfit judge(const TapFunction& taps, double x0, const JudgeOptions& options = {});

/// The misfit over the pixels of an image, x = (−pixels/2 … (pixels−1)/2) / fft_size with integer division, for images whose
/// pixels are too few to be a continuum.
Misfit judge_pixels(const TapFunction& taps, int pixels, int fft_size);

/// How much the correction amplifies noise that is white over the cells of the grid, as rounding is, relative to the image of
/// one visibility: √(mean of h² over |x| ≤ x0) · √(∫ C² du). Near x0 = ½ it grows without limit, since there h makes up for c →
/// 0.
double noise_gain(const TapFunction& taps, double x0);

/// The noise gain at the x where it is largest: max of |h| over |x| ≤ x0 · √(∫ C² du).
double largest_noise_gain(const TapFunction& taps, double x0);

}  // namespace misfit::kernels
