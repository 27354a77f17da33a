#include <Eigen/LU>
#include <algorithm>

#include "kernels/positions_internal.h"

namespace misfit::kernels {
namespace {

constexpr int smooth_points = 28;
constexpr int most_pairs = 256;

/// Pairs of pieces [k/steps, (k+1)/steps], and the part of [0, ½] that each stands for.
struct Pairs {
  Eigen::VectorXd begin;
  Eigen::VectorXd weight;
};

Pairs all_pairs(int steps) {
  const int pairs = steps / 2;
  return {Eigen::VectorXd::LinSpaced(pairs, 0, pairs - 1) / steps, Eigen::VectorXd::Constant(pairs, 2.0 / steps)};
}

Pairs chosen_pairs(int steps) {
  const int pairs = steps / 2;
  const Quadrature rule = gauss_legendre(smooth_points, -1, 1);
  const Eigen::VectorXd pair = (pairs * (rule.node.array() + 1) / 2).floor();
  Eigen::MatrixXd legendre(smooth_points, smooth_points);
  for (int j = 0; j < smooth_points; ++j)
    for (int k = 0; k < smooth_points; ++k) legendre(k, j) = LegendrePair<double>(k, 2 * (pair[j] + 0.5) / pairs - 1).last;
  const Eigen::VectorXd integral = 2.0 * pairs / steps * Eigen::VectorXd::Unit(smooth_points, 0);
  return {pair / steps, legendre.partialPivLu().solve(integral)};
}

/// Appends `piece`, scaled, to the rule.
class Collector {
 public:
  Collector(int steps, Eigen::Index pieces)
      : length_(0.5 / steps),
        piece_(gauss_legendre(5 + smooth_points / steps, 0, 1)),  // exact for the square of a cubic; more where pieces are long
        extreme_(Eigen::VectorXd::LinSpaced(9, inset, 1 - inset)) {
    found_.mean.node.resize(pieces * piece_.node.size());
    found_.mean.weight.resize(pieces * piece_.node.size());
    found_.extreme.resize(pieces * extreme_.size());
  }
  void add(double begin, double weight) {
    const Eigen::Index points = piece_.node.size();
    found_.mean.node.segment(count_ * points, points) = begin + length_ * piece_.node.array();
    found_.mean.weight.segment(count_ * points, points) = weight * piece_.weight;
    found_.extreme.segment(count_ * extreme_.size(), extreme_.size()) = begin + length_ * extreme_.array();
    ++count_;
  }
  const Positions& found() const { return found_; }

 private:
  static constexpr double inset = 1e-6;  ///< the taps jump at the ends: stay on this side of them
  double length_;
  Quadrature piece_;
  Eigen::VectorXd extreme_;
  Eigen::Index count_ = 0;
  Positions found_;
};

}  // namespace

Positions smooth_positions() {
  Positions found{gauss_legendre(smooth_points, 0, 0.5), Eigen::VectorXd::LinSpaced(65, 0, 0.5)};
  found.mean.weight *= 2;
  return found;
}

Positions stepped_positions(int steps) {
  const Pairs pairs = steps / 2 > most_pairs ? chosen_pairs(steps) : all_pairs(steps);
  const bool odd = steps % 2 == 1;  // then [0, ½] ends with half a pair
  Collector collector(steps, 2 * pairs.begin.size() + (odd ? 1 : 0));
  for (Eigen::Index k = 0; k < pairs.begin.size(); ++k) {
    collector.add(pairs.begin[k], pairs.weight[k] / 2);
    collector.add(pairs.begin[k] + 0.5 / steps, pairs.weight[k] / 2);
  }
  if (odd) collector.add(0.5 - 0.5 / steps, 1.0 / steps);
  return collector.found();
}

}  // namespace misfit::kernels
