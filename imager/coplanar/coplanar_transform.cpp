#include "imager/coplanar/coplanar_transform.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "imager/coplanar/coplanar_adjoint.h"
#include "imager/coplanar/coplanar_prediction.h"
#include "imager/coplanar/crowded_tiles.h"
#include "imager/coplanar/shared_transform.h"
#include "imager/transform/unit_source.h"

namespace misfit::imager {
namespace {

constexpr int tile_side = 32;  // with 16, half of the cells that a tile of W = 7 flushes lie beyond it

GridShape shape_of(const CoplanarOptions& o) {
  return {o.nu, o.nv, o.kernel_u.width(), tile_side};
}

template <typename Real>
CoplanarSetup<Real> setup_of(const CoplanarOptions& o) {
  return {o.geometry,
          shape_of(o),
          TapTable<Real>(o.kernel_u.polynomial, o.lookup),
          TapTable<Real>(o.kernel_v.polynomial, o.lookup),
          {axis_correction(o.kernel_u, o.geometry.width, o.nu), axis_correction(o.kernel_v, o.geometry.height, o.nv)},
          o.threads};
}

template <typename Real>
class CoplanarTransform : public Transform {
 public:
  explicit CoplanarTransform(const CoplanarOptions& o) : setup_(setup_of<Real>(o)) {}

  std::unique_ptr<AdjointSum> adjoint(const AdjointOptions& options) const override {
    return make_coplanar_adjoint<Real>(setup_, options);
  }
  std::unique_ptr<Prediction> predict(Image model) const override { return make_coplanar_prediction<Real>(setup_, model); }
  std::vector<std::complex<double>> psf_source(const SampleCoordinates& at) const override {
    const DirectionCosines middle = setup_.geometry.centre;
    return unit_source(at, {middle.l, middle.m, 0}, setup_.threads);
  }

 private:
  CoplanarSetup<Real> setup_;
};

template <typename Real>
class CoplanarSharedTransform : public SharedTransform {
 public:
  explicit CoplanarSharedTransform(const CoplanarOptions& o) : setup_(setup_of<Real>(o)) {}

  std::unique_ptr<SharedAdjoint> adjoint(std::size_t sets, std::size_t images) const override {
    check(sets * images);
    return make_shared_adjoint<Real>(setup_, sets, images);
  }
  std::unique_ptr<SharedPrediction> predict(const std::vector<Image>& images) const override {
    check(images.size());
    return make_shared_prediction<Real>(setup_, images);
  }

 private:
  static void check(std::size_t images) {
    if (images == 0 || images > most_shared_images)
      throw std::invalid_argument(std::to_string(images) + " images that share samples; expected 1 to " +
                                  std::to_string(most_shared_images));
  }

  CoplanarSetup<Real> setup_;
};

void check_axis(const char* axis, int pixels, int fft_size, const kernels::Kernel& kernel) {
  if (fft_size % 2 != 0 || fft_size < pixels || fft_size < 4 * kernel.width())
    throw std::invalid_argument("FFT length " + std::to_string(fft_size) + " along " + axis +
                                " is not even, below the image's " + std::to_string(pixels) +
                                " pixels, or below 4 kernel widths");
  const double x0 = static_cast<double>(pixels / 2) / fft_size;
  if (kernel.x0 < x0 - 1e-12)
    throw std::invalid_argument("kernel made for x0 = " + std::to_string(kernel.x0) + " along " + axis +
                                ", but the image reaches " + std::to_string(x0));
}

void check(const CoplanarOptions& options) {
  check_axis("u", options.geometry.width, options.nu, options.kernel_u);
  check_axis("v", options.geometry.height, options.nv, options.kernel_v);
  if (options.kernel_u.width() != options.kernel_v.width())
    throw std::invalid_argument("kernels of widths " + std::to_string(options.kernel_u.width()) + " along u and " +
                                std::to_string(options.kernel_v.width()) + " along v; one width is expected");
}

}  // namespace

std::unique_ptr<Transform> make_coplanar_transform(const CoplanarOptions& options) {
  check(options);
  if (options.precision == Precision::single_precision) return std::make_unique<CoplanarTransform<float>>(options);
  return std::make_unique<CoplanarTransform<double>>(options);
}

std::unique_ptr<SharedTransform> make_shared_transform(const CoplanarOptions& options) {
  check(options);
  if (options.precision == Precision::single_precision) return std::make_unique<CoplanarSharedTransform<float>>(options);
  return std::make_unique<CoplanarSharedTransform<double>>(options);
}

double longest_plane_sum(Precision precision, double samples) {
  const bool single = precision == Precision::single_precision;
  const double in_grid = single ? std::min<double>(samples, most_in_single) : samples;
  return std::min<double>(samples, most_in_registers + most_in_tile_buffer / most_in_registers + in_grid / most_in_tile_buffer);
}

TransformMemory memory_of(const CoplanarOptions& o, int stokes, double samples) {
  const bool single = o.precision == Precision::single_precision;
  const double real_bytes = single ? sizeof(float) : sizeof(double);
  const GridShape shape = shape_of(o);
  const double tiles = static_cast<double>(shape.tiles_u()) * static_cast<double>(shape.tiles_v());
  const double crowded = single ? std::min(tiles, samples / most_in_single) : 0;
  const double side = shape.tile + padded_taps<float>(shape.width);
  const double plane = static_cast<double>(shape.cells()) * real_bytes + crowded * side * side * sizeof(double);
  return {2 * plane, plane, transform_buffer_bytes(shape, o.threads, real_bytes), 2 * plane * (stokes - 1), 0};
}

}  // namespace misfit::imager
