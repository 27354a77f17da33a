#include "kernels/least_misfit.h"

#include <Eigen/QR>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <stdexcept>

#include "kernels/quadrature.h"

namespace misfit::kernels {
namespace {

using Eigen::ArrayXd;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// The misfit E(h) with C eliminated. For every t, C(s_r − t) minimises ∫ |exp(2πitx) − h(x) Σ_r C_r exp(2πi s_r x)|² dx. By
/// symmetry the sums C_r ± C_{W−1−r} solve two problems of half the size: the real part in cosines and the imaginary part in
/// sines. QR of the design matrix, not its normal equations: the latter lose E below eps²·cond.
class Half {
 public:
  enum class Parity { even, odd };

  Half(Parity parity, int width, const Quadrature& x, const VectorXd& h)
      : parity_(parity), x_(x.node), root_weight_(x.weight.cwiseSqrt()) {
    for (int r = 0; r < width; ++r) {
      const double s = r - (width - 1) / 2.0;
      if (s > 0 || (s == 0 && parity == Parity::even)) offset_.push_back(s);
    }
    basis_.resize(x_.size(), static_cast<Eigen::Index>(offset_.size()));
    for (std::size_t k = 0; k < offset_.size(); ++k) basis_.col(static_cast<Eigen::Index>(k)) = wave(offset_[k]);
    orthonormal_.resize(x_.size(), 0);
    if (offset_.empty()) return;  // W = 1 has no odd part
    factor_.compute((root_weight_.cwiseProduct(h)).asDiagonal() * basis_);
    orthonormal_ = factor_.householderQ() * MatrixXd::Identity(x_.size(), factor_.rank());
  }

  /// cos or sin(2π s x) at the nodes in x.
  VectorXd wave(double s) const {
    const ArrayXd phase = 2 * std::numbers::pi * s * x_.array();
    if (parity_ == Parity::even) return phase.cos();
    return phase.sin();
  }
  VectorXd weighted_wave(double t) const { return root_weight_.cwiseProduct(wave(t)); }
  /// The part of each column outside the span of the design matrix.
  MatrixXd outside(const MatrixXd& columns) const { return columns - orthonormal_ * (orthonormal_.transpose() * columns); }
  /// C_r + C_{W−1−r} (even; the middle tap alone) or C_r − C_{W−1−r} (odd) for the offsets s_r ≥ 0.
  VectorXd solve(double t) const {
    if (offset_.empty()) return VectorXd();
    return factor_.solve(weighted_wave(t));
  }
  const std::vector<double>& offset() const { return offset_; }
  Parity parity() const { return parity_; }

 private:
  Parity parity_;
  VectorXd x_;
  VectorXd root_weight_;
  std::vector<double> offset_;
  MatrixXd basis_;
  Eigen::ColPivHouseholderQR<MatrixXd> factor_;
  MatrixXd orthonormal_;
};

/// E(h) and its derivatives with respect to the coefficients p of log h = Σ_j p_j φ_j, at the optimal C. With y the target, r
/// the residual, v = y − r the fit and P the projection onto the design matrix, the Jacobian of r is −(1−P) φ_j v to first
/// order in r (Kaufman 1975, BIT 15, 49), and its product with r is the exact gradient. It is kept as a matrix, never squared:
/// its singular values span as many decades as √E.
struct Expansion {
  double mean_error = 0;
  VectorXd residual;  ///< r: [half, t, x], weighted, so that E is its square
  MatrixXd jacobian;  ///< [half, t, x][j]
  VectorXd best_h;    ///< c / Σ c(x−n)² at the nodes: the optimal h for this C
};

class Problem {
 public:
  Problem(int width, int widest, double x0)
      : width_(width), x_(gauss_legendre(2 * widest + 18, x0, 0)), t_(gauss_legendre(width + 12, 0, 0.5)) {
    x_.weight /= -x0;
    t_.weight *= 2;
    const int terms = width / 2 + 4;
    shape_.resize(x_.node.size(), terms);
    for (int j = 0; j < terms; ++j) shape_.col(j) = (2 * (j + 1) * (x_.node.array() / x0).acos()).cos();
  }

