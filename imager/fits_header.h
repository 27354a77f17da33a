#pragma once

#include <string>

#include "imager/fits_file.h"

namespace misfit::imager {

/// What a FITS header says of an axis.
struct FitsAxis {
  std::string type;
  std::string unit;
  double reference_pixel = 1;
  double reference_value = 0;
  double increment = 1;
};

/// Writes all that `sky` holds beside its pixels and Stokes parameter, which the axis `stokes` tells.
void write_header(FitsFile& file, const SkyImage& sky, const FitsAxis& stokes);

/// `plane` with what the header says, but for its Stokes parameter. Throws std::runtime_error where it has another projection
/// than SIN, or pixels that are not square.
SkyImage with_header(const FitsFile& file, Image plane);

}  // namespace misfit::imager
