#include "tools/formats/image_file.h"

#include <cmath>
#include <filesystem>
#include <limits>
#include <stdexcept>
#include <system_error>

#include "imager/files/fits_image_reader.h"
#include "tools/base/numbers.h"

namespace misfit::tools {
namespace {

std::string described(const imager::SpectralAxis& axis) {
  const std::string first = significant(axis.reference_hz, 9) + " Hz", frame = axis.frame.empty() ? "" : " in " + axis.frame;
  if (axis.channels == 1) return "plane of " + significant(axis.width_hz(), 6) + " Hz at " + first + frame;
  return std::to_string(axis.channels) + " planes, " + significant(axis.increment_hz, 6) + " Hz apart" +
         (axis.in_wavelength ? " at first, evenly in wavelength," : ",") + " from " + first + " on" + frame;
}

/// True if two axes have the same planes. A file whose frame is not known may be in any; an image without a frame, whose
/// frequencies are the data's, is in no frame that a file names.
bool same_planes(const imager::SpectralAxis& a, const imager::SpectralAxis& b) {
  const auto near = [&](int plane) { return std::abs(b.plane_of(a.frequency_hz(plane)) - plane) < 0.1; };
  const bool frames = a.frame.empty() || a.frame == b.frame;
  return frames && a.channels == b.channels && near(0) && near(a.channels / 2) && near(a.channels - 1);
}

}  // namespace

std::unique_ptr<imager::ImageReader> open_image_file(const std::string& path, imager::Grids grids, ms_io::Masks masks) {
  std::error_code absent;
  return std::filesystem::is_directory(path, absent) ? ms_io::open_casa_image(path, grids, masks)
                                                     : imager::open_fits_image(path, grids);
}

int channel_for(const imager::ImageReader& file, const std::string& path, const imager::SpectralAxis& axis, int channel) {
  const imager::SpectralAxis& has = file.header().spectral;
  if (has.channels == 1) return 0;
  if (!same_planes(has, axis))
    throw std::runtime_error(path + " has " + described(has) + "; expected one plane, or the image's " + described(axis));
  return channel;
}

bool bands_apart(const imager::Observation& file, const imager::Observation& data) {
  const double gap_hz = std::abs(file.frequency_hz - data.frequency_hz) - 0.5 * (file.bandwidth_hz + data.bandwidth_hz);
  return file.bandwidth_hz > 0 && data.frequency_hz > 0 && gap_hz > 1e-3 * data.frequency_hz;
}

double cosine_distance(const imager::SkyDirection& one, const imager::SkyDirection& other) {
  try {
    const imager::DirectionCosines offset = imager::direction_cosines(one, other);
    return std::hypot(offset.l, offset.m);
  } catch (const std::invalid_argument&) {
    return std::numeric_limits<double>::infinity();
  }
}

}  // namespace misfit::tools
