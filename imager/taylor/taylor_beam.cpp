#include "imager/taylor/taylor_beam.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstddef>

#include "imager/data/horizon.h"

namespace misfit::imager {
namespace {

using TermVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, most_taylor_terms, 1>;
using TermMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, most_taylor_terms, most_taylor_terms>;

/// M_qt = m_{q+t}, of moments m.
TermMatrix matrix_of(const TaylorBeam::Moments& moments, Eigen::Index n) {
  TermMatrix matrix(n, n);
  for (Eigen::Index q = 0; q < n; ++q)
    for (Eigen::Index t = 0; t < n; ++t) matrix(q, t) = moments[static_cast<std::size_t>(q + t)];
  return matrix;
}

/// How far apart, relatively, frequencies of joined shares may be: such a small part of the largest difference that terms still
/// have enough distinct frequencies.
double apart_of(const std::vector<BeamShare>& shares) {
  constexpr double most = 1e-3, parts = 1024;
  double low_hz = shares.empty() ? 0 : shares.front().frequency_hz, high_hz = low_hz;
  for (const BeamShare& s : shares) {
    low_hz = std::min(low_hz, s.frequency_hz);
    high_hz = std::max(high_hz, s.frequency_hz);
  }
  return high_hz > low_hz && low_hz > 0 ? std::min(most, std::log(high_hz / low_hz) / parts) : most;
}

}  // namespace

TaylorBeam::TaylorBeam(const std::vector<BeamShare>& shares, const TaylorExpansion& expansion, const ImageGeometry& geometry,
                       const BeamOnImage& view)
    : expansion_(expansion), geometry_(geometry), view_(view) {
  require_limit(view);
  const PrimaryBeam beam(shares, apart_of(shares));
  std::vector<BeamTables::Factor> powers;
  for (int k = 0; k < 2 * expansion.terms - 1; ++k) {
    powers.emplace_back([=](double frequency_hz) { return std::pow(expansion.x(frequency_hz), k); });
    for (const BeamShare& s : beam.shares())  // B is 1 on the axis
      weight_moment_[static_cast<std::size_t>(k)] += s.weight * powers.back()(s.frequency_hz);
  }
  const TermVector first = matrix_of(weight_moment_, expansion.terms).ldlt().solve(TermVector::Unit(expansion.terms, 0));
  const auto b_0 = [&](const double* moment) {
    double sum = 0;
    for (int q = 0; q < expansion.terms; ++q) sum += first(q) * moment[q];
    return sum;
  };
  beam_moment_.emplace(beam, powers, view.limit, b_0, view.threads);
}

template <typename TermsAt>
std::vector<Image> TaylorBeam::images_of(const TermsAt& terms_at) const {
  Image without_values(geometry_.width, geometry_.height);
  std::fill(without_values.pixel.begin(), without_values.pixel.end(), no_value);
  std::vector<Image> images(static_cast<std::size_t>(expansion_.terms), without_values);
  beam_moment_->for_each_pixel(view_.pointing, geometry_, view_.threads, [&](std::size_t pixel, const double* moment) {
    Moments moments{};
    std::copy_n(moment, 2 * expansion_.terms - 1, moments.begin());
    const TermVector terms = terms_at(pixel, moments);
    for (std::size_t t = 0; t < images.size(); ++t) images[t].pixel[pixel] = terms(static_cast<Eigen::Index>(t));
  });
  return images;
}

std::vector<Image> TaylorBeam::terms() const {
  const auto basis = matrix_of(weight_moment_, expansion_.terms).ldlt();
  return images_of([&](std::size_t, const Moments& moments) -> TermVector {
    return basis.solve(Eigen::Map<const Eigen::VectorXd>(moments.data(), expansion_.terms));
  });
}

std::vector<Image> TaylorBeam::corrected(const std::vector<const Image*>& apparent) const {
  const TermMatrix basis = matrix_of(weight_moment_, expansion_.terms);
  return images_of([&](std::size_t pixel, const Moments& moments) -> TermVector {
    TermVector terms(expansion_.terms);
    for (std::size_t t = 0; t < apparent.size(); ++t) terms(static_cast<Eigen::Index>(t)) = apparent[t]->pixel[pixel];
    return matrix_of(moments, expansion_.terms).ldlt().solve(basis * terms);
  });
}

}  // namespace misfit::imager
