#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <random>
#include <string>

#include "kernels/catalogue.h"
#include "kernels/quadrature.h"
#include "tools/base/numbers.h"
#include "tools/report/kernel_curves.h"
#include "tools/stability/stability_report.h"

namespace misfit::tools {
namespace {

constexpr double part_imaged = 0.25;  ///< x0

/// The error of one visibility over the image: RMS over |x| ≤ part_imaged of exp(2πiux) − h(x) Σ_r C_r exp(2πi(k + s_r)x),
/// where the visibility at u was gridded to the cell k with the taps of position t.
class PointError {
 public:
  explicit PointError(const kernels::PiecewisePolynomial& kernel)
      : kernel_(kernel),
        rule_(kernels::gauss_legendre(24, -part_imaged, part_imaged)),
        h_(kernels::optimal_correction(kernel, rule_.node)) {}

  /// `off` = u − (k + t): how far the visibility lies from where it was taken to be.
  double square(double t, double off = 0) const {
    return mean([&](Eigen::Index i) { return turn(i, t + off) - image(i, t); });
  }
  /// The squared difference between gridding a visibility on either side of a cell's boundary.
  double square_of_jump() const {
    return mean([&](Eigen::Index i) { return turn(i, 1) * image(i, -0.5) - image(i, 0.5); });
  }

 private:
  std::complex<double> turn(Eigen::Index i, double u) const {
    return std::polar(1.0, 2 * std::numbers::pi * u * rule_.node[i]);
  }
  std::complex<double> image(Eigen::Index i, double t) const {
    const Eigen::VectorXd taps = kernel_(t);
    std::complex<double> sum = 0;
    for (Eigen::Index r = 0; r < taps.size(); ++r)
      sum += taps[r] * turn(i, static_cast<double>(r) - static_cast<double>(taps.size() - 1) / 2);
    return h_[i] * sum;
  }
  template <typename Difference>
  double mean(const Difference& difference) const {
    double sum = 0;
    for (Eigen::Index i = 0; i < rule_.node.size(); ++i) sum += rule_.weight[i] * std::norm(difference(i));
    return sum / (2 * part_imaged);
  }

  kernels::PiecewisePolynomial kernel_;
  kernels::Quadrature rule_;
  Eigen::VectorXd h_;
};

kernels::Kernel kernel_of(int width) {
  return kernels::kernel_family("least-misfit").make(width, part_imaged);
}

/// The largest jump of C where cells meet, its ends at ±W/2 left out.
double largest_jump(const kernels::PiecewisePolynomial& kernel) {
  const Eigen::VectorXd before = kernel(0.5);  // C(s_r − ½), which is where the cell of tap r − 1 ends
  const Eigen::VectorXd after = kernel(-0.5);
  const Eigen::Index inner = kernel.width() - 1;
  return inner == 0 ? 0 : (before.tail(inner) - after.head(inner)).cwiseAbs().maxCoeff();
}

/// The numbers of the table for one width.
struct BoundaryErrors {
  double rms = 0;  ///< √E
  double on_grid = 0;
  double half_way = 0;
  double change = 0;
  double jump = 0;
  bool mirrored = true;
};

BoundaryErrors boundary_errors(int width) {
  const kernels::Kernel kernel = kernel_of(width);
  const PointError error(kernel.polynomial);
  BoundaryErrors found{.rms = std::sqrt(kernel.misfit.mean)};
  const double odd = width % 2;
  found.on_grid = std::sqrt(error.square(0.5 - odd / 2));
  found.half_way = std::sqrt(error.square(odd / 2));
  found.change = std::sqrt(error.square_of_jump());
  found.jump = largest_jump(kernel.polynomial);
  for (const double t : {0.0, 0.25, 0.3, 0.5})
    found.mirrored = found.mirrored && kernel.polynomial(-t) == kernel.polynomial(t).reverse();
  return found;
}

/// A coordinate rounded to `Real`, split into a cell and a position in it; the rounding that this made.
template <typename Real>
struct Split {
  double t = 0;
  double off = 0;

