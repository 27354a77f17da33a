#include "imager/arrays/array_transform.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "imager/data/image_statistics.h"
#include "imager/numerics/parallel.h"
#include "imager/plan/plan_text_internal.h"
#include "imager/plan/planned_transform.h"

namespace misfit::imager {
namespace {

/// The image for a block whose (u, v) are the array's (v, −u): rows along x, columns along −l = y.
ImageGeometry geometry_of(const ArrayImage& image) {
  constexpr int most = 65536;
  for (const int pixels : {image.pixels_x, image.pixels_y})
    if (pixels < 1 || pixels > most)
      throw std::invalid_argument("an image of " + std::to_string(image.pixels_x) + " x " + std::to_string(image.pixels_y) +
                                  " pixels, expected 1 to " + std::to_string(most) + " along each axis");
  for (const auto& [name, size] : {std::pair("pixsize_x ", image.pixel_x_rad), std::pair("pixsize_y ", image.pixel_y_rad)})
    if (!(size > 0 && std::isfinite(size))) throw std::invalid_argument(name + text("%g", size) + " rad, expected more than 0");
  if (!std::isfinite(image.centre_x) || !std::isfinite(image.centre_y))
    throw std::invalid_argument("center_x, center_y " + text("%g", image.centre_x) + ", " + text("%g", image.centre_y) +
                                ", expected direction cosines");
  ImageGeometry geometry;
  geometry.width = image.pixels_y;
  geometry.height = image.pixels_x;
  geometry.cell_rad = image.pixel_y_rad;
  geometry.pixel_aspect = image.pixel_x_rad / image.pixel_y_rad;
  geometry.centre = {-image.centre_y, image.centre_x};
  return geometry;
}

/// The factor, a power of 2, by which an image without w is made so small that it does not reach the horizon, which does not
/// exist without w.
double shrinking(const ImageGeometry& geometry) {
  double reach = 0;
  for (const DirectionCosines corner : geometry.corners()) reach = std::max({reach, std::abs(corner.l), std::abs(corner.m)});
  return reach < 0.5 ? 1 : std::ldexp(1.0, std::ilogb(reach) + 2);
}

int threads_of(const ArrayTransformOptions& options) {
  return options.threads > 0 ? options.threads : available_threads();
}

/// Throws where double precision does not hold the phases of u and v of the farthest samples at the farthest pixels.
void check_phases(const ImageGeometry& geometry, const UvwReach& reach, const ArrayTransformOptions& options) {
  double turns = 0;
  const double scale = options.image.pixel_y_rad / geometry.cell_rad;
  for (const DirectionCosines corner : geometry.corners())
    turns = std::max(turns, scale * (reach.max_abs_u * std::abs(corner.m) + reach.max_abs_v * std::abs(corner.l)));
  if (!(phase_rounding(turns) <= options.accuracy))
    throw std::invalid_argument("epsilon " + text("%g", options.accuracy) +
                                " is out of reach of double precision: phases of u and v reach " + text("%.2g", turns) +
                                " turns; expected " + text("%.2g", phase_rounding(turns)) + " or more");
}

/// True if every pixel lies beyond the horizon: then the nearest point of the image's rectangle does.
bool wholly_beyond_horizon(const ImageGeometry& geometry) {
  const auto nearest = [](double a, double b) { return a * b <= 0 ? 0 : std::min(std::abs(a), std::abs(b)); };
  const double l = nearest(geometry.l(0), geometry.l(geometry.width - 1));
  const double m = nearest(geometry.m(0), geometry.m(geometry.height - 1));
  return beyond_horizon({l, m});
}

/// The request whose plan serves both ways.
GriddingRequest request_of(const ArrayTransformOptions& options, const ArrayCoordinates& at) {
  check_coordinates(at);
  if (!(options.accuracy > 0 && options.accuracy < 1))
    throw std::invalid_argument("epsilon " + text("%g", options.accuracy) + ", expected it above 0 and below 1");
  const double needed = 0.5 / options.kernel.max_x0;
  if (options.most_padding < needed * (1 - 1e-3))
    throw std::invalid_argument("sigma_max " + text("%g", options.most_padding) + " is less than " + text("%.4g", needed) +
                                ", which kernel " + options.kernel.name + " needs");
  GriddingRequest request;
  request.geometry = geometry_of(options.image);
  if (at.w_sign == 0) {
    const double shrink = shrinking(request.geometry);
    request.geometry.cell_rad /= shrink;
    request.geometry.centre = {request.geometry.centre.l / shrink, request.geometry.centre.m / shrink};
  }
  request.accuracy = options.accuracy;
  request.kernel = options.kernel;
  request.kernel_width = options.kernel_width;
  request.least_padding = options.least_padding;
  request.most_padding = options.most_padding;
  request.samples = at.samples();
  request.threads = threads_of(options);
  const UvwReach reach = reach_of(at, request.threads);
  request.max_abs_w = reach.max_abs_w;
  check_phases(request.geometry, reach, options);
  request.precision = options.precision;
  return request;
}

/// The transform that the plan has for images, which serves models of any number of pixels.
std::unique_ptr<Transform> transform_of(const GriddingPlan& plan) {
  if (plan.direct) return std::make_unique<DirectTransform>(plan.options.geometry, plan.options.threads);
  return make_transform(plan.options);
}

double expected_error_of(const GriddingPlan& plan, const SampleSums& sums, const Image& image) {
  const double rms = statistics_of(image).root_mean_square();
  const double random = std::sqrt(0.5 * sums.weight2_square);
  return rms == 0 ? (random == 0 ? 0 : HUGE_VAL) : plan.expected_error * std::max(1.0, random / rms);
}

/// Blocks that are predicted together, and their rows.
struct Gathered {
  std::vector<VisibilityBlock> block;
  std::vector<RowsOfArray> rows;
  std::size_t samples = 0;
};

/// False where a product is not finite.
template <typename Real>
bool write(const std::vector<std::complex<double>>& predicted, RowsOfArray rows, const Strided<const Real>& weight,
           const Strided<std::complex<Real>>& into, int threads) {
  const std::size_t channels = into.columns;
  std::atomic<bool> finite = true;
  for_rows(rows, threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t row = begin; row < end; ++row)
      for (std::size_t channel = 0; channel < channels; ++channel) {
        const std::complex<double> v = predicted[(row - rows.begin) * channels + channel];
        const bool weighed = weight && v != 0.0;  // those that the mask leaves out stay 0 whatever their weight is
        const std::complex<double> product = weighed ? double{weight.at(row, channel)} * v : v;
        if (!std::isfinite(product.real()) || !std::isfinite(product.imag())) finite = false;
        into.at(row, channel) = std::complex<Real>(product);
      }
  });
  return finite;
}

}  // namespace

