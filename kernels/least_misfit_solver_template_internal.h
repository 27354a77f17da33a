#pragma once

#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <vector>

#include "kernels/least_misfit_elimination_internal.h"
#include "kernels/least_misfit_solver_internal.h"
#include "kernels/quadrature.h"

namespace misfit::kernels {

/// E(h) and its derivatives with respect to the coefficients p of log h = Σ_j p_j φ_j, at the optimal C. With y the target, r
/// the residual, v = y − r the fit and P the projection onto the design matrix, the Jacobian of r is −(1−P) φ_j v to first
/// order in r (Kaufman 1975, BIT 15, 49), and its product with r is the exact gradient. It is kept as a matrix, never squared:
/// its singular values span as many decades as √E.
template <typename Real>
struct Expansion {
  Real weighted_error = 0;
  VectorOf<Real> error;     ///< ℓ at the nodes
  VectorOf<Real> residual;  ///< r: [half, t, x], weighted, so that the weighted error is its square
  MatrixOf<Real> jacobian;  ///< [half, t, x][j]
};

template <typename Real>
class Solver {
 public:
  explicit Solver(const MisfitProblem& problem)
      : problem_(problem),
        nodes_(problem.nodes, problem.x0),
        weight_(nodes_.weight.cwiseProduct(problem.importance.cast<Real>())),
        t_(gauss_legendre_in<Real>(problem.width + 4, 0, Real(0.5))) {
    t_.weight *= Real(2);
    shape_ = chebyshev(problem.width / 2 + 5).rightCols(problem.width / 2 + 4);
    start_ = (2 * values(problem.last) - values(problem.before)).array().exp();
  }

  MisfitMinimum minimise() const;

 private:
  std::vector<Half<Real>> halves(const VectorOf<Real>& h) const {
    return {Half<Real>(Half<Real>::Parity::even, problem_.width, nodes_.x, weight_, h),
            Half<Real>(Half<Real>::Parity::odd, problem_.width, nodes_.x, weight_, h)};
  }
  Expansion<Real> expand(const VectorOf<Real>& h) const;
  VectorOf<Real> retracted(const VectorOf<Real>& h) const;
  /// T_2j(θ/θ0) at the nodes, j = 0 … terms − 1.
  MatrixOf<Real> chebyshev(Eigen::Index terms) const {
    MatrixOf<Real> value(nodes_.theta.size(), terms);
    const VectorOf<Real> twice = 4 * nodes_.theta.cwiseAbs2().array() - 2;
    value.col(0).setOnes();
    if (terms > 1) value.col(1) = twice / 2;
    for (Eigen::Index j = 2; j < terms; ++j) value.col(j) = twice.cwiseProduct(value.col(j - 1)) - value.col(j - 2);
    return value;
  }
  /// log h at the nodes.
  VectorOf<Real> values(const LogCorrection& log_h) const {
    if (log_h.size() == 0) return VectorOf<Real>::Zero(nodes_.theta.size());
    const VectorOf<Real> coefficient = log_h.rowwise().reverse().template cast<Real>().rowwise().sum();
    return chebyshev(log_h.rows()) * coefficient;
  }
  LogCorrection series(const VectorOf<Real>& h) const {
    VectorOf<Real> rest = chebyshev(problem_.width / 2 + 5).colPivHouseholderQr().solve(VectorOf<Real>(h.array().log()));
    constexpr int parts = (std::numeric_limits<Real>::digits + 52) / 53;
    LogCorrection log_h(rest.size(), parts);
    for (int part = 0; part < parts; ++part) {
      log_h.col(part) = rest.template cast<double>();
      rest -= log_h.col(part).template cast<Real>();
    }
    return log_h;
  }
  VectorOf<Real> moved(const VectorOf<Real>& h, const VectorOf<Real>& step) const { return h.array() * step.array().exp(); }
  /// An upper estimate of E's relative rounding: a residual of order 1 is rounded, and the range of h amplifies that. The
  /// measured rounding is 5% of it.
  double relative_rounding(const Expansion<Real>& here, const VectorOf<Real>& h) const {
    using std::sqrt;
    return static_cast<double>(std::numeric_limits<Real>::epsilon() * (h.maxCoeff() / h.minCoeff()) /
                               sqrt(here.weighted_error));
  }
  TapFunction taps_at(const VectorOf<Real>& h, const Real& scale) const;
  double condition_at(const VectorOf<Real>& h) const;

