#include "imager/clean/finite_images.h"

#include <cmath>
#include <stdexcept>
#include <string>

#include "imager/data/noise.h"

namespace misfit::imager {
namespace {

[[noreturn]] void refuse(const std::string& what, double value) {
  throw std::runtime_error(what + " is " + std::to_string(value) +
                           "; expected a finite number: visibilities, weights or the model have values too large to be added");
}

}  // namespace

void require_finite_psf(const Image& psf) {
  const double peak = find_peak(psf).value, middle = psf.at(psf.height / 2, psf.width / 2);
  if (!std::isfinite(middle)) refuse("the PSF's middle pixel", middle);
  if (!std::isfinite(peak)) refuse("the PSF's largest pixel", peak);
}

void require_finite_residual(const ImageStatistics& residual, const ImageStatistics& dirty) {
  const double peak = residual.count == 0 ? NAN : residual.largest_magnitude();
  if (!std::isfinite(peak)) refuse("the residual image's peak in Jy/beam", peak);
  if (residual.count < dirty.count) refuse("a pixel of the residual image", NAN);
}

}  // namespace misfit::imager