GriddingPlan plan_of(const ArrayTransformOptions& options, const ArrayCoordinates& at, bool with_psf) {
  GriddingRequest request = request_of(options, at);
  request.psf = with_psf;
  return plan_gridding(request);
}

Plan decisions_of(const GriddingPlan& plan) {
  Plan decisions;
  for (const Decision& d : plan.decisions)
    if (d.item != "prediction") decisions.push_back(d);
  return decisions;
}

ArrayTransform::ArrayTransform(const ArrayTransformOptions& options, const ArrayCoordinates& at) : options_(options), at_(at) {
  const ImageGeometry geometry = geometry_of(options.image);
  nothing_seen_ = at.w_sign != 0 && wholly_beyond_horizon(geometry);
  if (nothing_seen_) {
    check_coordinates(at);
    plan_.options.geometry = geometry;
    plan_.options.threads = threads_of(options);
  } else {
    plan_ = plan_of(options, at);
    transform_ = transform_of(plan_);
  }
  blocks_.threads = plan_.options.threads;
  blocks_.uv_factor = options.image.pixel_y_rad / plan_.options.geometry.cell_rad;
}

double ArrayTransform::n_at(int row, int column) const {
  if (at_.w_sign == 0) return 1;
  return 1 + n_minus_1(plan_.options.geometry.at(row, column));
}

