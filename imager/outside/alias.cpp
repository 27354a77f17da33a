#include "imager/outside/alias.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "imager/data/extent.h"
#include "imager/numerics/constants.h"
#include "kernels/evaluation.h"

namespace misfit::imager {
namespace {

constexpr int cells = 16;

/// A copy of a source along one axis.
struct Copy {
  bool own = false;  ///< n is 0
  const std::vector<double>* height = nullptr;
  std::vector<double> distance{};  ///< [cell] to the nearest pixel
};

/// The nearest copy, the copy of n = 0, and copies beside them.
std::vector<Copy> copies_of(const AliasLevels::Axis& axis, double offset, double place) {
  const int nearest = static_cast<int>(std::lround(offset / axis.fft_size));
  std::vector<Copy> copies;
  for (const int n : std::set<int>{nearest - 1, nearest, nearest + 1, -1, 0, 1}) {
    if (std::abs(n) > axis.most) continue;
    copies.push_back({n == 0, &*(axis.height.begin() + axis.most + n)});
    const double at = offset - n * axis.fft_size;
    for (const auto& [first, last] : axis.cell)
      copies.back().distance.push_back(std::max(0.0, std::abs(at - std::clamp(at, first, last)) - place));
  }
  return copies;
}

/// ℓ of two axes together: 1 − (1−a)(1−b).
double either(double a, double b) {
  return a + b - a * b;
}

/// The ℓ that tables add to a kernel's.
double missed_by_tables(const kernels::Kernel& kernel, const WideTransformOptions& o) {
  return o.lookup ? kernels::judge_table(kernel.polynomial, kernel.misfit, *o.lookup, kernel.x0).max : 0;
}

/// ℓ of the w axis, wherever between planes a pixel lies; of tables; and of rounding.
double missed_besides(const GriddingPlan& plan) {
  const WideTransformOptions& o = plan.options;
  double missed = plan.rounding * plan.rounding;
  for (const kernels::Kernel* kernel : {&o.kernel_u, &o.kernel_v}) missed = either(missed, missed_by_tables(*kernel, o));
  return o.has_w_axis() ? either(missed, either(o.kernel_w.misfit.max, missed_by_tables(o.kernel_w, o))) : missed;
}

/// |1 − exp(iφ)| of the largest phase of w that the transform leaves out.
double out_of_phase(const GriddingPlan& plan) {
  if (plan.options.has_w_axis()) return 0;
  return 2 * std::sin(std::min(max_w_phase_rad(plan.request.max_abs_w, plan.options.geometry), pi) / 2);
}

/// The farthest, along one axis, that a place of `field` lies from the middle of a facet.
double farthest_pixels(const ImageGeometry& image, const ImageGeometry& field) {
  const double apart = std::max(std::abs(image.centre.l - field.centre.l), std::abs(image.centre.m - field.centre.m));
  return (apart + std::max(field.width, field.height) * field.cell_rad) / image.cell_rad + std::max(image.width, image.height);
}

std::vector<Facet> facets_of(const WideTransformOptions& o) {
  return o.has_w_axis() ? split_into_facets(o.geometry, o.facets_l, o.facets_m) : split_into_facets(o.geometry, 1, 1);
}

int largest_width(const std::vector<Facet>& facets) {
  int largest = 0;
  for (const Facet& f : facets) largest = std::max(largest, f.geometry.width);
  return largest;
}

int largest_height(const std::vector<Facet>& facets) {
  int largest = 0;
  for (const Facet& f : facets) largest = std::max(largest, f.geometry.height);
  return largest;
}

}  // namespace

AliasLevels::Axis::Axis(const kernels::Kernel& kernel, int pixels, int size, double farthest_pixels)
    : fft_size(size), most(static_cast<int>(std::ceil(farthest_pixels / size)) + 1) {
  const Eigen::VectorXd edge = Eigen::VectorXd::LinSpaced(cells + 1, -(pixels / 2), (pixels - 1) / 2) / fft_size;
  const auto of_cells = [&](const Eigen::VectorXd& at_edge) {
    std::vector<double> highest;
    for (int i = 0; i < cells; ++i) highest.push_back(std::max(std::abs(at_edge[i]), std::abs(at_edge[i + 1])));
    return highest;
  };
  for (int i = 0; i < cells; ++i) cell.emplace_back(edge[i] * fft_size, edge[i + 1] * fft_size);
  missed = of_cells(kernels::map_error(kernel.polynomial, edge));
  const Eigen::VectorXd h = kernels::optimal_correction(kernel.polynomial, edge);
  for (int n = -most; n <= most; ++n)
    height.push_back(of_cells(h.cwiseProduct(kernels::image_taper(kernel.polynomial, (edge.array() + n).matrix()))));
}

AliasLevels::AliasLevels(const GriddingPlan& plan, const ImageGeometry& field, Sidelobes sidelobes)
    : facets_(facets_of(plan.options)),
      sidelobes_(std::move(sidelobes)),
      place_pixels_(0.5 * field.cell_rad / plan.options.geometry.cell_rad),
      u_(plan.options.kernel_u, largest_width(facets_), plan.options.nu, farthest_pixels(plan.options.geometry, field)),
      v_(plan.options.kernel_v, largest_height(facets_), plan.options.nv, farthest_pixels(plan.options.geometry, field)),
      out_of_phase_(out_of_phase(plan)),
      rounding_(plan.rounding),
      missed_besides_(missed_besides(plan)) {}

double AliasLevels::of_facet(double offset_u, double offset_v) const {
  const std::vector<Copy> along_u = copies_of(u_, offset_u, place_pixels_), along_v = copies_of(v_, offset_v, place_pixels_);
  const double far_square = sidelobes_.far() * sidelobes_.far();
  const double not_cancelled = out_of_phase_ * out_of_phase_;
  double worst = 0;
  for (std::size_t i = 0; i < cells; ++i)
    for (std::size_t j = 0; j < cells; ++j) {
      const double missed = either(u_.missed[i], v_.missed[j]);
      double square = (either(missed, missed_besides_) + not_cancelled) * far_square;
      for (const Copy& u : along_u)
        for (const Copy& v : along_v) {
          const double product = (*u.height)[i] * (*v.height)[j];
          const bool own = u.own && v.own;  // (1 − H_0)², and besides (1−ℓ)(1+ℓ) of what is missed there
          const double part = own ? missed * missed + missed_besides_ * (1 - missed * missed) + not_cancelled
                                  : product * product + rounding_ * rounding_;
          const double level = sidelobes_.from(std::max(u.distance[i], v.distance[j]));
          square += part * (level * level - far_square);
        }
      worst = std::max(worst, square);
    }
  return std::sqrt(worst);
}

double AliasLevels::of(DirectionCosines source) const {
  double worst = 0;
  for (const Facet& facet : facets_) {
    if (facet.empty) continue;
    const ImageGeometry& g = facet.geometry;
    worst = std::max(worst, of_facet((g.centre.l - source.l) / g.cell_rad, (source.m - g.centre.m) / g.cell_rad));
  }
  return worst;
}

}  // namespace misfit::imager
