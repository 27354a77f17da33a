#include "imager/pointing/curved_terms.h"

#include <algorithm>

#include "imager/pointing/principal_terms.h"

namespace misfit::imager {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double of_w = 0.01;  // of the tolerance: what interpolation along w may leave

/// Frequencies at which beams are looked at, among many as many as there may be.
std::vector<double> some_of(const std::vector<double>& frequency_hz) {
  constexpr std::size_t most = 48;
  if (frequency_hz.size() <= most) return frequency_hz;
  std::vector<double> some;
  for (std::size_t i = 0; i < most; ++i) some.push_back(frequency_hz[i * (frequency_hz.size() - 1) / (most - 1)]);
  return some;
}

/// Values of w from 0 to the largest by which waves of this phase follow at all: Chebyshev's points of either sign.
std::vector<double> looked_at(double most_abs_w, double phase_rad) {
  const int count = 8 + static_cast<int>(std::ceil(phase_rad));
  std::vector<double> w;
  for (int i = 0; i < count; ++i) w.push_back(most_abs_w * std::sin(pi / 2 * i / (count - 1)));
  return w;
}

/// Phase between points by which Lagrange's formula for six is right: its remainder is (225/64)/6! steps⁶ in their middle.
double step_of_phase(double error) {
  return std::pow(error * 720 * 64 / 225, 1.0 / 6);
}

}  // namespace

CurvedTerms::CurvedTerms(const std::vector<double>& frequency_hz, const BeamDirections& directions, double most_abs_w,
                         double tolerance, std::size_t most_terms)
    : directions_(directions), most_abs_w_(most_abs_w), middle_(0) {
  const double largest = directions.largest_sine;
  middle_ = largest * largest / (1 + std::sqrt(1 - largest * largest)) / 2;
  const bool curved = most_phase_rad() > of_w * tolerance;
  const std::vector<double> some = some_of(frequency_hz);
  const std::vector<double> all_w = curved ? looked_at(most_abs_w, most_phase_rad()) : std::vector<double>{0};
  const auto count = static_cast<Index>(directions.sine.size());
  MatrixXd values(count, static_cast<Index>(some.size() * (2 * all_w.size() - 1)));
  std::vector<Node> columns;
  for (const double hz : some) {
    const std::vector<double> beam = directions.values(hz);
    for (const double w : all_w)
      for (const bool is_sine : {false, true}) {
        if (is_sine && w == 0) continue;
        const Node node{hz, w, is_sine};
        for (Index d = 0; d < count; ++d) {
          const auto i = static_cast<std::size_t>(d);
          values(d, static_cast<Index>(columns.size())) = beam[i] * node.wave(q(directions.sine[i]));
        }
        columns.push_back(node);
      }
  }
  const PrincipalTerms found = principal_terms(values, tolerance, static_cast<Index>(most_terms));
  enough_ = found.enough;
  if (!enough_) return;
  sizes_.assign(found.size.begin(), found.size.end());
  for (const Index column : found.node) nodes_.push_back(columns[static_cast<std::size_t>(column)]);
  for (Index k = 0; k < found.terms(); ++k) {
    const auto list = [k](const MatrixXd& of) { return std::vector<double>(of.col(k).begin(), of.col(k).end()); };
    of_nodes_.push_back(list(found.of_nodes));
    share_of_value_.push_back(list(found.share_of_value));
  }
  if (curved) step_ = std::min(1.0, step_of_phase(of_w * tolerance) / most_phase_rad()) * most_abs_w;
  const std::size_t steps = step_ == 0 ? 0 : static_cast<std::size_t>(std::ceil(most_abs_w / step_));
  const std::size_t points = steps + ShareTable::points;
  for (std::size_t point = 0; point < points; ++point)
    for (const bool is_sine : {false, true}) {
      const Node node{0, (static_cast<double>(point) - ShareTable::before) * step_, is_sine};
      for (const double sine : directions_.sine) wave_.push_back(node.wave(q(sine)));
    }
}

const ShareTable& CurvedTerms::shares(double frequency_hz) const {
  const std::lock_guard lock(mutex_);
  const auto [found, is_new] = shares_.try_emplace(frequency_hz);
  if (!is_new) return found->second;
  const std::vector<double> beam = directions_.values(frequency_hz);
  const auto count = static_cast<Index>(beam.size());
  MatrixXd by_wave(static_cast<Index>(terms()), count);  // [term][direction]
  for (std::size_t k = 0; k < terms(); ++k)
    for (std::size_t d = 0; d < beam.size(); ++d)
      by_wave(static_cast<Index>(k), static_cast<Index>(d)) = share_of_value_[k][d] * beam[d];
  const Index waves = static_cast<Index>(wave_.size()) / count;
  std::vector<double> shares(terms() * static_cast<std::size_t>(waves));
  Eigen::Map<MatrixXd>(shares.data(), by_wave.rows(), waves) = by_wave * Eigen::Map<const MatrixXd>(wave_.data(), count, waves);
  return found->second = ShareTable(terms(), shares);
}

}  // namespace misfit::imager