  Expansion expand(const VectorXd& h) const {
    const Eigen::Index n = x_.node.size();
    const Eigen::Index rows = 2 * t_.node.size() * n;
    Expansion e{0, VectorXd(rows), MatrixXd(rows, shape_.cols()), {}};
    VectorXd c = VectorXd::Zero(n);
    VectorXd power = VectorXd::Zero(n);
    Eigen::Index at = 0;
    for (const Half& half : halves(h)) {
      for (Eigen::Index i = 0; i < t_.node.size(); ++i, at += n) {
        const VectorXd y = half.weighted_wave(t_.node[i]);
        const VectorXd r = half.outside(y);
        const VectorXd v = y - r;
        c += t_.weight[i] * y.cwiseProduct(v);
        power += t_.weight[i] * v.cwiseAbs2();
        e.residual.segment(at, n) = std::sqrt(t_.weight[i]) * r;
        e.jacobian.middleRows(at, n) = -std::sqrt(t_.weight[i]) * half.outside(v.asDiagonal() * shape_);
      }
    }
    e.mean_error = e.residual.squaredNorm();
    e.best_h = h.cwiseProduct(c).cwiseQuotient(power);
    return e;
  }

  VectorXd moved(const VectorXd& h, const VectorXd& step) const { return h.array() * (shape_ * step).array().exp(); }
  const VectorXd& x() const { return x_.node; }
  std::vector<Half> halves(const VectorXd& h) const {
    return {Half(Half::Parity::even, width_, x_, h), Half(Half::Parity::odd, width_, x_, h)};
  }

