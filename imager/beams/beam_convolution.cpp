#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <vector>

#include "imager/beams/beam.h"
#include "imager/numerics/parallel.h"

namespace misfit::imager {
namespace {

constexpr double stamp_cutoff = 1e-8;

/// The beam about its peak, in pixels; 0 below the cutoff.
struct Stamp {
  Image image;
  int row_reach = 0;
  int column_reach = 0;
};

Stamp make_stamp(const Beam& beam, double cell_rad, const Image& model) {
  const double east = std::sin(beam.position_angle_rad), north = std::cos(beam.position_angle_rad);
  const Eigen::Matrix2d axes{{-east, north}, {north, east}};  // rows: column and row; columns: major and minor axis
  const double sigma_per_fwhm = 1 / (std::sqrt(8 * std::log(2.0)) * cell_rad);
  const Eigen::Vector2d variance = (sigma_per_fwhm * Eigen::Vector2d(beam.major_rad, beam.minor_rad)).array().square();
  const Eigen::Matrix2d covariance = axes * variance.asDiagonal() * axes.transpose();
  const Eigen::Matrix2d precision = axes * variance.cwiseInverse().asDiagonal() * axes.transpose();
  const double radius = std::sqrt(-2 * std::log(stamp_cutoff));  // in standard deviations

  Stamp stamp;
  stamp.column_reach = static_cast<int>(std::min(radius * std::sqrt(covariance(0, 0)), double(model.width)));
  stamp.row_reach = static_cast<int>(std::min(radius * std::sqrt(covariance(1, 1)), double(model.height)));
  stamp.image = Image(2 * stamp.column_reach + 1, 2 * stamp.row_reach + 1);
  for (int r = 0; r < stamp.image.height; ++r)
    for (int c = 0; c < stamp.image.width; ++c) {
      const Eigen::Vector2d x(c - stamp.column_reach, r - stamp.row_reach);
      const double value = std::exp(-0.5 * x.dot(precision * x));
      if (value >= stamp_cutoff) stamp.image.at(r, c) = value;
    }
  return stamp;
}

struct RowComponent {
  int column = 0;
  double flux_jy = 0;
};

using ComponentRows = std::vector<std::vector<RowComponent>>;

ComponentRows component_rows(const Image& model) {
  ComponentRows rows(static_cast<std::size_t>(model.height));
  for (int r = 0; r < model.height; ++r)
    for (int c = 0; c < model.width; ++c)
      if (model.at(r, c) != 0 && !std::isnan(model.at(r, c))) rows[static_cast<std::size_t>(r)].push_back({c, model.at(r, c)});
  return rows;
}

/// Every pixel sums its components in the order of the image, whichever thread does it.
void convolve_row(const ComponentRows& components, const Stamp& stamp, int r, Image& out) {
  const int first = std::max(0, r - stamp.row_reach), last = std::min(out.height - 1, r + stamp.row_reach);
  for (int source = first; source <= last; ++source) {
    const double* beam = stamp.image.row(r - source + stamp.row_reach);
    for (const auto& [column, flux_jy] : components[static_cast<std::size_t>(source)]) {
      const int begin = std::max(0, column - stamp.column_reach), end = std::min(out.width, column + stamp.column_reach + 1);
      double* sum = out.row(r);
      for (int c = begin; c < end; ++c) sum[c] += flux_jy * beam[c - column + stamp.column_reach];
    }
  }
}

}  // namespace

Image convolve_with_beam(const Image& model, const Beam& beam, double cell_rad, int threads) {
  if (!(beam.major_rad > 0 && beam.minor_rad > 0 && cell_rad > 0))
    throw std::invalid_argument("beam of " + std::to_string(beam.major_rad) + " by " + std::to_string(beam.minor_rad) +
                                " rad on a cell of " + std::to_string(cell_rad) + " rad; expected all to be positive");
  const Stamp stamp = make_stamp(beam, cell_rad, model);
  const ComponentRows components = component_rows(model);
  Image out(model.width, model.height);
  parallel_for(static_cast<std::size_t>(out.height), threads,
               [&](std::size_t r) { convolve_row(components, stamp, static_cast<int>(r), out); });
  return out;
}

Image restored(const CleanedPlane& plane, const Beam& beam, double cell_rad, int threads) {
  const Image &model = plane.model, &residual = plane.residual;
  if (model.width != residual.width || model.height != residual.height)
    throw std::invalid_argument("a residual of " + std::to_string(residual.width) + " × " + std::to_string(residual.height) +
                                " pixels; expected the model's " + std::to_string(model.width) + " × " +
                                std::to_string(model.height));
  Image sum = convolve_with_beam(model, beam, cell_rad, threads);
  for (std::size_t i = 0; i < sum.pixel.size(); ++i) sum.pixel[i] += residual.pixel[i];
  return sum;
}

}  // namespace misfit::imager
