#pragma once

#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>
#include <vector>

namespace misfit::kernels {

/// Nodes and weights: ∫ f ≈ Σ weight_i f(node_i). `Real` is double or one of the types of extended_precision.h.
template <typename Real>
struct QuadratureOf {
  Eigen::Matrix<Real, Eigen::Dynamic, 1> node;
  Eigen::Matrix<Real, Eigen::Dynamic, 1> weight;
};
using Quadrature = QuadratureOf<double>;

/// P_n and P_{n−1} at x.
template <typename Real>
struct LegendrePair {
  Real last = 1;
  Real before = 0;

  LegendrePair(int n, const Real& x) {
    for (int k = 1; k <= n; ++k) {
      const Real next = ((2 * k - 1) * x * last - (k - 1) * before) / k;
      before = last;
      last = next;
    }
  }
};

/// A zero of P_n, and the slope of P_n there.
template <typename Real>
struct LegendreZero {
  Real x;
  Real slope;
};

/// The zeros of P_n from the largest to the smallest, found once for each n: searches ask for one rule many thousand times.
template <typename Real>
const std::vector<LegendreZero<Real>>& legendre_zeros(int n) {
  using std::abs;
  static std::mutex one_at_a_time;
  static std::map<int, std::vector<LegendreZero<Real>>> known;  // whose entries stay where they are
  const std::lock_guard lock(one_at_a_time);
  std::vector<LegendreZero<Real>>& zeros = known[n];
  for (int i = static_cast<int>(zeros.size()); i < n; ++i) {
    LegendreZero<Real> zero{static_cast<Real>(std::cos(std::acos(-1.0) * (i + 0.75) / (n + 0.5))), 0};
    for (int newton = 0; newton < 12; ++newton) {
      const LegendrePair<Real> p(n, zero.x);
      zero.slope = n * (zero.x * p.last - p.before) / (zero.x * zero.x - 1);
      const Real step = p.last / zero.slope;
      zero.x -= step;
      if (abs(step) < std::numeric_limits<Real>::epsilon()) break;
    }
    zeros.push_back(zero);
  }
  return zeros;
}

/// The Gauss–Legendre rule of `points` points on [from, to], exact for polynomials of degree 2·points − 1
/// (Abramowitz & Stegun 1964, eq. 25.4.29).
template <typename Real>
QuadratureOf<Real> gauss_legendre_in(int points, const Real& from, const Real& to) {
  QuadratureOf<Real> rule;
  rule.node.resize(points);
  rule.weight.resize(points);
  const Real half = (to - from) / 2;
  int i = points;
  for (const auto& [x, slope] : legendre_zeros<Real>(points)) {
    --i;
    rule.node[i] = from + half * (1 + x);
    rule.weight[i] = half * 2 / ((1 - x * x) * slope * slope);
  }
  return rule;
}

/// The Gauss–Lobatto rule of `points` ≥ 2 points on [from, to], both ends among them, exact for polynomials of degree
/// 2·points − 3 (Abramowitz & Stegun 1964, eq. 25.4.32).
template <typename Real>
QuadratureOf<Real> gauss_lobatto_in(int points, const Real& from, const Real& to) {
  using std::abs;
  const int n = points - 1;  // the inner nodes are the zeros of P_n'
  QuadratureOf<Real> rule;
  rule.node.resize(points);
  rule.weight.resize(points);
  const Real half = (to - from) / 2;
  for (int i = 0; i < points; ++i) {
    Real x = static_cast<Real>(std::cos(std::acos(-1.0) * i / n));
    const bool end = i == 0 || i == n;
    if (end) x = i == 0 ? 1 : -1;
    for (int newton = 0; newton < 12 && !end; ++newton) {
      const LegendrePair<Real> p(n, x);
      const Real slope = n * (x * p.last - p.before) / (x * x - 1);
      const Real curvature = (2 * x * slope - n * (n + 1) * p.last) / (1 - x * x);  // Legendre's equation
      const Real step = slope / curvature;
      x -= step;
      if (abs(step) < std::numeric_limits<Real>::epsilon()) break;
    }
    const Real value = LegendrePair<Real>(n, x).last;
    rule.node[points - 1 - i] = from + half * (1 + x);
    rule.weight[points - 1 - i] = half * 2 / (n * (n + 1) * value * value);
  }
  return rule;
}

/// The Gauss–Legendre rule in doubles, correctly rounded but for a bit: it is computed in long double, since Newton's last step
/// and the weights would lose two digits.
inline Quadrature gauss_legendre(int points, double from, double to) {
  const QuadratureOf<long double> rule = gauss_legendre_in<long double>(points, from, to);
  return {rule.node.cast<double>(), rule.weight.cast<double>()};
}

}  // namespace misfit::kernels
