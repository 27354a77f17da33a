#include "imager/beams/beam.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "imager/beams/main_lobe.h"

namespace misfit::imager {
namespace {

const double fwhm_per_sigma = std::sqrt(8 * std::log(2.0));

/// The quadrant's pixels, in units of the lobe's scale.
std::vector<LobeSample> quadrant(const Image& psf, const MainLobe& lobe) {
  const int row0 = psf.height / 2, column0 = psf.width / 2;
  const int extent = 8 * std::max(lobe.reach, 1);
  const int rows = std::min(extent, psf.height - row0), columns = std::min(extent, psf.width - column0);
  std::vector<LobeSample> samples;
  for (int r = 0; r < rows; ++r)
    for (int c = 0; c < columns; ++c)
      if (const double value = psf.at(row0 + r, column0 + c); std::isfinite(value))
        samples.push_back({-c / lobe.scale, r / lobe.scale, value});
  return samples;
}

/// Normal equations of Σ (exp(−½(p₀e² + 2p₁en + p₂n²)) − value)² at p.
struct Normal {
  Eigen::Matrix3d matrix = Eigen::Matrix3d::Zero();
  Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
  double cost = 0;

  Normal(const std::vector<LobeSample>& samples, const Eigen::Vector3d& p) {
    for (const auto& [east, north, value] : samples) {
      const Eigen::Vector3d x(east * east, 2 * east * north, north * north);
      const double model = std::exp(-0.5 * p.dot(x)), residual = model - value;
      const Eigen::Vector3d derivative = -0.5 * model * x;
      matrix += derivative * derivative.transpose();
      gradient += derivative * residual;
      cost += residual * residual;
    }
  }
};

/// The FWHM, in units of the lobe's scale, beyond which pixels do not define a width: ten times the image's size.
double widest(const Image& psf, const MainLobe& lobe) {
  return 10 * std::max(psf.width, psf.height) / lobe.scale;
}

/// Levenberg–Marquardt from a circle; empty when it ends at a Gaussian that is not bounded, or wider than `widest`.
std::optional<Eigen::Matrix2d> fit_precision(const std::vector<LobeSample>& samples, double widest) {
  // The circle of radius 1 is where a round beam falls to the cutoff.
  Eigen::Vector3d p = -2 * std::log(MainLobe::cutoff) * Eigen::Vector3d(1, 0, 1);
  Normal here(samples, p);
  double damping = 1e-3;
  for (int iteration = 0; iteration < 200 && damping < 1e12; ++iteration) {
    Eigen::Matrix3d damped = here.matrix;
    damped.diagonal() *= 1 + damping;
    const Eigen::Vector3d step = -damped.ldlt().solve(here.gradient);
    const Normal there(samples, p + step);
    const bool better = there.cost < here.cost;
    damping *= better ? 0.1 : 10;
    if (better) p += step, here = there;
    if (step.norm() < 1e-14 * p.norm()) break;
  }
  const Eigen::Matrix2d precision{{p[0], p[1]}, {p[1], p[2]}};
  const bool bounded = p.allFinite() && p[0] > 0 && precision.determinant() > 1e-12 * precision.squaredNorm();
  if (!bounded || precision.selfadjointView<Eigen::Lower>().eigenvalues()[0] < std::pow(fwhm_per_sigma / widest, 2))
    return std::nullopt;
  return precision;
}

Beam beam_of(const Eigen::Matrix2d& precision, double unit_rad) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(precision);  // the major axis has the smaller eigenvalue
  const Eigen::Vector2d major = axes.eigenvectors().col(0);              // (east, north)
  double angle = std::atan2(major[0], major[1]);
  if (angle <= -M_PI_2) angle += M_PI;
  if (angle > M_PI_2) angle -= M_PI;
  const Eigen::Vector2d width = fwhm_per_sigma * unit_rad * axes.eigenvalues().cwiseSqrt().cwiseInverse();
  return {width[0], width[1], angle};
}

/// Pixels come in equal pairs about the centre, and each pair is one equation.
constexpr std::size_t fewest_samples = 7;

[[noreturn]] void refuse(std::size_t samples, std::size_t needed) {
  throw std::runtime_error("no beam can be fitted to the " + std::to_string(samples) +
                           " pixels of the PSF's main lobe; expected " +
                           (samples < needed ? "at least " + std::to_string(needed) + ": use a smaller cell"
                                             : "a lobe that falls off in every direction within the image: "
                                               "use a larger image, or data that cover more of the uv plane"));
}

/// The p for which exp(−½ p r²) fits best, from a circle: Gauss–Newton in log p, which keeps it positive.
double fit_circular_precision(const std::vector<LobeSample>& samples) {
  double p = -2 * std::log(MainLobe::cutoff);
  for (int iteration = 0; iteration < 200; ++iteration) {
    double matrix = 0, gradient = 0;
    for (const auto& [east, north, value] : samples) {
      const double r2 = east * east + north * north, model = std::exp(-0.5 * p * r2);
      const double derivative = -0.5 * p * r2 * model;
      matrix += derivative * derivative;
      gradient += derivative * (model - value);
    }
    const double step = matrix > 0 ? std::clamp(-gradient / matrix, -1.0, 1.0) : 0;
    p *= std::exp(step);
    if (std::abs(step) < 1e-14) break;
  }
  return p;
}

}  // namespace

Beam fit_beam(const Image& psf, double cell_rad, BeamRegion region) {
  const MainLobe lobe = main_lobe(psf);
  const std::size_t needed = region == BeamRegion::main_lobe ? fewest_samples : 5;  // beyond the lobe lie further ones
  std::optional<Eigen::Matrix2d> precision;
  if (lobe.samples.size() >= needed) {
    if (region == BeamRegion::quadrant) precision = fit_precision(quadrant(psf, lobe), widest(psf, lobe));
    if (!precision) precision = fit_precision(lobe.samples, widest(psf, lobe));
  }
  if (!precision) refuse(lobe.samples.size(), needed);
  return beam_of(*precision, lobe.scale * cell_rad);
}

Beam fit_circular_beam(const Image& psf, double cell_rad) {
  const MainLobe lobe = main_lobe(psf);
  if (lobe.samples.size() < 5) refuse(lobe.samples.size(), 5);
  const double p = fit_circular_precision(lobe.samples);
  const double width = fwhm_per_sigma / std::sqrt(p);  // in units of the lobe's scale
  constexpr double widest = 10;
  if (!(width < widest)) refuse(lobe.samples.size(), 5);
  return {width * lobe.scale * cell_rad, width * lobe.scale * cell_rad, 0};
}

double beam_misfit(const Image& psf, const Beam& beam, double cell_rad) {
  const MainLobe lobe = main_lobe(psf);
  if (lobe.samples.empty()) return 0;
  const double east = std::sin(beam.position_angle_rad), north = std::cos(beam.position_angle_rad);
  const double unit = fwhm_per_sigma * lobe.scale * cell_rad;
  double sum = 0;
  for (const LobeSample& s : lobe.samples) {
    const double along = (s.east * east + s.north * north) * unit / beam.major_rad;
    const double across = (s.east * north - s.north * east) * unit / beam.minor_rad;
    sum += std::pow(std::exp(-0.5 * (along * along + across * across)) - s.value, 2);
  }
  return std::sqrt(sum / static_cast<double>(lobe.samples.size()));
}

}  // namespace misfit::imager
