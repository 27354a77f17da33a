#include "kernels/sampled_function.h"

#include <cmath>
#include <cstdlib>

namespace misfit::kernels {
namespace {

double tap(const PiecewisePolynomial& polynomial, Eigen::Index r, double t) {
  double value = 0;
  for (Eigen::Index d = polynomial.degree(); d >= 0; --d) value = value * t + polynomial.coefficient(d, r);
  return value;
}

double value_at(const PiecewisePolynomial& polynomial, double u) {
  const Eigen::Index width = polynomial.width();
  const double from_middle = std::abs(u);
  if (!(from_middle <= static_cast<double>(width) / 2)) return std::isnan(u) ? u : 0;
  const double whole = std::floor(from_middle);
  const double part = from_middle - whole;
  const bool odd = width % 2 == 1;
  const bool next = odd && part >= 0.5;
  const Eigen::Index r = width / 2 + static_cast<Eigen::Index>(whole) + (next ? 1 : 0);
  const double t = (odd ? (next ? 1 : 0) : 0.5) - part;
  if (t < 0.5) return tap(polynomial, r, t);
  const double left = tap(polynomial, r - 1, -0.5);
  return r == width ? left : (left + tap(polynomial, r, 0.5)) / 2;
}

}  // namespace

Eigen::VectorXd sampled_function(const PiecewisePolynomial& polynomial, int per_cell) {
  const Eigen::Index width = polynomial.width();
  const Eigen::Index cell = 2 * Eigen::Index{per_cell};  // in units of half a step, as the edges of cells are whole numbers
  Eigen::VectorXd value(width * per_cell / 2 + 1);
  for (Eigen::Index i = 0; i < value.size(); ++i) {
    const Eigen::Index from_left = 2 * i + width * per_cell;
    const Eigen::Index r = from_left / cell;
    const Eigen::Index within = from_left % cell;
    if (within != 0)
      value[i] = tap(polynomial, r, 0.5 - static_cast<double>(within) / static_cast<double>(cell));
    else if (r == width)
      value[i] = tap(polynomial, r - 1, -0.5);
    else
      value[i] = r == 0 ? tap(polynomial, r, 0.5) : (tap(polynomial, r - 1, -0.5) + tap(polynomial, r, 0.5)) / 2;
  }
  return value;
}

Eigen::VectorXd function_values(const PiecewisePolynomial& polynomial, const Eigen::VectorXd& u) {
  return u.unaryExpr([&](double each) { return value_at(polynomial, each); });
}

Eigen::VectorXd sampled_to_both_ends(const PiecewisePolynomial& polynomial, int per_cell) {
  Eigen::VectorXd table = sampled_function(polynomial, per_cell);
  const bool ends_on_an_entry = polynomial.width() * per_cell % 2 == 0;
  if (ends_on_an_entry) table[table.size() - 1] /= 2;
  return table;
}

TapFunction nearest_entries(const Eigen::VectorXd& table, int per_cell, int support) {
  return [=](double t) {
    Eigen::VectorXd taps = Eigen::VectorXd::Zero(2 * support + 1);
    const long off = std::lround(t * per_cell);
    for (int r = 0; r <= 2 * support; ++r) {
      const long entry = std::labs((r - support) * long{per_cell} - off);
      if (entry < table.size()) taps[r] = table[entry];
    }
    return taps;
  };
}

}  // namespace misfit::kernels
