#include "imager/clean/scaled_psf.h"

#include <algorithm>
#include <cmath>

#include "imager/clean/gaussian_blur.h"

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

/// A cut of a PSF, convolved with a Gaussian, as if nothing lay beyond the PSF.
Image convolved_cut(const Image& psf, const Cut& cut, double fwhm_pixels, int threads) {
  const int margin = fwhm_pixels == 0 ? 0 : static_cast<int>(gaussian_taps(fwhm_pixels).size()) - 1;
  const Cut from = cut.grown(margin).within(whole(psf));
  Image taken(from.columns(), from.rows());
  for (int r = 0; r < taken.height; ++r) {
    const double* const row = psf.row(r + from.first_row + psf.height / 2) + from.first_column + psf.width / 2;
    std::transform(row, row + taken.width, taken.row(r), [](double x) { return std::isnan(x) ? 0 : x; });
  }
  if (margin > 0) taken = gaussian_blur(taken, fwhm_pixels, threads);
  Image result(cut.columns(), cut.rows());
  for (int r = 0; r < result.height; ++r)
    std::copy_n(taken.row(r + cut.first_row - from.first_row) + cut.first_column - from.first_column, result.width,
                result.row(r));
  return result;
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

/// Where the next ring of tiles changes little: beyond the main lobes of two components of the largest scale.
int near_tiles_of(double largest_scale_pixels) {
  constexpr int least = 4, most = 8;
  return std::clamp(static_cast<int>(std::ceil(2.75 * std::sqrt(2.0) * largest_scale_pixels / bright_tile_side)), least, most);
}

}  // namespace

ScaledPsf::ScaledPsf(const std::vector<const Image*>& psf, const MultiscaleOptions& options)
    : terms_(static_cast<int>(psf.size() + 1) / 2), near_tiles_(near_tiles_of(options.scale_pixels.back())) {
  const std::vector<LookedAt> looked_at = scales_looked_at(options);
  const std::size_t scales = looked_at.size();
  Cut cut = whole(*psf.front());
  const int reach = (near_tiles_ + 1) * bright_tile_side;
  if (scales > 1) cut = cut.within({-reach, reach, -reach, reach});
  first_row_ = cut.first_row, last_row_ = cut.last_row;
  first_column_ = cut.first_column, last_column_ = cut.last_column;
  constexpr int margin = bright_tile_side;
  stride_ = cut.columns() + 2 * margin;
  core_.resize(scales * scales * psfs());
  strength_.resize(scales * scales);
  for (std::size_t s = 0; s < scales; ++s) {
    std::vector<double> peaks;
    for (const Image* image : psf)
      peaks.push_back(convolved_cut(*image, {0, 0, 0, 0}, std::sqrt(2.0) * looked_at[s].pixels, options.threads).at(0, 0));
    const TaylorBasis basis(peaks);
    scale_.push_back({looked_at[s], basis, merit_form(basis, looked_at[s].bias)});
  }
  for (std::size_t a = 0; a < scales; ++a)
    for (std::size_t b = 0; b <= a; ++b) {
      for (std::size_t k = 0; k < psfs(); ++k) {
        const Image of_both =
            convolved_cut(*psf[k], cut, std::hypot(looked_at[a].pixels, looked_at[b].pixels), options.threads);
        std::vector<float>& kept =
            kept_.emplace_back(static_cast<std::size_t>(cut.rows() + 2 * margin) * static_cast<std::size_t>(stride_));
        for (int r = 0; r < of_both.height; ++r)
          std::copy_n(of_both.row(r), of_both.width, kept.data() + (r + margin) * stride_ + margin);
        const float* const middle = kept.data() + (margin - first_row_) * stride_ + margin - first_column_;
        core_[(a * scales + b) * psfs() + k] = core_[(b * scales + a) * psfs() + k] = middle;
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
