#include "imager/clean/active_terms.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "imager/numerics/parallel.h"

namespace misfit::imager {
namespace {

std::vector<double> values_at(const std::vector<const Image*>& images, std::size_t pixel) {
  std::vector<double> values;
  for (const Image* image : images) values.push_back(image->pixel[pixel]);
  return values;
}

/// Of S where none of the PSFs is NaN; 0 elsewhere.
template <typename Function>
Image image_of_response(const TaylorBasis& basis, const std::vector<const Image*>& psf, int threads, const Function& function) {
  Image result(psf.front()->width, psf.front()->height);
  const auto width = static_cast<std::size_t>(result.width);
  parallel_for(static_cast<std::size_t>(result.height), threads, [&](std::size_t row) {
    for (std::size_t i = row * width; i < (row + 1) * width; ++i) {
      const std::vector<double> at = values_at(psf, i);
      const bool is_known = std::none_of(at.begin(), at.end(), [](double x) { return std::isnan(x); });
      result.pixel[i] = is_known ? function(basis.response(at)) : 0;
    }
  });
  return result;
}

/// The largest magnitude of its eigenvalues, it being symmetric.
double spectral_norm(const TaylorBasis::Matrix& s, int terms) {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  for (int a = 0; a < terms; ++a)
    for (int b = 0; b < terms; ++b) matrix(a, b) = s[static_cast<std::size_t>(a)][static_cast<std::size_t>(b)];
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>()
      .computeDirect(matrix, Eigen::EigenvaluesOnly)
      .eigenvalues()
      .cwiseAbs()
      .maxCoeff();
}

}  // namespace

TermCores::TermCores(const std::vector<const Image*>& psf, int threads) : basis(basis_of(psf)) {
  const int n = basis.terms();
  {
    const PsfCore of_norm(
        image_of_response(basis, psf, threads, [n](const TaylorBasis::Matrix& s) { return spectral_norm(s, n); }));
    reach = of_norm.reach();
    largest_outside = of_norm.largest_outside();
  }
  for (std::size_t a = 0; a < static_cast<std::size_t>(n); ++a)
    for (std::size_t b = 0; b <= a; ++b)
      core.emplace_back(image_of_response(basis, psf, threads, [=](const TaylorBasis::Matrix& s) { return s[a][b]; }), reach);
}

ActiveTerms::ActiveTerms(const Image& brightness, const std::vector<const Image*>& residual, const TermCores& cores,
                         double stop_jy, std::size_t most)
    : cores_(cores), level_jy_(active_level(brightness, stop_jy, cores.largest_outside, most)), y_(residual.size()) {
  row_.resize(static_cast<std::size_t>(brightness.height) + 1);
  for (int r = 0; r < brightness.height; ++r) {
    row_[static_cast<std::size_t>(r)].first = column_.size();
    for (int c = 0; c < brightness.width; ++c) {
      if (!(brightness.at(r, c) >= level_jy_)) continue;
      TaylorValues values{};
      for (std::size_t t = 0; t < residual.size(); ++t) values[t] = residual[t]->at(r, c);
      const TaylorValues y = cores.basis.coordinates(values);
      for (std::size_t t = 0; t < residual.size(); ++t) y_[t].push_back(static_cast<float>(y[t]));
      column_.push_back(c);
    }
  }
  row_.back().first = column_.size();
  square_.resize(column_.size());
  for (std::size_t i = 0; i < square_.size(); ++i)
    for (const std::vector<float>& y : y_) square_[i] += y[i] * y[i];
  for (std::size_t r = 0; r + 1 < row_.size(); ++r) find_peak_of(r);
}

void ActiveTerms::find_peak_of(std::size_t row) {
  float peak = -1;
  for (std::size_t i = row_[row].first; i < row_[row + 1].first; ++i) peak = std::max(peak, square_[i]);
  row_[row].peak = peak;
}

ActiveTerms::Bright ActiveTerms::peak() const {
  const auto brightest = std::max_element(row_.begin(), row_.end(), [](const Row& a, const Row& b) { return a.peak < b.peak; });
  if (brightest->peak < 0) return {};
  std::size_t i = brightest->first;
  while (square_[i] != brightest->peak) ++i;
  Bright bright{static_cast<int>(brightest - row_.begin()), column_[i], std::sqrt(double{square_[i]})};
  for (std::size_t t = 0; t < y_.size(); ++t) bright.y[t] = double{y_[t][i]};
  return bright;
}

void ActiveTerms::subtract(int row, int column, const TaylorValues& y) {
  const int reach = cores_.reach, rows = static_cast<int>(row_.size()) - 1;
  for (int r = std::max(0, row - reach); r <= std::min(rows - 1, row + reach); ++r) {
    const auto at = static_cast<std::size_t>(r);
    const auto begin = column_.begin() + static_cast<std::ptrdiff_t>(row_[at].first);
    const auto end = column_.begin() + static_cast<std::ptrdiff_t>(row_[at + 1].first);
    const auto first = static_cast<std::size_t>(std::lower_bound(begin, end, column - reach) - column_.begin());
    const auto last = static_cast<std::size_t>(std::upper_bound(begin, end, column + reach) - column_.begin());
    if (first == last) continue;
    for (std::size_t a = 0; a < y_.size(); ++a)
      for (std::size_t b = 0; b < y_.size(); ++b) {
        const float* const s = cores_.at(a, b).row(r - row);
        const auto factor = static_cast<float>(y[b]);
        for (std::size_t i = first; i < last; ++i) y_[a][i] -= factor * s[column_[i] - column];
      }
    for (std::size_t i = first; i < last; ++i) {
      square_[i] = 0;
      for (const std::vector<float>& values : y_) square_[i] += values[i] * values[i];
    }
    find_peak_of(at);
  }
}

void find_among(ActiveTerms& active, const TermCores& cores, const ActiveSearch& search, const MinorCycleWatch& watch,
                MinorCycleReport& report) {
  double taken = 0;  // Σ|y| of components, in Jy/beam
  ActiveTerms::Bright peak = active.peak();
  const double first = peak.brightness_jy;
  do {
    for (double& y : peak.y) y *= search.gain;
    const TaylorValues coefficient = cores.basis.coefficients(peak.y);
    Component component{search.scale, peak.row, peak.column, coefficient.front()};
    std::copy(coefficient.begin() + 1, coefficient.end(), component.further_jy.begin());
    report.components.push_back(component);
    active.subtract(peak.row, peak.column, peak.y);
    taken += search.gain * peak.brightness_jy;
    peak = active.peak();
  } while (peak.brightness_jy > std::max(search.stop_jy, active.level_jy() + cores.largest_outside * taken) &&
           peak.brightness_jy <= minor_cycle_divergence * first && !watch.is_at_limit(report));
}

}  // namespace misfit::imager