  MisfitProblem problem_;
  NodesOf<Real> nodes_;
  VectorOf<Real> weight_;  ///< of the nodes, with their importance
  QuadratureOf<Real> t_;
  MatrixOf<Real> shape_;  ///< T_2j(θ/θ0), j = 1, 2, …: the directions in which log h is moved
  VectorOf<Real> start_;  ///< h
};

template <typename Real>
Expansion<Real> Solver<Real>::expand(const VectorOf<Real>& h) const {
  using std::sqrt;
  const Eigen::Index n = nodes_.x.size();
  const Eigen::Index rows = 2 * t_.node.size() * n;
  Expansion<Real> e{0, VectorOf<Real>::Zero(n), VectorOf<Real>(rows), MatrixOf<Real>(rows, shape_.cols())};
  Eigen::Index at = 0;
  for (const Half<Real>& half : halves(h)) {
    for (Eigen::Index i = 0; i < t_.node.size(); ++i, at += n) {
      const VectorOf<Real> y = half.weighted_wave(t_.node[i]);
      const VectorOf<Real> r = half.outside(y);
      const VectorOf<Real> v = y - r;
      const Real root = sqrt(t_.weight[i]);
      e.error += t_.weight[i] * r.cwiseAbs2();
      e.residual.segment(at, n) = root * r;
      e.jacobian.middleRows(at, n) = -root * half.outside(v.asDiagonal() * shape_);
    }
  }
  e.weighted_error = e.error.sum();
  e.error = e.error.cwiseQuotient(weight_);
  return e;
}

/// c / Σ c(x−n)² at the nodes: the optimal h for the C that is optimal for the h given. Never raises E.
template <typename Real>
VectorOf<Real> Solver<Real>::retracted(const VectorOf<Real>& h) const {
  VectorOf<Real> c = VectorOf<Real>::Zero(h.size());
  VectorOf<Real> power = c;
  for (const Half<Real>& half : halves(h)) {
    for (Eigen::Index i = 0; i < t_.node.size(); ++i) {
      const VectorOf<Real> y = half.weighted_wave(t_.node[i]);
      const VectorOf<Real> v = y - half.outside(y);
      c += t_.weight[i] * y.cwiseProduct(v);
      power += t_.weight[i] * v.cwiseAbs2();
    }
  }
  return h.cwiseProduct(c).cwiseQuotient(power);
}

/// The p that minimises |residual + jacobian p|² + damping |p|².
template <typename Real>
VectorOf<Real> damped_step(const Expansion<Real>& e, const Real& damping) {
  using std::sqrt;
  const Eigen::Index terms = e.jacobian.cols();
  const Eigen::Index extra = damping == 0 ? 0 : terms;
  MatrixOf<Real> system(e.jacobian.rows() + extra, terms);
  VectorOf<Real> target(system.rows());
  system.topRows(e.jacobian.rows()) = e.jacobian;
  system.bottomRows(extra) = (sqrt(damping) * MatrixOf<Real>::Identity(terms, terms)).topRows(extra);
  target.head(e.residual.size()) = -e.residual;
  target.tail(extra).setZero();
  return system.colPivHouseholderQr().solve(target);
}

/// Gauss–Newton with Levenberg–Marquardt damping. After each step h is replaced by the optimum for the new C, which reaches
/// what the few terms of the series do not. The residual is so small that this converges like Newton's method; a step that is
/// small may raise E at first, by more than E where E is tiny, and the next one is smaller by as much. The search ends on the
/// step, not on E: E is flat at its minimum, so that it tells h to half as many digits.
template <typename Real>
MisfitMinimum Solver<Real>::minimise() const {
  constexpr int most_iterations = 2000;  // narrow kernels near x0 = ½ have large residuals, and converge linearly
  VectorOf<Real> h = retracted(start_);
  Expansion<Real> here = expand(h);
  Real damping = 0;
  double size = 0;
  double before = std::numeric_limits<double>::infinity();
  bool converged = false;
  int iteration = 0;
  while (!converged && iteration < most_iterations) {
    ++iteration;
    const VectorOf<Real> coefficients = damped_step(here, damping);
    const VectorOf<Real> step = shape_ * coefficients;
    size = static_cast<double>(step.cwiseAbs().maxCoeff());
    const Real left = (here.residual + here.jacobian * coefficients).squaredNorm() / here.weighted_error;
    const double rounding = relative_rounding(here, h);
    const bool newton = damping == 0;
    const bool stalled = size < std::min(1e-4, rounding) && size > before / 2;  // steps made of rounding no longer shrink
    const bool flat = size <= problem_.step_tolerance && left > 1 - problem_.error_tolerance;
    converged = newton && (flat || stalled);
    if (converged) break;
    if (size < 3) {
      const VectorOf<Real> there_h = retracted(moved(h, step));
      const Expansion<Real> there = expand(there_h);
      const bool contracting = newton && size < before / 3 && size < 0.1;
      if (contracting || there.weighted_error < here.weighted_error * (1 + std::min(1e-3, rounding))) {
        h = there_h;
        here = there;
        damping = damping < Real(1e-3) * here.weighted_error ? Real(0) : Real(damping / 100);
        if (newton) before = size;
        continue;
      }
    }
    damping = std::max(Real(10 * damping), Real(Real(1e-2) * here.weighted_error));
  }
  if (!converged)
    throw std::runtime_error("least-misfit kernel of width " + std::to_string(problem_.width) +
                             " at x0 = " + std::to_string(problem_.x0) + " did not converge within " +
                             std::to_string(iteration) + " iterations");
  const VectorOf<Real> best = retracted(h);
  const Real& centre = best[best.size() - 1];
  MisfitMinimum minimum;
  minimum.log_h = series(best / centre);
  minimum.error = here.error.template cast<double>();
  minimum.mean_error = static_cast<double>(here.error.dot(nodes_.weight));
  minimum.weighted_error = static_cast<double>(here.weighted_error);
  minimum.h_range = static_cast<double>(h.maxCoeff() / h.minCoeff());
  minimum.rounding = relative_rounding(here, h);
  minimum.step = size;
  minimum.condition = condition_at(h);
  minimum.iterations = iteration;
  minimum.taps = taps_at(h, centre);
  return minimum;
}

/// The taps of the optimal C for h, times `scale`.
template <typename Real>
TapFunction Solver<Real>::taps_at(const VectorOf<Real>& h, const Real& scale) const {
  const auto both = std::make_shared<const std::vector<Half<Real>>>(halves(h));
  return [both, scale, width = problem_.width](double t) {
    VectorOf<Real> sum = VectorOf<Real>::Zero(width);
    for (const Half<Real>& half : *both) {
      const VectorOf<Real> part = half.solve(Real(t));
      for (std::size_t k = 0; k < half.offset().size(); ++k) {
        const auto r = static_cast<Eigen::Index>(std::lround(half.offset()[k] + (width - 1) / 2.0));
        const Real value = scale * part[static_cast<Eigen::Index>(k)];
        const Eigen::Index mirrored = width - 1 - r;
        if (mirrored == r) {
          sum[r] += value;
        } else {
          sum[r] += value / 2;
          sum[mirrored] += half.parity() == Half<Real>::Parity::even ? Real(value / 2) : Real(-value / 2);
        }
      }
    }
    return Eigen::VectorXd(sum.template cast<double>());
  };
}

template <typename Real>
double Solver<Real>::condition_at(const VectorOf<Real>& h) const {
  Real largest = 0;
  Real smallest = std::numeric_limits<Real>::max();
  for (const Half<Real>& half : halves(h)) {
    const auto values = half.singular_values();
    largest = std::max(largest, values.largest);
    smallest = std::min(smallest, values.smallest);
  }
  return static_cast<double>((largest / smallest) * (largest / smallest));
}

}  // namespace misfit::kernels
