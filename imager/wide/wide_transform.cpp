#include "imager/wide/wide_transform.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include "imager/transform/unit_source.h"
#include "imager/wide/facet.h"
#include "imager/wide/tile_sum.h"
#include "imager/wide/wide_adjoint.h"
#include "imager/wide/wide_prediction.h"

namespace misfit::imager {
namespace {

template <typename Real>
class WideTransform : public Transform {
 public:
  explicit WideTransform(const WideTransformOptions& options) : setup_(wide_setup<Real>(options)) {}

  std::unique_ptr<AdjointSum> adjoint(const AdjointOptions& options) const override {
    return make_wide_adjoint<Real>(setup_, options);
  }
  std::unique_ptr<Prediction> predict(Image model) const override {
    return make_wide_prediction<Real>(setup_, std::move(model));
  }
  std::vector<std::complex<double>> psf_source(const SampleCoordinates& at) const override {
    return unit_source(at, phase_position(setup_.options.geometry.centre), setup_.options.threads);
  }

 private:
  WideSetup<Real> setup_;
};

void check_axis(const char* axis, int pixels, int fft_size, const kernels::Kernel& kernel) {
  if (fft_size < pixels || fft_size < 4 * kernel.width())
    throw std::invalid_argument("FFT length " + std::to_string(fft_size) + " along " + axis + " is below the facets' " +
                                std::to_string(pixels) + " pixels, or below 4 kernel widths");
  const double x0 = static_cast<double>(pixels / 2) / fft_size;
  if (kernel.x0 < x0 - 1e-12)
    throw std::invalid_argument("kernel made for x0 = " + std::to_string(kernel.x0) + " along " + axis +
                                ", but the facets reach " + std::to_string(x0));
}

}  // namespace

std::unique_ptr<Transform> make_wide_transform(const WideTransformOptions& o) {
  if (o.facets_l < 1 || o.facets_m < 1 || o.facets_l > o.geometry.width || o.facets_m > o.geometry.height)
    throw std::invalid_argument(std::to_string(o.facets_l) + " × " + std::to_string(o.facets_m) + " facets of an image of " +
                                std::to_string(o.geometry.width) + " × " + std::to_string(o.geometry.height) + " pixels");
  check_axis("u", largest_facet(o.geometry.width, o.facets_l), o.nu, o.kernel_u);
  check_axis("v", largest_facet(o.geometry.height, o.facets_m), o.nv, o.kernel_v);
  if (o.kernel_u.width() != o.kernel_v.width())
    throw std::invalid_argument("kernels of widths " + std::to_string(o.kernel_u.width()) + " along u and " +
                                std::to_string(o.kernel_v.width()) + " along v; one width is expected");
  if (o.precision == Precision::single_precision) return std::make_unique<WideTransform<float>>(o);
  return std::make_unique<WideTransform<double>>(o);
}

TransformMemory memory_of(const WideTransformOptions& o, const WideDemand& demand) {
  const double complex_bytes =
      o.precision == Precision::single_precision ? sizeof(std::complex<float>) : sizeof(std::complex<double>);
  const double at_once = std::min(demand.samples, static_cast<double>(o.samples_at_once));
  const double image = static_cast<double>(o.geometry.pixels()) * sizeof(double);
  // Where fewer pairs of planes fit, more grids may take less memory; what they are told to take grows with their number.
  const auto stack = [&](int grids) {
    double bytes = 0;
    for (int g = 1; g <= grids; ++g) bytes = std::max(bytes, bytes_of_pairs(o, std::min(demand.planes, most_pairs(o, g)), g));
    return bytes;
  };
  const int others = demand.stokes - 1;
  const double column = 6.0 * largest_facet(o.geometry.height, o.facets_m) * sizeof(double) + o.nv * complex_bytes;
  return {at_once * wide_bytes_a_sample + stack(1) + image, stack(demand.stokes + 1) - stack(demand.stokes) + image,
          o.threads * 16 * column, stack(demand.stokes) - stack(1) + others * (image + at_once * wide_bytes_a_value), at_once};
}

double longest_sum(const WideTransformOptions& options, double samples) {
  if (!options.has_w_axis()) return longest_plane_sum(options.precision, samples);
  return std::min(samples, most_in_buffer + samples / most_in_buffer);
}

std::unique_ptr<Transform> make_transform(const WideTransformOptions& options) {
  return options.has_w_axis() ? make_wide_transform(options) : make_coplanar_transform(options);
}

}  // namespace misfit::imager