 private:
  int width_;
  Quadrature x_;
  Quadrature t_;
  MatrixXd shape_;  ///< T_2j(x/x0), j = 1, 2, …
};

/// The decrease of E, relative to E, that counts as none: what is asked of E, and what the rounding of the residual leaves
/// visible.
double negligible(double mean_error) {
  constexpr double rounding = std::numeric_limits<double>::epsilon();
  return 1e-13 + 0.1 * rounding / std::sqrt(mean_error) + 200 * rounding * rounding / mean_error;
}

struct Minimum {
  VectorXd h;
  double mean_error;
  int iterations;
};

/// The p that minimises |residual + jacobian p|² + damping |p|².
VectorXd damped_step(const Expansion& e, double damping) {
  const Eigen::Index terms = e.jacobian.cols();
  MatrixXd system(e.jacobian.rows() + terms, terms);
  system << e.jacobian, std::sqrt(damping) * MatrixXd::Identity(terms, terms);
  VectorXd target(system.rows());
  target << -e.residual, VectorXd::Zero(terms);
  return system.colPivHouseholderQr().solve(target);
}

/// Gauss–Newton with Levenberg–Marquardt damping; after each step h is replaced by the optimum for the new C, which never
/// raises E and reaches what the few terms of the series do not. The residual is so small that this converges like Newton's
/// method.
Minimum minimise(const Problem& problem, VectorXd h, int width, double x0) {
  constexpr int most_iterations = 60;
  Expansion here = problem.expand(h);
  double damping = 0;
  for (int iteration = 1; iteration <= most_iterations; ++iteration) {
    const VectorXd step = damped_step(here, damping);
    const double decrease = here.mean_error - (here.residual + here.jacobian * step).squaredNorm();
    if (damping == 0 && decrease <= negligible(here.mean_error) * here.mean_error) return {h, here.mean_error, iteration};
    const Expansion there = step.norm() < 3 ? problem.expand(problem.moved(h, step)) : here;
    if (there.mean_error < here.mean_error) {
      h = there.best_h;
      here = problem.expand(h);
      damping = damping < 1e-3 * here.mean_error ? 0 : damping / 100;
    } else if (decrease <= 1e-6 * here.mean_error) {
      return {h, here.mean_error, iteration};  // predicted, but lost in the rounding of E
    } else if (damping > 1e9 * here.mean_error) {
      break;
    } else {
      damping = std::max(10 * damping, 1e-2 * here.mean_error);
    }
  }
  constexpr double rounding_of_doubles = 1e-27;
  if (here.mean_error < rounding_of_doubles) return {h, here.mean_error, most_iterations};
  throw std::runtime_error("least-misfit kernel of width " + std::to_string(width) + " at x0 = " + std::to_string(x0) +
                           " did not converge within " + std::to_string(most_iterations) + " iterations");
}

/// Taps for the optimal C at this h, scaled so that h(0) = c(0) / Σ_n c(n)² = 1.
TapFunction taps_at(const Problem& problem, const VectorXd& h, int width) {
  const auto halves = std::make_shared<const std::vector<Half>>(problem.halves(h));
  const auto unscaled = [halves, width](double t) {
    VectorXd taps = VectorXd::Zero(width);
    for (const Half& half : *halves) {
      const VectorXd part = half.solve(t);
      for (std::size_t k = 0; k < half.offset().size(); ++k) {
        const auto r = static_cast<Eigen::Index>(std::lround(half.offset()[k] + (width - 1) / 2.0));
        const double value = part[static_cast<Eigen::Index>(k)];
        if (half.offset()[k] == 0) {
          taps[r] += value;
        } else {
          taps[r] += value / 2;
          taps[width - 1 - r] += half.parity() == Half::Parity::even ? value / 2 : -value / 2;
        }
      }
    }
    return taps;
  };
  const Quadrature cell = gauss_legendre(width + 14, 0, 0.5);
  double c0 = 0;
  double power0 = 0;
  for (Eigen::Index i = 0; i < cell.node.size(); ++i) {
    const double sum = unscaled(cell.node[i]).sum();
    c0 += cell.weight[i] * sum;
    power0 += cell.weight[i] * sum * sum;
  }
  return [unscaled, scale = c0 / power0](double t) -> VectorXd { return scale * unscaled(t); };
}

void check_request(int width, double x0) {
  if (width < 1 || width > least_misfit_max_width)
    throw std::invalid_argument("least-misfit kernel: width " + std::to_string(width) + " not in [1, " +
                                std::to_string(least_misfit_max_width) + "]");
  if (!(x0 >= least_misfit_min_x0 && x0 <= least_misfit_max_x0))
    throw std::invalid_argument("least-misfit kernel: x0 = " + std::to_string(x0) + " not in [0.05, 0.49]");
}

}  // namespace

std::vector<LeastMisfit> solve_least_misfit(int width, double x0) {
  check_request(width, x0);
  std::vector<LeastMisfit> solutions;
  // h_W is extrapolated from the two solutions before it, so all widths share their nodes in x.
  VectorXd last;
  VectorXd before_last;
  for (int w = 1; w <= width; ++w) {
    const Problem problem(w, width, x0);
    VectorXd start = VectorXd::Ones(problem.x().size());
    if (w == 2) start = last;
    if (w > 2) start = last.cwiseAbs2().cwiseQuotient(before_last);
    const Minimum minimum = minimise(problem, start, w, x0);
    before_last = last;
    last = minimum.h;
    solutions.push_back({w, x0, minimum.mean_error, minimum.iterations, taps_at(problem, minimum.h, w)});
  }
  return solutions;
}

std::vector<Kernel> least_misfit_up_to(int width, double x0) {
  std::vector<Kernel> kernels;
  for (const LeastMisfit& solution : solve_least_misfit(width, x0))
    kernels.push_back(make_kernel("least-misfit", x0, solution.taps));
  return kernels;
}

}  // namespace misfit::kernels