  explicit Split(long double u) {
    const Real rounded = static_cast<Real>(u);
    const Real cell = std::round(rounded);
    t = static_cast<double>(rounded - cell);
    off = static_cast<double>(u - (static_cast<long double>(cell) + static_cast<long double>(t)));
  }
};

/// RMS error of visibilities at coordinates between `size` and twice that.
template <typename Real>
double error_at_size(const PointError& error, double size) {
  constexpr int samples = 400;
  std::mt19937_64 random(1);
  std::uniform_real_distribution<long double> uniform(1, 2);
  double sum = 0;
  for (int i = 0; i < samples; ++i) {
    const Split<Real> split(size * uniform(random));
    sum += error.square(split.t, split.off);
  }
  return std::sqrt(sum / samples);
}

template <typename Real>
Series coordinate_curve(const std::string& label, int width) {
  const PointError error(kernel_of(width).polynomial);
  Series series{.label = label + ", " + width_label(width), .x = {}, .y = {}, .points = true};
  for (int power = 0; power <= 40; power += 2) {
    series.x.push_back(std::ldexp(1.0, power));
    series.y.push_back(error_at_size<Real>(error, series.x.back()));
  }
  return series;
}

/// 2π part_imaged/√3 times the RMS of a rounding that is uniform over a unit in the last place.
Series coordinate_law(const std::string& label, double epsilon) {
  Series law{.label = label, .x = {}, .y = {}, .law = true};
  for (int power = 0; power <= 40; power += 2) {
    const double rounding = std::ldexp(epsilon, power) / std::sqrt(12.0);
    const double error = 2 * std::numbers::pi * part_imaged / std::sqrt(3.0) * rounding;
    if (error > 1) break;
    law.x.push_back(std::ldexp(1.0, power));
    law.y.push_back(error);
  }
  return law;
}

}  // namespace

ReportSection boundaries_section() {
  DataTable table{.name = "boundaries",
                  .title = "Errors where cells meet, x₀ = 0.25",
                  .caption =
                      "RMS over |x| ≤ x₀ of the error of a visibility at one position; on a grid point and half-way between "
                      "two. For odd W cells meet half-way between grid points, for even W on them. “Other side” is how much "
                      "the image of a visibility changes when it crosses the boundary. The last column compares the taps at "
                      "t and −t, in reverse, bit by bit.",
                  .columns = {"W", "√E", "on a grid point", "half-way", "other side", "largest jump of C", "mirrored"},
                  .rows = {}};
  double largest_change = 0;
  double largest_step = 0;
  for (int width = 1; width <= 14; ++width) {
    const BoundaryErrors found = boundary_errors(width);
    largest_change = std::max(largest_change, found.change / found.rms);
    largest_step = std::max(largest_step, found.jump / found.rms);
    table.rows.push_back({static_cast<double>(width), found.rms, found.on_grid, found.half_way, found.change, found.jump,
                          std::string(found.mirrored ? "equal" : "different")});
  }
  const std::string text =
      "C jumps where cells meet, by up to " + power_of_ten(largest_step, 2) +
      " times √E here: the optimum has no reason to be continuous. A visibility on a boundary may be "
      "gridded to either side all the same, since all its taps change together: the two images differ by at "
      "most " +
      significant(largest_change, 2) + " times √E.";
  return {.heading = "Where cells meet", .paragraphs = {text}, .figures = {}, .tables = {table}};
}

ReportSection coordinates_section() {
  Figure figure{.name = "coordinates",
                .title = "Error of visibilities far from the origin, x₀ = 0.25",
                .caption =
                    "RMS over |x| ≤ x₀ and 400 random visibilities with coordinates from the one shown to twice that. Broken: "
                    "2πx₀/√3 times the RMS rounding of the coordinate.",
                .x = {.label = "coordinate, cells", .logarithmic = true, .from = {}, .to = {}},
                .y = {.label = "RMS error", .logarithmic = true, .from = 1e-16, .to = 3},
                .series = {}};
  figure.series = {coordinate_curve<double>("double", 7), coordinate_curve<double>("double", 13),
                   coordinate_curve<float>("float", 7), coordinate_law("law, double", 0x1p-52),
                   coordinate_law("law, float", 0x1p-23)};
  const PointError wide(kernel_of(13).polynomial);
  const PointError usual(kernel_of(7).polynomial);
  const std::string text =
      "A coordinate of u cells held in doubles is off by 2⁻⁵³ u at most, and the fraction within the cell "
      "keeps that error. At 10⁶ cells W = 13 errs by " +
      power_of_ten(error_at_size<double>(wide, 1e6), 2) + ", W = 7 by " + power_of_ten(error_at_size<double>(usual, 1e6), 2) +
      ", and with coordinates held in floats by " + power_of_ten(error_at_size<float>(usual, 1e6), 2) +
      ". So coordinates stay in doubles until the fraction is taken, also where values are single.";
  return {.heading = "Large coordinates", .paragraphs = {text}, .figures = {figure}, .tables = {}};
}

}  // namespace misfit::tools
