#pragma once

#include <array>
#include <cmath>
#include <complex>
#include <vector>

#include "imager/data/visibilities.h"
#include "imager/direct/direct_transform.h"
#include "imager/numerics/constants.h"
#include "imager/plan/gridding_plan.h"
#include "imager/wide/facet.h"

namespace misfit::imager::testing {

/// R = h(x) Σ_r C(s_r − t) exp(2πi(s_r − t)x): what an axis makes of a unit visibility at x, 1 were it exact. Without a
/// kernel, 1.
inline std::complex<double> response(const kernels::Kernel& kernel, double x, double t) {
  if (kernel.width() == 0) return 1;
  const Eigen::VectorXd tap = kernel.polynomial(t);
  std::complex<double> sum = 0;
  for (int r = 0; r < kernel.width(); ++r) sum += tap[r] * std::polar(1.0, 2 * pi * (r - (kernel.width() - 1) / 2.0 - t) * x);
  return kernels::optimal_correction(kernel.polynomial, Eigen::VectorXd::Constant(1, x))[0] * sum;
}

/// A pixel as the kernels of its facet see it, and where in their cells samples have to lie for the largest error there.
class Adversary {
 public:
  /// All samples have |w| = `neglected_w` wavelengths where the options have no w axis.
  Adversary(const WideTransformOptions& options, Pixel at, double neglected_w = 0)
      : options_(options), direction_(options.geometry.at(at.row, at.column)), neglected_w_(neglected_w) {
    const bool wide = options.has_w_axis();
    for (const Facet& f : split_into_facets(options.geometry, wide ? options.facets_l : 1, wide ? options.facets_m : 1)) {
      const int row = at.row - f.first_row, column = at.column - f.first_column;
      if (row < 0 || column < 0 || row >= f.geometry.height || column >= f.geometry.width) continue;
      facet_ = f;
      x_ = {-double(column - f.geometry.centre_column()) / options.nu, double(row - f.geometry.centre_row()) / options.nv, 0};
      if (wide) {
        plane_step_ = options.kernel_w.x0 / f.reach;
        x_[2] = f.curvature(column, row) * plane_step_;
      }
    }
    search();
  }

  /// The largest |1 − R_u R_v R_w| that a scan over the positions in a cell finds.
  double largest_error() const { return std::abs(error_at(t_)); }

  /// `across`² samples of weight 1 and |V| = 1 in as many cells, in three planes of w, whose errors at the pixel are all the
  /// largest and of one sign.
  VisibilityBlock samples(int across) const {
    VisibilityBlock block;
    block.frequency_hz = {speed_of_light_m_s};  // metres are wavelengths
    const std::complex<double> phase = std::polar(1.0, std::arg(error_at(t_)));
    const ImageGeometry& g = options_.geometry;
    for (int p = 0; p < across; ++p)
      for (int q = 0; q < across; ++q) {
        const double w = options_.has_w_axis() ? position(2, p % 3) * plane_step_ : neglected_w_;
        const double u = position(0, p - across / 2) / (g.cell_rad * options_.nu) - facet_.slope_l * (w - neglected_w_);
        const double v = position(1, q - across / 2) / (g.cell_rad * options_.nv) - facet_.slope_m * (w - neglected_w_);
        block.uvw_m.append({u, v, w});
        const double turns = u * direction_.l + v * direction_.m + w * n_minus_1(direction_);
        block.visibility.emplace_back(std::polar(1.0, 2 * pi * turns) * phase);
        block.weight.push_back(1);
      }
    return block;
  }

 private:
  using Positions = std::array<double, 3>;  ///< t along u, v, w

  const kernels::Kernel& kernel(std::size_t axis) const {
    return axis == 0 ? options_.kernel_u : axis == 1 ? options_.kernel_v : options_.kernel_w;
  }
  std::complex<double> neglected() const { return std::polar(1.0, -2 * pi * neglected_w_ * n_minus_1(direction_)); }
  std::complex<double> error_at(const Positions& t) const {
    return 1.0 -
           response(kernel(0), x_[0], t[0]) * response(kernel(1), x_[1], t[1]) * response(kernel(2), x_[2], t[2]) * neglected();
  }
  /// Where a sample lies on the grid: its points are the integers along u and v, and lie halfway between along w; the middle
  /// of a cell is a point where the width is odd, and between two where it is even.
  double position(std::size_t axis, int cell) const {
    return cell + (axis == 2 ? 0.5 : 0) + (kernel(axis).width() % 2 == 0 ? 0.5 : 0) + t_[axis];
  }
  void search() {
    constexpr int steps = 64;
    const auto t_of = [](int k) { return (k - steps / 2) * (0.999999 / steps); };  // taps may jump at the ends
    std::array<std::vector<std::complex<double>>, 3> seen;
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (int k = 0; k <= (kernel(axis).width() > 0 ? steps : 0); ++k)
        seen[axis].push_back(response(kernel(axis), x_[axis], t_of(k)));
    double most = -1;
    for (std::size_t k = 0; k < seen[2].size(); ++k)
      for (std::size_t i = 0; i < seen[0].size(); ++i)
        for (std::size_t j = 0; j < seen[1].size(); ++j) {
          const double error = std::norm(1.0 - seen[0][i] * seen[1][j] * seen[2][k] * neglected());
          if (error <= most) continue;
          most = error;
          t_ = {t_of(int(i)), t_of(int(j)), t_of(int(k))};
        }
  }

  const WideTransformOptions& options_;
  Facet facet_;
  DirectionCosines direction_;
  double neglected_w_;
  std::array<double, 3> x_{};
  double plane_step_ = 0;
  Positions t_{};
};

}  // namespace misfit::imager::testing
