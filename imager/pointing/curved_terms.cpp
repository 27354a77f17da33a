#include "imager/pointing/curved_terms.h"

#include <algorithm>
#include <numeric>
#include <set>

#include "imager/pointing/principal_terms.h"

namespace misfit::imager {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double of_w = 0.01;  // of the tolerance: what interpolation along w may leave

/// The frequencies that lie closest to so many ones evenly spaced.
std::vector<double> evenly_spaced(std::vector<double> frequency_hz, std::size_t most) {
  std::sort(frequency_hz.begin(), frequency_hz.end());
  if (frequency_hz.size() <= most) return frequency_hz;
  std::set<double> chosen;
  const double low = frequency_hz.front(), high = frequency_hz.back();
  for (std::size_t i = 0; i < most; ++i) {
    const double hz = low + (high - low) * static_cast<double>(i) / static_cast<double>(most - 1);
    const auto next = std::lower_bound(frequency_hz.begin(), frequency_hz.end(), hz);
    chosen.insert(next == frequency_hz.end() ? high : *next);
  }
  return {chosen.begin(), chosen.end()};
}

/// Values of w from 0 to the largest at which waves of at most this phase are looked at.
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

/// The products of beams and waves that terms are sought for.
struct Products {
  std::vector<CurvedTerms::Node> node;
  MatrixXd values;  ///< [direction][node]
};

Products products_of(const std::vector<double>& frequency_hz, const std::vector<double>& all_w, const ValuesAtFrequency& beams,
                     const std::vector<double>& q) {
  Products made;
  made.values.resize(static_cast<Index>(q.size()), static_cast<Index>(frequency_hz.size() * 2 * all_w.size()));
  for (const double hz : frequency_hz) {
    const std::vector<double> beam = beams(hz);
    for (const double w : all_w)
      for (const bool is_sine : {false, true}) {
        if (is_sine && w == 0) continue;
        const CurvedTerms::Node node{hz, w, is_sine};
        for (std::size_t d = 0; d < q.size(); ++d)
          made.values(static_cast<Index>(d), static_cast<Index>(made.node.size())) = beam[d] * node.wave(q[d]);
        made.node.push_back(node);
      }
  }
  made.values.conservativeResize(Eigen::NoChange, static_cast<Index>(made.node.size()));
  return made;
}

/// The largest difference between products and what follows of them from terms [direction][term].
double most_left(const MatrixXd& terms, const MatrixXd& share_of_value, const MatrixXd& values) {
  return (values - terms * (share_of_value.transpose() * values)).cwiseAbs().maxCoeff();
}

}  // namespace

CurvedTerms::CurvedTerms(const std::vector<double>& frequency_hz, const BeamDirections& directions, double most_abs_w,
                         double tolerance, std::size_t most_terms)
    : directions_(directions), waves_alone_(frequency_hz.empty()), most_abs_w_(most_abs_w), middle_(0) {
  const double largest = directions.largest_sine;
  middle_ = largest * largest / (1 + std::sqrt(1 - largest * largest)) / 2;
  if (2 * most_phase_rad() / pi > static_cast<double>(most_terms)) return;  // waves alone take more: one each half turn
  if (waves_alone_) directions_.values = [count = directions.sine.size()](double) { return std::vector<double>(count, 1); };
  std::vector<double> q_of;  // [direction]
  for (const double sine : directions.sine) q_of.push_back(q(sine));
  const bool curved = most_phase_rad() > of_w * tolerance;
  const std::vector<double> all_w = curved ? looked_at(most_abs_w, most_phase_rad()) : std::vector<double>{0};
  // Beams at most frequencies are alike: those are taken at which they are not.
  constexpr std::size_t at_first = 32;
  std::vector<double> all_hz = waves_alone_ ? std::vector<double>{0} : frequency_hz, some_hz = evenly_spaced(all_hz, at_first);
  PrincipalTerms found;
  Products products;
  for (bool all = false; !all;) {
    products = products_of(some_hz, all_w, directions_.values, q_of);
    found = principal_terms(products.values, tolerance, static_cast<Index>(most_terms));
    if (!found.enough) return;
    MatrixXd at_nodes(products.values.rows(), found.terms());
    for (Index j = 0; j < found.terms(); ++j) at_nodes.col(j) = products.values.col(found.node[static_cast<std::size_t>(j)]);
    const MatrixXd terms = at_nodes * found.of_nodes;
    double worst = tolerance, worst_hz = 0;
    for (const double hz : all_hz) {
      const double left = most_left(terms, found.share_of_value,
                                    products_of({hz}, {0, curved ? most_abs_w : 0}, directions_.values, q_of).values);
      if (left > worst) worst_hz = hz;
      worst = std::max(worst, left);
    }
    all = worst_hz == 0 || std::find(some_hz.begin(), some_hz.end(), worst_hz) != some_hz.end();
    if (!all) some_hz.push_back(worst_hz);
  }
  enough_ = true;
  sizes_.assign(found.size.begin(), found.size.end());
  std::vector<Index> order(found.node.size());
  std::iota(order.begin(), order.end(), Index(0));
  const auto node_at = [&](Index i) {
    return products.node[static_cast<std::size_t>(found.node[static_cast<std::size_t>(i)])];
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](Index a, Index b) { return node_at(a).frequency_hz < node_at(b).frequency_hz; });
  for (const Index i : order) nodes_.push_back(node_at(i));
  for (Index k = 0; k < found.terms(); ++k) {
    std::vector<double>& of_nodes = of_nodes_.emplace_back();
    for (const Index i : order) of_nodes.push_back(found.of_nodes(i, k));
    share_of_value_.emplace_back(found.share_of_value.col(k).begin(), found.share_of_value.col(k).end());
  }
  constexpr double no_w = 1e-3;  // wavelengths
  step_ = std::max(most_abs_w, no_w);
  if (curved) step_ *= std::min(1.0, step_of_phase(of_w * tolerance) / most_phase_rad());
  const auto points = static_cast<std::size_t>(std::ceil(most_abs_w / step_)) + ShareTable::points;
  for (std::size_t point = 0; point < points; ++point)
    for (const bool is_sine : {false, true}) {
      const Node node{0, (static_cast<double>(point) - ShareTable::before) * step_, is_sine};
      for (const double at : q_of) wave_.push_back(node.wave(at));
    }
}

double CurvedTerms::table_bytes() const {
  return ShareTable::bytes(terms(), wave_.size() / directions_.sine.size() / 2);
}

const ShareTable& CurvedTerms::shares(double frequency_hz) const {
  if (waves_alone_) frequency_hz = 0;
  const std::lock_guard lock(mutex_);
  const auto found = shares_.find(frequency_hz);
  if (found != shares_.end()) return found->second;
  const std::vector<double> beam = directions_.values(frequency_hz);
  const auto count = static_cast<Index>(beam.size());
  MatrixXd by_wave(static_cast<Index>(terms()), count);  // [term][direction]
  for (std::size_t k = 0; k < terms(); ++k)
    for (std::size_t d = 0; d < beam.size(); ++d)
      by_wave(static_cast<Index>(k), static_cast<Index>(d)) = share_of_value_[k][d] * beam[d];
  const Index waves = static_cast<Index>(wave_.size()) / count;
  std::vector<double> shares(terms() * static_cast<std::size_t>(waves));
  Eigen::Map<MatrixXd>(shares.data(), by_wave.rows(), waves) = by_wave * Eigen::Map<const MatrixXd>(wave_.data(), count, waves);
  return shares_.try_emplace(frequency_hz, terms(), shares).first->second;
}

}  // namespace misfit::imager
