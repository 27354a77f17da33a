#include "imager/clean/scaled_psf.h"

#include <algorithm>
#include <cmath>

#include "imager/clean/gaussian_blur.h"
#include "imager/numerics/parallel.h"

namespace misfit::imager {
namespace {

/// The rows and columns [first, last] of an image about its middle pixel.
struct Cut {
  int first_row, last_row, first_column, last_column;

  Cut grown(int by) const { return {first_row - by, last_row + by, first_column - by, last_column + by}; }
  Cut within(const Cut& o) const {
    return {std::max(first_row, o.first_row), std::min(last_row, o.last_row), std::max(first_column, o.first_column),
            std::min(last_column, o.last_column)};
  }
  int rows() const { return last_row - first_row + 1; }
  int columns() const { return last_column - first_column + 1; }
};

Cut whole(const Image& psf) {
  const int row = psf.height / 2, column = psf.width / 2;
  return {-row, psf.height - 1 - row, -column, psf.width - 1 - column};
}

/// An image whose middle pixel, as of a PSF, lies at (row, column).
struct Placed {
  Image image;
  int row, column;
};

/// Makes a cut of a PSF that is convolved with a Gaussian, as if nothing lay beyond the PSF.
Placed convolved(const Image& psf, const Cut& cut, double fwhm_pixels, int threads) {
  const Cut from = cut.grown(static_cast<int>(gaussian_taps(fwhm_pixels).size()) - 1).within(whole(psf));
  Image taken(from.columns(), from.rows());
  for (int r = 0; r < taken.height; ++r)
    std::copy_n(psf.row(r + from.first_row + psf.height / 2) + from.first_column + psf.width / 2, taken.width, taken.row(r));
  return {gaussian_blur(taken, fwhm_pixels, threads), -from.first_row, -from.first_column};
}

double peak_of(const Image& psf, double fwhm_pixels, int threads) {
  if (fwhm_pixels == 0) return psf.at(psf.height / 2, psf.width / 2);
  const Placed middle = convolved(psf, {0, 0, 0, 0}, fwhm_pixels, threads);
  return middle.image.at(middle.row, middle.column);
}

MeritForm merit_form(const TaylorBasis& basis, double bias) {
  MeritForm form{};
  for (std::size_t q = 0; q < static_cast<std::size_t>(basis.terms()); ++q) {
    TaylorValues unit{};
    unit[q] = std::sqrt(bias / basis.peak());
    const TaylorValues y = basis.coordinates(unit);
    for (std::size_t a = 0; a < most_taylor_terms; ++a) form.row[a][q] = static_cast<float>(y[a]);
  }
  return form;
}

/// The number of tiles beyond which another ring of tiles changes little: beyond the main lobes of two components of the
/// largest scale.
int near_tiles_of(double largest_scale_pixels) {
  constexpr int least = 4, most = 8;
  return std::clamp(static_cast<int>(std::ceil(2.75 * std::sqrt(2.0) * largest_scale_pixels / bright_tile_side)), least, most);
}

}  // namespace

ScaledPsf::ScaledPsf(const std::vector<const Image*>& psf, const MultiscaleOptions& options)
    : terms_(static_cast<int>(psf.size() + 1) / 2), near_tiles_(near_tiles_of(options.scale_pixels.back())) {
  constexpr double least_peak = 1e-4;
  for (const LookedAt& scale : scales_looked_at(options)) {
    std::vector<double> peaks;
    for (const Image* image : psf) peaks.push_back(peak_of(*image, std::sqrt(2.0) * scale.pixels, options.threads));
    if (!scale_.empty() && !(peaks.front() > least_peak * scale_.front().basis.peak())) continue;
    const TaylorBasis basis(peaks);
    scale_.push_back({scale, basis, merit_form(basis, scale.bias)});
  }
  const std::vector<LookedAt> looked_at = this->looked_at();
  const std::size_t scales = scale_.size();
  Cut cut = whole(*psf.front());
  const int reach = (near_tiles_ + 1) * bright_tile_side;
  if (scales > 1) cut = cut.within({-reach, reach, -reach, reach});
  first_row_ = cut.first_row, last_row_ = cut.last_row;
  first_column_ = cut.first_column, last_column_ = cut.last_column;
  stride_ = cut.columns() + 2 * margin;
  core_.resize(scales * scales * psfs());
  strength_.resize(scales * scales);
  for (std::size_t a = 0; a < scales; ++a)
    for (std::size_t b = 0; b <= a; ++b) {
      const double fwhm = std::hypot(looked_at[a].pixels, looked_at[b].pixels);
      for (std::size_t k = 0; k < psfs(); ++k) {
        if (fwhm == 0) {
          keep(*psf[k], psf[k]->height / 2, psf[k]->width / 2, options.threads);
        } else {
          const Placed of_both = convolved(*psf[k], cut, fwhm, options.threads);
          keep(of_both.image, of_both.row, of_both.column, options.threads);
        }
        core_[(a * scales + b) * psfs() + k] = core_[(b * scales + a) * psfs() + k] = middle_of(kept_.back());
      }
      const Strength strength = strength_of(at(a, b, 0, 0, 0));
      const auto in_merit = [&](std::size_t to) {
        const double by = scale_[to].form.row[0][0];
        return Strength{strength.rms * by, strength.rms_beyond * by, strength.largest_beyond * by};
      };
      strength_[a * scales + b] = in_merit(b);
      strength_[b * scales + a] = in_merit(a);
    }
}

std::vector<LookedAt> ScaledPsf::looked_at() const {
  std::vector<LookedAt> result;
  for (const Scale& scale : scale_) result.push_back(scale.looked_at);
  return result;
}

void ScaledPsf::keep(const Image& psf, int middle_row, int middle_column, int threads) {
  const std::size_t rows = static_cast<std::size_t>(last_row_ - first_row_) + 1 + std::size_t{2} * margin;
  BigArray<float>& kept = kept_.emplace_back();
  kept.reserve(rows * static_cast<std::size_t>(stride_));
  parallel_for(rows, threads, [&](std::size_t at) {
    const int row = static_cast<int>(at) - margin + first_row_;
    float* const to = kept.data() + static_cast<std::ptrdiff_t>(at) * stride_;
    std::fill_n(to, stride_, 0.0F);
    if (row < first_row_ || row > last_row_) return;
    const double* const from = psf.row(row + middle_row) + middle_column;
    for (int c = first_column_; c <= last_column_; ++c)
      if (!std::isnan(from[c])) to[margin + c - first_column_] = static_cast<float>(from[c]);
  });
}

const float* ScaledPsf::middle_of(const BigArray<float>& kept) const {
  return kept.data() + (margin - first_row_) * stride_ + margin - first_column_;
}

bool ScaledPsf::reaches(int row, int column) const {
  return row <= last_row_ && row + bright_tile_side > first_row_ && column <= last_column_ &&
         column + bright_tile_side > first_column_;
}

ScaledPsf::Strength ScaledPsf::strength_of(const float* core) const {
  struct Sum {
    double squares = 0;
    std::size_t count = 0;

    void add(double square) { squares += square, ++count; }
    double rms() const { return count == 0 ? 0 : std::sqrt(squares / static_cast<double>(count)); }
  } anywhere, beyond;
  const int near = near_tiles_ * bright_tile_side;
  Strength result;
  for (int r = first_row_; r <= last_row_; ++r)
    for (int c = first_column_; c <= last_column_; ++c) {
      const double value = std::abs(core[r * stride_ + c]);
      if (r != 0 || c != 0) anywhere.add(value * value);
      if (std::max(std::abs(r), std::abs(c)) <= near) continue;
      beyond.add(value * value);
      result.largest_beyond = std::max(result.largest_beyond, value);
    }
  result.rms = anywhere.rms();
  result.rms_beyond = beyond.rms();
  return result;
}

}  // namespace misfit::imager
