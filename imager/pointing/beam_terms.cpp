#include "imager/pointing/beam_terms.h"

#include <Eigen/Dense>
#include <utility>

namespace misfit::imager {

BeamSpan::BeamSpan(FrequencySpan span) : FrequencySpan(std::move(span)) {
  const auto count = static_cast<Eigen::Index>(terms());
  Eigen::MatrixXd at_nodes(count, count);  // of the terms
  for (Eigen::Index j = 0; j < count; ++j) {
    const std::vector<double> share = shares(node_hz[static_cast<std::size_t>(j)], terms());
    for (Eigen::Index k = 0; k < count; ++k) at_nodes(j, k) = share[static_cast<std::size_t>(k)];
  }
  const Eigen::MatrixXd inverse = at_nodes.inverse();
  for (Eigen::Index k = 0; k < count; ++k) {
    const Eigen::VectorXd row = inverse.row(k).transpose();
    of_nodes_.emplace_back(row.begin(), row.end());
  }
}

double BeamSpan::position(double frequency_hz) const {
  return high_hz > low_hz ? (2 * frequency_hz - low_hz - high_hz) / (high_hz - low_hz) : 0;
}

std::vector<double> BeamSpan::shares(double frequency_hz, std::size_t count) const {
  const double x = position(frequency_hz);
  std::vector<double> share(count, 1);
  if (count > 1) share[1] = x;
  for (std::size_t k = 2; k < count; ++k) share[k] = 2 * x * share[k - 1] - share[k - 2];
  return share;
}

}  // namespace misfit::imager
