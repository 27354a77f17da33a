#include "imager/fits_image.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <stdexcept>
#include <system_error>

#include "imager/fits_header.h"
#include "kernels/whole_file.h"

namespace misfit::imager {
namespace {

using Planes = std::vector<const SkyImage*>;

/// Throws std::invalid_argument when the planes do not fit in one file.
FitsAxis stokes_axis(const Planes& planes) {
  if (planes.empty()) throw std::invalid_argument("a FITS image of no planes; expected one at least");
  const auto code = [&](std::size_t i) { return fits_stokes_code(planes[i]->stokes); };
  const int step = planes.size() == 1 ? 1 : code(1) - code(0);
  for (std::size_t i = 1; i < planes.size(); ++i) {
    const Image &first = planes.front()->image, &other = planes[i]->image;
    if (other.width != first.width || other.height != first.height)
      throw std::invalid_argument("planes of " + std::to_string(first.width) + " × " + std::to_string(first.height) + " and " +
                                  std::to_string(other.width) + " × " + std::to_string(other.height) +
                                  " pixels in one FITS image; expected one size");
    if (step == 0 || code(i) - code(i - 1) != step)
      throw std::invalid_argument("STOKES codes " + std::to_string(code(i - 1)) + " and " + std::to_string(code(i)) +
                                  " in one FITS image; expected evenly spaced ones");
  }
  return {"STOKES", "", 1, static_cast<double>(code(0)), static_cast<double>(step)};
}

void write_file(const Planes& planes, const FitsAxis& stokes, FitsFile& file, PixelFormat format) {
  const SkyImage& sky = *planes.front();
  file.create_image({sky.image.width, sky.image.height, 1, static_cast<long>(planes.size())}, format);
  write_header(file, sky, stokes);
  for (std::size_t i = 0; i < planes.size(); ++i)
    file.write_pixels({1, 1, 1, static_cast<long>(i) + 1}, planes[i]->image.pixel);
}

/// Under its name when complete.
void write_planes(const Planes& planes, const std::string& path, PixelFormat format) {
  const FitsAxis stokes = stokes_axis(planes);
  const std::filesystem::path target = kernels::writable_target(path), temporary = target.string() + ".part";
  std::error_code error;
  std::filesystem::remove(temporary, error);
  try {
    FitsFile file("write", path);
    file.create(temporary);
    write_file(planes, stokes, file, format);
    file.close();
    std::filesystem::rename(temporary, target, error);
    if (error) file.fail(error.message());
  } catch (...) {
    std::filesystem::remove(temporary, error);
    throw;
  }
}

/// The axis of the primary image whose length may be more than 1, counted from 0, and that length.
struct PlaneAxis {
  std::size_t axis = 2;
  long planes = 1;
};

/// The STOKES axis, if there is one.
PlaneAxis plane_axis(const FitsFile& file) {
  const std::vector<long> size = file.size();
  for (std::size_t i = 2; i < size.size(); ++i)
    if (file.text("CTYPE" + std::to_string(i + 1)) == "STOKES") return {i, size[i]};
  return {};
}

/// Plane `plane`, counted from 1, of an image that has `expected.planes` of them along `expected.axis`.
Image read_plane(const FitsFile& file, const PlaneAxis& expected = {}, long plane = 1) {
  const std::vector<long> size = file.size();
  bool is_plane = size.size() >= 2;
  for (std::size_t i = 0; is_plane && i < size.size(); ++i)
    is_plane = i < 2 ? size[i] >= 1 && size[i] <= std::numeric_limits<int>::max()
                     : size[i] == (i == expected.axis ? expected.planes : 1);
  if (!is_plane) file.fail("its primary image is not two-dimensional (beyond the second, axes must have length 1)");
  // A file that is cut short, or whose header promises too much, fails here before memory is asked for.
  std::vector<double> last(1);
  file.read_pixels(size, last);
  Image image(static_cast<int>(size[0]), static_cast<int>(size[1]));
  std::vector<long> first(size.size(), 1);
  if (expected.axis < first.size()) first[expected.axis] = plane;
  file.read_pixels(first, image.pixel);
  return image;
}

/// Of a plane of the STOKES axis; I where there is no such axis.
Stokes stokes_of(const FitsFile& file, const PlaneAxis& stokes, long plane) {
  const std::string n = std::to_string(stokes.axis + 1);
  if (file.text("CTYPE" + n) != "STOKES") return Stokes::I;
  const double code = file.needed_number("CRVAL" + n) + (static_cast<double>(plane) - file.number("CRPIX" + n).value_or(1)) *
                                                            file.number("CDELT" + n).value_or(1);
  const double whole = std::round(code);
  if (std::abs(whole) > 8 || !is_fits_stokes_code(static_cast<int>(whole)) || std::abs(code - whole) > 0.01)
    file.fail("plane " + std::to_string(plane) + " of its STOKES axis has the code " + std::to_string(code) +
              "; expected 1 to 4, for I, Q, U and V, or -1 to -8, for correlations");
  return stokes_of_fits_code(static_cast<int>(whole));
}

}  // namespace

void write_fits(const SkyImage& image, const std::string& path, PixelFormat format) {
  write_planes({&image}, path, format);
}

void write_fits(const std::vector<SkyImage>& images, const std::string& path, PixelFormat format) {
  Planes planes;
  for (const SkyImage& image : images) planes.push_back(&image);
  write_planes(planes, path, format);
}

SkyImage read_fits(const std::string& path) {
  FitsFile file("read", path);
  file.open(path);
  return with_header(file, read_plane(file));
}

std::vector<SkyImage> read_stokes_images(const std::string& path) {
  FitsFile file("read", path);
  file.open(path);
  const PlaneAxis axis = plane_axis(file);
  std::vector<SkyImage> images;
  for (long plane = 1; plane <= axis.planes; ++plane) {
    const Stokes stokes = stokes_of(file, axis, plane);
    for (const SkyImage& other : images)
      if (other.stokes == stokes) file.fail("it has two planes of " + stokes_name(stokes));
    images.push_back(with_header(file, read_plane(file, axis, plane)));
    images.back().stokes = stokes;
  }
  return images;
}

}  // namespace misfit::imager
