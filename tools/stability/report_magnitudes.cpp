#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <random>
#include <string>

#include "imager/coplanar/coplanar_transform.h"
#include "imager/direct/direct_transform.h"
#include "imager/numerics/constants.h"
#include "kernels/catalogue.h"
#include "tools/base/numbers.h"
#include "tools/stability/stability_report.h"

namespace misfit::tools {
namespace {

constexpr int magnitude_pixels = 48;
constexpr double pixel_rad = 1e-6;
constexpr int wide_kernel = 12;
constexpr int magnitude_samples = 1000;

imager::ImageGeometry geometry() {
  return {magnitude_pixels, magnitude_pixels, pixel_rad, {}};
}

std::unique_ptr<imager::Transform> plane(imager::Precision precision) {
  const kernels::Kernel kernel = kernels::kernel_family("least-misfit").make(wide_kernel, 0.25);
  return imager::make_coplanar_transform(
      {geometry(), 2 * magnitude_pixels, 2 * magnitude_pixels, kernel, kernel, precision, 1});
}

/// Random visibilities, |u| and |v| up to `reach` times 1/(2 cell).
imager::VisibilityBlock random_block(double reach) {
  std::mt19937_64 random(1);
  std::normal_distribution<float> normal;
  std::uniform_real_distribution<double> uniform(-reach, reach);
  imager::VisibilityBlock block;
  block.frequency_hz = {imager::speed_of_light_m_s};  // so that metres are wavelengths
  for (int i = 0; i < magnitude_samples; ++i) {
    for (int axis = 0; axis < 2; ++axis) block.uvw_m.edit().push_back(uniform(random) / (2 * pixel_rad));
    block.uvw_m.edit().push_back(0);
    block.visibility.emplace_back(normal(random), normal(random));
    block.weight.push_back(1);
  }
  return block;
}

/// ‖is − should‖ / ‖should‖ without overflow; NaN where something is not finite.
template <typename T>
double relative_error(const std::vector<T>& is, const std::vector<T>& should) {
  double largest = 0;
  for (const T& value : should) largest = std::max(largest, std::abs(value));
  double difference = 0;
  double norm = 0;
  for (std::size_t i = 0; i < is.size(); ++i) {
    difference += std::norm(is[i] / largest - should[i] / largest);
    norm += std::norm(should[i] / largest);
  }
  const double error = std::sqrt(difference / norm);
  return std::isfinite(error) ? error : std::numeric_limits<double>::quiet_NaN();
}

std::vector<double> image_of(const imager::Transform& transform, const imager::VisibilityBlock& block, double scale) {
  std::vector<std::complex<double>> visibility(block.visibility.begin(), block.visibility.end());
  for (std::complex<double>& v : visibility) v *= scale;
  const auto sum = transform.adjoint({});
  sum->add(block, visibility);
  return sum->finish().images.front().pixel;
}

double prediction_error(const imager::Transform& gridded, const imager::Transform& direct, double cells) {
  std::mt19937_64 random(2);
  std::normal_distribution<double> normal;
  imager::Image model(magnitude_pixels, magnitude_pixels);
  for (double& pixel : model.pixel) pixel = normal(random);
  const imager::VisibilityBlock block = random_block(cells / magnitude_pixels);  // 2·pixels cells of the grid span 1/cell
  return relative_error(gridded.predict(model)->at(block), direct.predict(model)->at(block));
}

DataTable scaled_visibilities(const imager::Transform& twice, const imager::Transform& single,
                              const imager::Transform& direct) {
  DataTable table{.name = "magnitudes",
                  .title = "Images of visibilities of every size",
                  .caption =
                      "‖gridded − direct sum‖ / ‖direct sum‖ over the whole image; empty where a value is not finite. Below "
                      "2.2 × 10⁻³⁰⁸ doubles are denormal and hold fewer digits, those of the visibilities too.",
                  .columns = {"size of the visibilities", "gridded in double", "gridded in single"},
                  .rows = {}};
  const imager::VisibilityBlock block = random_block(0.99);
  for (const double scale : {1e-320, 1e-310, 1e-300, 1e-100, 1e-40, 1e-30, 1e-10, 1.0, 1e10, 1e30, 1e40, 1e100, 1e300, 1e305}) {
    const std::vector<double> exact = image_of(direct, block, scale);
    table.rows.push_back({power_of_ten(scale, 2), relative_error(image_of(twice, block, scale), exact),
                          relative_error(image_of(single, block, scale), exact)});
  }
  return table;
}

DataTable far_predictions(const imager::Transform& twice, const imager::Transform& direct) {
  DataTable table{.name = "far-predictions",
                  .title = "Visibilities predicted far from the origin",
                  .caption =
                      "‖gridded − direct sum‖ / ‖direct sum‖ for random pixels; the model is periodic in u and v. The "
                      "direct sum rounds its phases too.",
                  .columns = {"coordinates to, cells of the grid", "in double"},
                  .rows = {}};
  for (const double cells : {48.0, 1e3, 1e6, 1e9})
    table.rows.push_back({power_of_ten(cells, 2), prediction_error(twice, direct, cells)});
  return table;
}

}  // namespace

ReportSection magnitudes_section() {
  const auto twice = plane(imager::Precision::double_precision);
  const auto single = plane(imager::Precision::single_precision);
  const imager::DirectTransform direct(geometry(), 1);
  return {.heading = "Denormal and huge values",
          .paragraphs = {"Real gridding against the direct sum, W = 12, x₀ = 0.25, " + std::to_string(magnitude_samples) +
                         " random visibilities, an image of " + std::to_string(magnitude_pixels) +
                         "² pixels. Gridding is linear, so that "
                         "only the range of the numbers counts: that of floats is 10⁻³⁸ to 10³⁸, and grids of floats lose what "
                         "lies outside."},
          .figures = {},
          .tables = {scaled_visibilities(*twice, *single, direct), far_predictions(*twice, direct)}};
}

}  // namespace misfit::tools
