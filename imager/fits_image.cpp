#include "imager/fits_image.h"

#include <fitsio.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <limits>
#include <optional>
#include <stdexcept>
#include <system_error>

#include "kernels/whole_file.h"

namespace misfit::imager {
namespace {

constexpr double degree = M_PI / 180;

/// A FITS file, closed when it goes out of scope, whose errors name the path that the user gave. CFITSIO's "disk file" calls
/// take the name as it stands; an absolute one keeps them from expanding a tilde.
class FitsFile {
 public:
  FitsFile(std::string doing, std::string path) : doing_(std::move(doing)), path_(std::move(path)) { fits_clear_errmsg(); }
  FitsFile(const FitsFile&) = delete;
  FitsFile& operator=(const FitsFile&) = delete;
  ~FitsFile() {
    int status = 0;
    if (file_) fits_close_file(file_, &status);
    fits_clear_errmsg();
  }

  void create(const std::string& name) {
    int status = 0;
    check(fits_create_diskfile(&file_, std::filesystem::absolute(name).c_str(), &status));
  }
  void open(const std::string& name) {
    int status = 0;
    check(fits_open_diskfile(&file_, std::filesystem::absolute(name).c_str(), READONLY, &status));
  }
  void close() {
    int status = 0;
    fits_close_file(file_, &status);
    file_ = nullptr;
    check(status);
  }
  fitsfile* get() const { return file_; }

  [[noreturn]] void fail(const std::string& reason) const {
    throw std::runtime_error("cannot " + doing_ + " " + path_ + ": " + reason);
  }
  void check(int status) const {
    if (status == 0) return;
    std::array<char, FLEN_STATUS> text{};
    fits_get_errstatus(status, text.data());
    std::string reason = text.data();
    std::array<char, FLEN_ERRMSG> detail{};
    if (fits_read_errmsg(detail.data())) reason += std::string(" (") + detail.data() + ")";
    fail(reason);
  }

 private:
  std::string doing_;
  std::string path_;
  fitsfile* file_ = nullptr;
};

class HeaderWriter {
 public:
  explicit HeaderWriter(const FitsFile& file) : file_(file) {}
  void number(const std::string& key, double value, const std::string& comment = "") const {
    int status = 0;
    file_.check(fits_update_key(file_.get(), TDOUBLE, key.c_str(), &value, comment.c_str(), &status));
  }
  /// An empty text stands for what is not known, and is left out.
  void text(const std::string& key, const std::string& value, const std::string& comment = "") const {
    int status = 0;
    if (!value.empty()) file_.check(fits_update_key_str(file_.get(), key.c_str(), value.c_str(), comment.c_str(), &status));
  }
  void history(const std::string& line) const {
    int status = 0;
    file_.check(fits_write_history(file_.get(), line.c_str(), &status));
  }

