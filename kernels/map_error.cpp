#include "kernels/map_error.h"

#include <cmath>
#include <numbers>

#include "kernels/positions_internal.h"

namespace misfit::kernels {
namespace {

/// Re and Im of Σ_r C_r(t) exp(2πi(s_r−t)x): what a unit visibility at t looks like at x, before correction. [x][t]
struct Response {
  Eigen::ArrayXXd real;
  Eigen::ArrayXXd imaginary;
};

/// C(−u) = C(u) makes the response at −t the conjugate of that at t, so that t ≥ 0 suffices everywhere.
Response response(const TapFunction& taps, const Eigen::VectorXd& x, const Eigen::VectorXd& t) {
  const auto width = static_cast<int>(taps(0).size());
  Eigen::MatrixXd cosine(x.size(), width);
  Eigen::MatrixXd sine(x.size(), width);
  for (int r = 0; r < width; ++r) {
    const Eigen::ArrayXd phase = 2 * std::numbers::pi * (r - (width - 1) / 2.0) * x.array();
    cosine.col(r) = phase.cos();
    sine.col(r) = phase.sin();
  }
  Eigen::MatrixXd tap(width, t.size());
  for (Eigen::Index i = 0; i < t.size(); ++i) tap.col(i) = taps(t[i]);
  const Eigen::ArrayXXd real = cosine * tap;
  const Eigen::ArrayXXd imaginary = sine * tap;
  const Eigen::ArrayXXd phase = 2 * std::numbers::pi * (x * t.transpose()).array();
  return {real * phase.cos() + imaginary * phase.sin(), imaginary * phase.cos() - real * phase.sin()};
}

Positions positions(int steps_per_cell) {
  return steps_per_cell > 0 ? stepped_positions(steps_per_cell) : smooth_positions();
}

/// c(x) is the mean of the response over t, and Σ_n c(x−n)² the mean of its square (Parseval over the period 1 of ν).
Eigen::VectorXd correction(const Response& seen, const Eigen::VectorXd& weight) {
  const Eigen::VectorXd c = seen.real.matrix() * weight;
  const Eigen::VectorXd power = (seen.real.square() + seen.imaginary.square()).matrix() * weight;
  return c.cwiseQuotient(power);
}

/// |1 − h(x) response(x, t)|²
Eigen::ArrayXXd squared_error(const Response& seen, const Eigen::VectorXd& h) {
  return (seen.real.colwise() * h.array() - 1).square() + (seen.imaginary.colwise() * h.array()).square();
}

Eigen::VectorXd correction_by(const JudgeOptions& options, const Response& seen, const Quadrature& t,
                              const Eigen::VectorXd& x) {
  return options.correction ? options.correction(x) : correction(seen, t.weight);
}

/// Means by the weights of x, maxima over its nodes.
Misfit judge_at(const TapFunction& taps, const Quadrature& x, const JudgeOptions& options) {
  const Positions t = positions(options.steps_per_cell);
  const Response seen = response(taps, x.node, t.mean.node);
  const Eigen::VectorXd h = correction_by(options, seen, t.mean, x.node);
  const Eigen::VectorXd error = squared_error(seen, h).matrix() * t.mean.weight;
  const Eigen::ArrayXXd at_position = squared_error(response(taps, x.node, t.extreme), h);
  return {x.weight.dot(error), error.maxCoeff(), (x.weight.transpose() * at_position.matrix()).maxCoeff(),
          at_position.maxCoeff()};
}

/// ∫ C² du.
double mean_square(const TapFunction& taps) {
  const Quadrature t = smooth_positions().mean;
  double sum = 0;
  for (Eigen::Index i = 0; i < t.node.size(); ++i) sum += t.weight[i] * taps(t.node[i]).squaredNorm();
  return sum;
}

}  // namespace

Eigen::VectorXd optimal_correction(const TapFunction& taps, const Eigen::VectorXd& x, int steps_per_cell) {
  const Quadrature t = positions(steps_per_cell).mean;
  return correction(response(taps, x, t.node), t.weight);
}

Eigen::VectorXd image_taper(const TapFunction& taps, const Eigen::VectorXd& x, int steps_per_cell) {
  const Quadrature t = positions(steps_per_cell).mean;
  return response(taps, x, t.node).real.matrix() * t.weight;
}

Correction reciprocal_taper(const TapFunction& taps) {
  return [taps](const Eigen::VectorXd& x) -> Eigen::VectorXd { return image_taper(taps, x).cwiseInverse(); };
}

Correction relative_reciprocal_taper(const TapFunction& taps) {
  const double whole = image_taper(taps, Eigen::VectorXd::Zero(1))[0];
  return [taps, whole](const Eigen::VectorXd& x) -> Eigen::VectorXd { return whole * image_taper(taps, x).cwiseInverse(); };
}

Eigen::VectorXd map_error(const TapFunction& taps, const Eigen::VectorXd& x, const JudgeOptions& options) {
  const Quadrature t = positions(options.steps_per_cell).mean;
  const Response seen = response(taps, x, t.node);
  return squared_error(seen, correction_by(options, seen, t, x)).matrix() * t.weight;
}

Misfit judge(const TapFunction& taps, double x0, const JudgeOptions& options) {
  const Quadrature rule = gauss_legendre(48, 0, x0);
  Quadrature x{Eigen::VectorXd(rule.node.size() + 1), Eigen::VectorXd(rule.node.size() + 1)};
  x.node << rule.node, x0;
  x.weight << rule.weight / x0, 0;
  return judge_at(taps, x, options);
}

Misfit judge_pixels(const TapFunction& taps, int pixels, int fft_size) {
  const Eigen::VectorXd pixel = Eigen::VectorXd::LinSpaced(pixels, -(pixels / 2), (pixels - 1) / 2);
  return judge_at(taps, {pixel / fft_size, Eigen::VectorXd::Constant(pixels, 1.0 / pixels)}, {});
}

double noise_gain(const TapFunction& taps, double x0) {
  const Quadrature x = gauss_legendre(48, 0, x0);
  const double h_square = x.weight.dot(optimal_correction(taps, x.node).cwiseAbs2()) / x0;
  return std::sqrt(h_square * mean_square(taps));
}

double largest_noise_gain(const TapFunction& taps, double x0) {
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(65, 0, x0);
  return optimal_correction(taps, x).cwiseAbs().maxCoeff() * std::sqrt(mean_square(taps));
}

}  // namespace misfit::kernels
