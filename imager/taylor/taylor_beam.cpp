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

/// Of the largest difference of frequencies so small a part that shares taken together are still as far apart as terms need.
double apart_of(const std::vector<BeamShare>& shares) {
  constexpr double most = 1e-3, parts = 1024;
  double low_hz = shares.empty() ? 0 : shares.front().frequency_hz, high_hz = low_hz;
  for (const BeamShare& s : shares) {
    low_hz = std::min(low_hz, s.frequency_hz);
    high_hz = std::max(high_hz, s.frequency_hz);
  }
  return high_hz > low_hz && low_hz > 0 ? std::min(most, std::log(high_hz / low_hz) / parts) : most;
}

/// Σ w x^k B / Σ w at an angle from the axis.
double moment_at(const PrimaryBeam& beam, const TaylorExpansion& expansion, int k, double sine) {
  double sum = 0;
  for (const BeamShare& s : beam.shares()) sum += s.weight * std::pow(expansion.x(s.frequency_hz), k) * power(s, sine);
  return sum;
}

}  // namespace

TaylorBeam::TaylorBeam(const std::vector<BeamShare>& shares, const TaylorExpansion& expansion, const ImageGeometry& geometry,
                       const BeamOnImage& view)
    : expansion_(expansion), geometry_(geometry), view_(view) {
  require_limit(view);
  const PrimaryBeam beam(shares, apart_of(shares));
  const int moments = 2 * expansion.terms - 1;
  const auto moment = [&](int k, double sine) { return moment_at(beam, expansion, k, sine); };
  for (int k = 0; k < moments; ++k) weight_moment_[static_cast<std::size_t>(k)] = moment(k, 0);  // B is 1 on the axis
  const TermVector first = matrix_of(weight_moment_, expansion.terms).ldlt().solve(TermVector::Unit(expansion.terms, 0));
  const double reach = first_sine_at(view.limit, beam.step(), [&](double sine) {
    double b_0 = 0;
    for (int q = 0; q < expansion.terms; ++q) b_0 += first(q) * moment(q, sine);
    return b_0;
  });
  for (int k = 0; k < moments; ++k)
    beam_moment_.emplace_back(reach, view.threads, [&](double sine) { return moment(k, sine); });
}

template <typename TermsAt>
std::vector<Image> TaylorBeam::images_of(const TermsAt& terms_at) const {
  Image without_values(geometry_.width, geometry_.height);
  std::fill(without_values.pixel.begin(), without_values.pixel.end(), no_value);
  std::vector<Image> images(static_cast<std::size_t>(expansion_.terms), without_values);
  for_each_within(beam_moment_.front().reach(), view_.pointing, geometry_, view_.threads, [&](std::size_t pixel, double sine) {
    Moments moments{};
    for (std::size_t k = 0; k < beam_moment_.size(); ++k) moments[k] = beam_moment_[k](sine);
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
