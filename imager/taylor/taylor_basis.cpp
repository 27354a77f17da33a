#include "imager/taylor/taylor_basis.h"

#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>

#include "imager/numerics/parallel.h"

namespace misfit::imager {
namespace {

using Matrix = TaylorBasis::Matrix;

/// L of H = L Lᵀ; none where the powers are not told apart.
template <typename Peaks>
std::optional<Matrix> cholesky_factor(const Peaks& peaks, std::size_t n) {
  constexpr double least_part = 1e-5;
  Matrix factor{};
  for (std::size_t j = 0; j < n; ++j) {
    double square = peaks[2 * j];
    for (std::size_t k = 0; k < j; ++k) square -= factor[j][k] * factor[j][k];
    if (!(square > least_part * peaks[2 * j])) return std::nullopt;
    factor[j][j] = std::sqrt(square);
    for (std::size_t i = j + 1; i < n; ++i) {
      double value = peaks[i + j];
      for (std::size_t k = 0; k < j; ++k) value -= factor[i][k] * factor[j][k];
      factor[i][j] = value / factor[j][j];
    }
  }
  return factor;
}

/// The inverse of a lower triangle.
Matrix inverse(const Matrix& factor, std::size_t n) {
  Matrix result{};
  for (std::size_t column = 0; column < n; ++column)
    for (std::size_t i = column; i < n; ++i) {
      double value = i == column ? 1 : 0;
      for (std::size_t k = column; k < i; ++k) value -= factor[i][k] * result[k][column];
      result[i][column] = value / factor[i][i];
    }
  return result;
}

/// Calls visit(pixel, its values in each image) for every pixel, by rows that threads share.
template <typename Visit>
void for_each_pixel(const std::vector<const Image*>& images, int threads, const Visit& visit) {
  const auto width = static_cast<std::size_t>(images.front()->width), height = static_cast<std::size_t>(images.front()->height);
  parallel_for(height, threads, [&](std::size_t row) {
    for (std::size_t i = row * width; i < (row + 1) * width; ++i) {
      TaylorValues values{};
      for (std::size_t t = 0; t < images.size(); ++t) values[t] = images[t]->pixel[i];
      visit(i, values);
    }
  });
}

}  // namespace

TaylorBasis::TaylorBasis(const std::vector<double>& psf_peaks)
    : terms_(static_cast<int>(psf_peaks.size() + 1) / 2), root_peak_(psf_peaks.empty() ? 0 : std::sqrt(psf_peaks.front())) {
  if (psf_peaks.size() % 2 != 1 || terms_ > most_taylor_terms)
    throw std::invalid_argument(std::to_string(psf_peaks.size()) + " spectral PSFs; expected 1, 3 or 5");
  const auto n = static_cast<std::size_t>(terms_);
  const std::optional<Matrix> factor = cholesky_factor(psf_peaks, n);
  if (!factor)
    throw std::runtime_error("the frequencies of the samples do not tell " + std::to_string(n) +
                             " Taylor terms apart; expected a wider band, or fewer terms");
  inverse_factor_ = inverse(*factor, n);
}

std::optional<TaylorBasis> TaylorBasis::of(const std::array<double, 2 * most_taylor_terms - 1>& psf_peaks, int terms) {
  const auto n = static_cast<std::size_t>(terms);
  const std::optional<Matrix> factor = cholesky_factor(psf_peaks, n);
  if (!factor) return std::nullopt;
  return TaylorBasis(terms, std::sqrt(psf_peaks.front()), inverse(*factor, n));
}

TaylorValues TaylorBasis::coordinates(const TaylorValues& residual) const {
  const auto n = static_cast<std::size_t>(terms_);
  TaylorValues y{};
  for (std::size_t a = 0; a < n; ++a) {
    for (std::size_t q = 0; q <= a; ++q) y[a] += inverse_factor_[a][q] * residual[q];
    y[a] *= root_peak_;
  }
  return y;
}

TaylorValues TaylorBasis::coefficients(const TaylorValues& y) const {
  const auto n = static_cast<std::size_t>(terms_);
  TaylorValues coefficient{};
  for (std::size_t t = 0; t < n; ++t) {
    for (std::size_t a = t; a < n; ++a) coefficient[t] += inverse_factor_[a][t] * y[a];
    coefficient[t] /= root_peak_;
  }
  return coefficient;
}

TaylorBasis basis_of(const std::vector<const Image*>& psf) {
  std::vector<double> peaks;
  for (const Image* image : psf) peaks.push_back(image->at(image->height / 2, image->width / 2));
  return TaylorBasis(peaks);
}

Image brightness(const TaylorBasis& basis, const std::vector<const Image*>& residual, int threads) {
  Image result(residual.front()->width, residual.front()->height);
  for_each_pixel(residual, threads, [&](std::size_t i, const TaylorValues& values) {
    double square = 0;
    for (const double y : basis.coordinates(values)) square += y * y;
    result.pixel[i] = std::sqrt(square);
  });
  return result;
}

std::vector<Image> principal_solution(const TaylorBasis& basis, const std::vector<const Image*>& residual, int threads) {
  std::vector<Image> result(residual.size(), Image(residual.front()->width, residual.front()->height));
  for_each_pixel(residual, threads, [&](std::size_t i, const TaylorValues& values) {
    const TaylorValues coefficient = basis.coefficients(basis.coordinates(values));
    for (std::size_t t = 0; t < result.size(); ++t) result[t].pixel[i] = coefficient[t];
  });
  return result;
}

namespace {

/// The basis in a mosaic's pixel.
std::optional<TaylorBasis> basis_at(const std::vector<Image>& relative_peaks, std::size_t i) {
  std::array<double, 2 * most_taylor_terms - 1> peaks{1};
  for (std::size_t k = 0; k < relative_peaks.size(); ++k) peaks[k + 1] = relative_peaks[k].pixel[i];
  return TaylorBasis::of(peaks, static_cast<int>(relative_peaks.size() / 2 + 1));
}

}  // namespace

SolutionNoise solution_noise(const std::vector<Image>& relative_peaks, const Image* seen, int threads) {
  const Image& like = relative_peaks.front();
  SolutionNoise noise{Image(like.width, like.height), Image(like.width, like.height), Image(like.width, like.height)};
  const auto width = static_cast<std::size_t>(like.width);
  parallel_for(static_cast<std::size_t>(like.height), threads, [&](std::size_t row) {
    for (std::size_t i = row * width; i < (row + 1) * width; ++i) {
      const std::optional<TaylorBasis> basis = basis_at(relative_peaks, i);
      double of_0 = basis ? 0 : std::nan(""), of_1 = of_0, of_both = of_0;
      for (int j = 0; basis && j < basis->terms(); ++j) {
        TaylorValues y{};
        y[static_cast<std::size_t>(j)] = 1;
        const TaylorValues coefficient = basis->coefficients(y);
        of_0 += coefficient[0] * coefficient[0];
        of_1 += coefficient[1] * coefficient[1];
        of_both += coefficient[0] * coefficient[1];
      }
      const double by = seen != nullptr ? seen->pixel[i] : 1;
      noise.sigma_0.pixel[i] = std::sqrt(of_0) / by;
      noise.sigma_1.pixel[i] = std::sqrt(of_1) / by;
      noise.correlation.pixel[i] = of_both / std::sqrt(of_0 * of_1);
    }
  });
  return noise;
}

std::vector<Image> principal_solution(const std::vector<Image>& relative_peaks, const std::vector<const Image*>& residual,
                                      int threads) {
  std::vector<Image> result(residual.size(), Image(residual.front()->width, residual.front()->height));
  for_each_pixel(residual, threads, [&](std::size_t i, const TaylorValues& values) {
    const std::optional<TaylorBasis> basis = basis_at(relative_peaks, i);
    const TaylorValues coefficient = basis ? basis->coefficients(basis->coordinates(values)) : TaylorValues{};
    result.front().pixel[i] = basis ? coefficient.front() : values.front();
    for (std::size_t t = 1; t < result.size(); ++t) result[t].pixel[i] = basis ? coefficient[t] : std::nan("");
  });
  return result;
}

}  // namespace misfit::imager