template <typename Real>
ArrayAdjoint ArrayTransform::adjoint(const ArrayValues<Real>& values) const {
  check_values(at_, values);
  if (nothing_seen_) return {Image(options_.image.pixels_y, options_.image.pixels_x), 0};
  const auto sum = transform_->adjoint({1, false, true});
  for (const RowsOfArray& rows : pieces_of(at_)) {
    VisibilityBlock block = block_of(at_, rows, blocks_);
    const ValuesOfBlock<Real> of_block = values_of(values, rows, block, blocks_.threads);
    sum->add(block, VisibilitySet(of_block.visibility));
  }
  AdjointResult result = sum->finish();
  const SampleSums& sums = result.sums.front();
  if (!std::isfinite(sums.weight_abs))
    throw std::invalid_argument(
        "vis or wgt is not finite somewhere, or too large to be squared; expected finite values wherever the mask is not 0");
  ArrayAdjoint adjoint;
  adjoint.image = std::move(result.images.front());
  adjoint.expected_error = expected_error_of(plan_, sums, adjoint.image);
  parallel_for(static_cast<std::size_t>(adjoint.image.height), blocks_.threads, [&](std::size_t r) {
    const int row = static_cast<int>(r);
    double* const pixel = adjoint.image.row(row);
    for (int column = 0; column < adjoint.image.width; ++column) {
      const double n = n_at(row, column);
      if (options_.divide_by_n && at_.w_sign != 0) pixel[column] /= n;
      if (!(n > 0)) pixel[column] = 0;
    }
  });
  return adjoint;
}

template <typename Real>
Image ArrayTransform::model_of(const Strided<const Real>& model) const {
  const ImageGeometry& geometry = plan_.options.geometry;
  if (model.rows != static_cast<std::size_t>(geometry.height) || model.columns != static_cast<std::size_t>(geometry.width))
    throw std::invalid_argument("a model of " + std::to_string(model.rows) + " x " + std::to_string(model.columns) +
                                " pixels, expected " + std::to_string(geometry.height) + " x " +
                                std::to_string(geometry.width));
  Image image(geometry.width, geometry.height);
  std::atomic<bool> is_finite = true;
  parallel_for(model.rows, blocks_.threads, [&](std::size_t r) {
    const int row = static_cast<int>(r);
    for (int column = 0; column < geometry.width; ++column) {
      const double n = n_at(row, column);
      if (!(n > 0)) continue;
      const double pixel = model.at(r, static_cast<std::size_t>(column));
      if (!std::isfinite(pixel)) is_finite = false;
      image.at(row, column) = options_.divide_by_n && at_.w_sign != 0 ? pixel / n : pixel;
    }
  });
  if (!is_finite) throw std::invalid_argument("dirty is not finite somewhere; expected finite pixels above the horizon");
  return image;
}

template <typename Real>
void ArrayTransform::predict(const Strided<const Real>& model, const Strided<const Real>& weight,
                             const Strided<std::complex<Real>>& into) const {
  check_values(at_, ArrayValues<Real>{{into.data, into.rows, into.columns, into.row_step, into.column_step}, weight});
  const std::unique_ptr<Prediction> prediction = nothing_seen_ ? nullptr : transform_->predict(model_of(model));
  if (!prediction) {
    for (std::size_t row = 0; row < into.rows; ++row)
      for (std::size_t channel = 0; channel < into.columns; ++channel) into.at(row, channel) = 0;
    return;
  }
  Gathered gathered;
  const auto flush = [&] {
    std::vector<const VisibilityBlock*> blocks;
    for (const VisibilityBlock& block : gathered.block) blocks.push_back(&block);
    const auto predicted = prediction->at_usable_of(blocks);
    for (std::size_t i = 0; i < predicted.size(); ++i)
      if (!write(predicted[i], gathered.rows[i], weight, into, blocks_.threads))
        throw std::invalid_argument(
            "wgt is not finite somewhere, or too large; expected finite values wherever the mask is not 0");
    gathered = {};
  };
  for (const RowsOfArray& rows : pieces_of(at_)) {
    gathered.block.push_back(block_of(at_, rows, blocks_));
    gathered.rows.push_back(rows);
    gathered.samples += gathered.block.back().samples();
    if (gathered.samples >= prediction->samples_at_once()) flush();
  }
  if (!gathered.block.empty()) flush();
}

template ArrayAdjoint ArrayTransform::adjoint(const ArrayValues<float>&) const;
template ArrayAdjoint ArrayTransform::adjoint(const ArrayValues<double>&) const;
template void ArrayTransform::predict(const Strided<const float>&, const Strided<const float>&,
                                      const Strided<std::complex<float>>&) const;
template void ArrayTransform::predict(const Strided<const double>&, const Strided<const double>&,
                                      const Strided<std::complex<double>>&) const;

}  // namespace misfit::imager