 private:
  const FitsFile& file_;
};

struct Axis {
  std::string type;
  std::string unit;
  double reference_pixel = 1;
  double reference_value = 0;
  double increment = 1;
};

void write_axes(const HeaderWriter& header, const SkyImage& sky, const Axis& stokes) {
  const ImageGeometry& g = sky.geometry;
  const double bandwidth_hz = sky.observation.bandwidth_hz > 0 ? sky.observation.bandwidth_hz : 1;
  const std::array<Axis, 4> axes{{
      {"RA---SIN", "deg", g.centre_column() + 1 + g.centre.l / g.cell_rad, g.phase_centre.ra_rad / degree,
       -g.cell_rad / degree},
      {"DEC--SIN", "deg", g.centre_row() + 1 - g.centre.m / g.cell_rad, g.phase_centre.dec_rad / degree, g.cell_rad / degree},
      {"FREQ", "Hz", 1, sky.observation.frequency_hz, bandwidth_hz},
      stokes,
  }};
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const std::string n = std::to_string(i + 1);
    header.text("CTYPE" + n, axes[i].type);
    header.text("CUNIT" + n, axes[i].unit);
    header.number("CRPIX" + n, axes[i].reference_pixel);
    header.number("CRVAL" + n, axes[i].reference_value);
    header.number("CDELT" + n, axes[i].increment);
  }
  header.number("LONPOLE", 180);
  header.number("LATPOLE", g.phase_centre.dec_rad / degree);
  header.text("RADESYS", g.phase_centre.frame);
  header.number("EQUINOX", g.phase_centre.frame == "FK4" ? 1950 : 2000);
}

using Planes = std::vector<const SkyImage*>;

/// Throws std::invalid_argument when the planes do not fit in one file.
Axis stokes_axis(const Planes& planes) {
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

void write_header(const HeaderWriter& header, const SkyImage& sky, const Axis& stokes) {
  header.text("BUNIT", sky.unit);
  header.text("BTYPE", "Intensity");
  write_axes(header, sky, stokes);
  const Observation& observation = sky.observation;
  header.text("SPECSYS", observation.spectral_frame);
  header.number("RESTFRQ", observation.frequency_hz, "Hz");
  header.text("TELESCOP", observation.telescope);
  header.text("OBSERVER", observation.observer);
  header.text("OBJECT", observation.object);
  header.text("TIMESYS", "UTC");
  header.text("DATE-OBS", observation.date_obs);
  header.text("ORIGIN", "misfit");
  if (sky.has_beam) {
    header.number("BMAJ", sky.beam.major_rad / degree, "major axis of the beam, FWHM, deg");
    header.number("BMIN", sky.beam.minor_rad / degree, "minor axis of the beam, FWHM, deg");
    header.number("BPA", sky.beam.position_angle_rad / degree, "position angle, north through east, deg");
  }
  for (const HeaderCard& card : sky.cards) header.number(card.keyword, card.value, card.comment);
  for (const std::string& line : sky.history) header.history(line);
}

void write_file(const Planes& planes, const Axis& stokes, const FitsFile& file, PixelFormat format) {
  const SkyImage& sky = *planes.front();
  std::array<long, 4> size{sky.image.width, sky.image.height, 1, static_cast<long>(planes.size())}, first{1, 1, 1, 1};
  int status = 0;
  file.check(fits_create_img(file.get(), format == PixelFormat::float32 ? FLOAT_IMG : DOUBLE_IMG, 4, size.data(), &status));
  write_header(HeaderWriter(file), sky, stokes);
  for (const SkyImage* plane : planes) {
    file.check(fits_write_pix(file.get(), TDOUBLE, first.data(), static_cast<LONGLONG>(plane->image.pixel.size()),
                              const_cast<double*>(plane->image.pixel.data()), &status));
    ++first[3];
  }
}

/// Under its name when complete.
void write_planes(const Planes& planes, const std::string& path, PixelFormat format) {
  const Axis stokes = stokes_axis(planes);
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

class HeaderReader {
 public:
  explicit HeaderReader(const FitsFile& file) : file_(file) {}

  std::optional<double> number(const std::string& key) const {
    double value = 0;
    return read(key, TDOUBLE, &value) ? std::optional(value) : std::nullopt;
  }
  double needed(const std::string& key) const {
    const std::optional<double> value = number(key);
    if (!value) file_.fail("it has no " + key);
    return *value;
  }
  std::string text(const std::string& key) const {
    std::array<char, FLEN_VALUE> value{};
    return read(key, TSTRING, value.data()) ? value.data() : "";
  }

 private:
  bool read(const std::string& key, int type, void* value) const {
    int status = 0;
    fits_read_key(file_.get(), type, key.c_str(), value, nullptr, &status);
    const bool absent = status == KEY_NO_EXIST || status == VALUE_UNDEFINED;
    if (absent)
      fits_clear_errmsg();
    else
      file_.check(status);
    return !absent;
  }
  const FitsFile& file_;
};

/// The axis of the primary image whose length may be more than 1, counted from 0, and that length.
struct PlaneAxis {
  int axis = 2;
  long planes = 1;
};

/// The STOKES axis, if there is one.
PlaneAxis plane_axis(const FitsFile& file, const HeaderReader& header) {
  std::array<long, 9> size{};
  int status = 0, axes = 0;
  file.check(fits_get_img_dim(file.get(), &axes, &status));
  file.check(fits_get_img_size(file.get(), size.size(), size.data(), &status));
  for (int i = 2; i < std::min<int>(axes, size.size()); ++i)
    if (header.text("CTYPE" + std::to_string(i + 1)) == "STOKES") return {i, size[i]};
  return {};
}

/// Plane `plane`, counted from 1, of an image that has `expected.planes` of them along `expected.axis`.
Image read_plane(const FitsFile& file, const PlaneAxis& expected = {}, long plane = 1) {
  int status = 0, type = 0, axes = 0, any_blank = 0;
  std::array<long, 9> size{};
  file.check(fits_get_img_param(file.get(), size.size(), &type, &axes, size.data(), &status));
  bool is_plane = axes >= 2 && axes <= int(size.size());
  for (int i = 0; is_plane && i < axes; ++i)
    is_plane = i < 2 ? size[i] >= 1 && size[i] <= std::numeric_limits<int>::max()
                     : size[i] == (i == expected.axis ? expected.planes : 1);
  if (!is_plane) file.fail("its primary image is not two-dimensional (beyond the second, axes must have length 1)");
  std::array<long, 9> first, last = size;
  first.fill(1);
  first[expected.axis] = plane;
  // A file that is cut short, or whose header promises too much, fails here before memory is asked for.
  double pixel = 0;
  file.check(fits_read_pix(file.get(), TDOUBLE, last.data(), 1, nullptr, &pixel, nullptr, &status));
  Image image(static_cast<int>(size[0]), static_cast<int>(size[1]));
  // Asked to look for blanks, CFITSIO rounds subnormal numbers to zero; only integers need it.
  double blank = std::numeric_limits<double>::quiet_NaN();
  file.check(fits_read_pix(file.get(), TDOUBLE, first.data(), static_cast<LONGLONG>(image.pixel.size()),
                           type > 0 ? &blank : nullptr, image.pixel.data(), &any_blank, &status));
  return image;
}

/// Of a plane of the STOKES axis; I where there is no such axis.
Stokes stokes_of(const FitsFile& file, const HeaderReader& header, const PlaneAxis& stokes, long plane) {
  const std::string n = std::to_string(stokes.axis + 1);
  if (header.text("CTYPE" + n) != "STOKES") return Stokes::I;
  const double code = header.needed("CRVAL" + n) + (static_cast<double>(plane) - header.number("CRPIX" + n).value_or(1)) *
                                                       header.number("CDELT" + n).value_or(1);
  const double whole = std::round(code);
  if (std::abs(whole) > 8 || !is_fits_stokes_code(static_cast<int>(whole)) || std::abs(code - whole) > 0.01)
    file.fail("plane " + std::to_string(plane) + " of its STOKES axis has the code " + std::to_string(code) +
              "; expected 1 to 4, for I, Q, U and V, or -1 to -8, for correlations");
  return stokes_of_fits_code(static_cast<int>(whole));
}

std::string read_frame(const HeaderReader& header) {
  if (std::string frame = header.text("RADESYS"); !frame.empty()) return frame;
  const std::optional<double> equinox = header.number("EQUINOX");
  if (!equinox) return "ICRS";
  return *equinox < 1984 ? "FK4" : "FK5";  // Calabretta & Greisen 2002, section 3.1
}

void check_projection(const FitsFile& file, const HeaderReader& header) {
  const std::string x = header.text("CTYPE1"), y = header.text("CTYPE2");
  if (!(x.empty() && y.empty()) && !(x == "RA---SIN" && y == "DEC--SIN"))
    file.fail("its axes are '" + x + "' and '" + y + "', not RA---SIN and DEC--SIN");
  for (const char* key : {"CROTA1", "CROTA2", "PC1_2", "PC2_1", "CD1_2", "CD2_1", "PV2_1", "PV2_2"})
    if (const double value = header.number(key).value_or(0); value != 0)
      file.fail(std::string(key) + " = " + std::to_string(value) + ", where only 0 (no rotation, no slant) is known");
}

ImageGeometry read_geometry(const FitsFile& file, const HeaderReader& header, const Image& image) {
  check_projection(file, header);
  const double east = -header.needed("CDELT1"), north = header.needed("CDELT2");
  if (!(north > 0) || !(std::abs(east - north) <= 1e-6 * north))
    file.fail("its pixels are not square with east on the left: CDELT1 = " + std::to_string(-east) +
              ", CDELT2 = " + std::to_string(north));
  ImageGeometry geometry{image.width, image.height, north * degree, {}};
  geometry.centre = {(header.needed("CRPIX1") - (geometry.centre_column() + 1)) * geometry.cell_rad,
                     (geometry.centre_row() + 1 - header.needed("CRPIX2")) * geometry.cell_rad};
  geometry.phase_centre = {header.number("CRVAL1").value_or(0) * degree, header.number("CRVAL2").value_or(0) * degree,
                           read_frame(header)};
  return geometry;
}

Observation read_observation(const HeaderReader& header) {
  Observation observation;
  observation.telescope = header.text("TELESCOP");
  observation.observer = header.text("OBSERVER");
  observation.object = header.text("OBJECT");
  observation.date_obs = header.text("DATE-OBS");
  observation.spectral_frame = header.text("SPECSYS");
  observation.frequency_hz = header.number("RESTFRQ").value_or(0);
  for (const char* axis : {"3", "4"})
    if (header.text(std::string("CTYPE") + axis) == "FREQ") {
      observation.frequency_hz = header.needed(std::string("CRVAL") + axis);
      observation.bandwidth_hz = header.number(std::string("CDELT") + axis).value_or(0);
    }
  return observation;
}

/// `plane` with what the header says.
SkyImage sky_image(const FitsFile& file, Image plane) {
  const HeaderReader header(file);
  SkyImage sky;
  sky.image = std::move(plane);
  sky.geometry = read_geometry(file, header, sky.image);
  sky.observation = read_observation(header);
  sky.observation.phase_centre = sky.geometry.phase_centre;
  sky.unit = header.text("BUNIT");
  const double major_deg = header.number("BMAJ").value_or(0);
  sky.has_beam = major_deg > 0;
  if (sky.has_beam) sky.beam = {major_deg * degree, header.needed("BMIN") * degree, header.number("BPA").value_or(0) * degree};
  return sky;
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
  return sky_image(file, read_plane(file));
}

std::vector<SkyImage> read_stokes_images(const std::string& path) {
  FitsFile file("read", path);
  file.open(path);
  const HeaderReader header(file);
  const PlaneAxis axis = plane_axis(file, header);
  std::vector<SkyImage> images;
  for (long plane = 1; plane <= axis.planes; ++plane) {
    const Stokes stokes = stokes_of(file, header, axis, plane);
    for (const SkyImage& other : images)
      if (other.stokes == stokes) file.fail("it has two planes of " + stokes_name(stokes));
    images.push_back(sky_image(file, read_plane(file, axis, plane)));
    images.back().stokes = stokes;
  }
  return images;
}

}  // namespace misfit::imager
