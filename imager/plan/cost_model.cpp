#include "imager/plan/cost_model.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "imager/numerics/fft.h"
#include "imager/numerics/stage_times.h"
#include "imager/transform/transform.h"
#include "kernels/catalogue.h"

namespace misfit::imager {
namespace {

/// The padded taps: inner loops take taps in vectors; see TapTable and stack_loops.cpp.
double padded(const GriddingWork& work) {
  const bool one_vector =
      !work.has_w_axis() && work.precision == Precision::single_precision && work.width > 8 && work.width <= 16;
  return one_vector ? 16 : (work.width + 3) / 4 * 4;
}

/// The factors of costs with a w axis, as measured: a sample's coordinates have a phase and one more axis; a cell lies in a
/// buffer that is no longer in the nearest cache; a point of an FFT is turned by its plane's phase.
constexpr double wide_sample = 5;
constexpr double wide_cell = 1.1;
constexpr double wide_point = 1.15;
constexpr double wide_double_cost = 1.45;  ///< over single precision

/// Points times logarithms of the rows and the kept columns of all images; half of both where the grid is Hermitian, without a
/// w axis; there also only half the columns of a PSF, which is even.
double fft_points(const GriddingWork& work) {
  const double row = work.nu * std::log2(work.nu);
  const double column = work.nv * std::log2(work.nv);
  const double rows = work.images() * work.nv;
  const double columns = work.columns * (work.has_w_axis() || !work.psf ? work.images() : work.stokes + 0.5);
  return (work.has_w_axis() ? 1 : 0.5) * work.planes * (rows * row + columns * column);
}

/// Samples at random over the grid, each a row.
VisibilityBlock random_block(int samples, double cell_rad) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> within(-0.49 / cell_rad, 0.49 / cell_rad);
  VisibilityBlock block;
  block.frequency_hz = {299792458.0};  // u in wavelengths is u in metres
  for (int i = 0; i < samples; ++i) {
    block.uvw_m.append({within(random), within(random), 0});
    block.visibility.emplace_back(1.0F, 0.0F);
    block.weight.push_back(1);
  }
  return block;
}

struct Trial {
  GriddingWork work;
  double seconds = 0;  ///< fastest of three
};

Trial time_of(int samples, int pixels, int width, Precision precision) {
  CoplanarOptions options;
  options.geometry = {pixels, pixels, 1e-6, {}};
  options.nu = options.nv = fast_fft_size(2 * pixels);
  options.kernel_u = options.kernel_v = kernels::kernel_family("least-misfit").make(width, 0.25);
  options.precision = precision;
  const auto transform = make_coplanar_transform(options);
  const VisibilityBlock block = random_block(samples, options.geometry.cell_rad);
  const int degree = options.kernel_u.polynomial.degree();
  Trial trial{{double(samples), width, degree, options.nu, options.nv, pixels, precision}, HUGE_VAL};
  for (int repeat = 0; repeat < 3; ++repeat) {
    const Stopwatch watch;
    const auto sum = transform->adjoint({.with_psf = true});
    sum->add(block);
    sum->finish();
    trial.seconds = std::min(trial.seconds, watch.seconds());
  }
  return trial;
}

/// Cells and taps of a sample, in units of the cost of a cell.
double cells_of(const GriddingWork& work, double tap_over_cell) {
  const double grids = 2 * work.stokes + (!work.psf ? 0 : work.has_w_axis() ? 2 : 1);  // the PSF's is real but for a w axis
  const double planes = grids / 3 * (work.has_w_axis() ? wide_cell * work.width_w : 1);
  return work.width * padded(work) * planes + tap_over_cell * 2 * padded(work) * (work.degree + 1);
}

/// Over single precision.
double precision_cost(const GriddingWork& work, const CostModel& model) {
  if (work.precision == Precision::single_precision) return 1;
  return work.has_w_axis() ? wide_double_cost : model.double_cost;
}

}  // namespace

double CostModel::gridding_seconds(const GriddingWork& work) const {
  const double per_sample = sample_ns * (work.has_w_axis() ? wide_sample : 1) + cell_ns * cells_of(work, tap_ns / cell_ns);
  return 1e-9 * work.samples * work.facets * per_sample * precision_cost(work, *this);
}

double CostModel::fft_seconds(const GriddingWork& work) const {
  const double per_point = fft_ns * (work.has_w_axis() ? wide_point : 1);
  return 1e-9 * work.gathers * fft_points(work) * per_point * precision_cost(work, *this);
}

double operation_count(const GriddingWork& work) {
  const double points = static_cast<double>(work.nu) * work.nv;
  const double cells = static_cast<double>(work.width) * work.width * std::max(1, work.width_w);
  return work.samples * work.facets * cells + work.planes * points * std::log2(points);
}

CostModel measure_costs() {
  constexpr int samples = 200000;
  constexpr int few = 1000;
  const Precision single = Precision::single_precision;
  const Trial fft = time_of(few, 1024, 4, single);
  const Trial narrow = time_of(samples, 128, 4, single);
  const Trial wide = time_of(samples, 128, 9, single);
  const Trial precise = time_of(samples, 128, 9, Precision::double_precision);
  CostModel model;
  const double tap_over_cell = model.tap_ns / model.cell_ns;
  const double more_cells = cells_of(wide.work, tap_over_cell) - cells_of(narrow.work, tap_over_cell);
  model.fft_ns = 1e9 * fft.seconds / fft_points(fft.work);
  model.cell_ns = std::max(0.01, 1e9 * (wide.seconds - narrow.seconds) / samples / more_cells);
  model.tap_ns = tap_over_cell * model.cell_ns;
  model.sample_ns = std::max(1.0, 1e9 * narrow.seconds / samples - model.cell_ns * cells_of(narrow.work, tap_over_cell));
  model.double_cost = std::max(1.0, precise.seconds / wide.seconds);
  return model;
}

}  // namespace misfit::imager
