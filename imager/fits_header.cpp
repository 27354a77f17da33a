#include "imager/fits_header.h"

#include <array>
#include <cmath>
#include <optional>

namespace misfit::imager {
namespace {

constexpr double degree = M_PI / 180;

void write_axes(FitsFile& file, const SkyImage& sky, const FitsAxis& stokes) {
  const ImageGeometry& g = sky.geometry;
  const double bandwidth_hz = sky.observation.bandwidth_hz > 0 ? sky.observation.bandwidth_hz : 1;
  const std::array<FitsAxis, 4> axes{{
      {"RA---SIN", "deg", g.centre_column() + 1 + g.centre.l / g.cell_rad, g.phase_centre.ra_rad / degree,
       -g.cell_rad / degree},
      {"DEC--SIN", "deg", g.centre_row() + 1 - g.centre.m / g.cell_rad, g.phase_centre.dec_rad / degree, g.cell_rad / degree},
      {"FREQ", "Hz", 1, sky.observation.frequency_hz, bandwidth_hz},
      stokes,
  }};
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const std::string n = std::to_string(i + 1);
    file.write_text("CTYPE" + n, axes[i].type);
    file.write_text("CUNIT" + n, axes[i].unit);
    file.write_number("CRPIX" + n, axes[i].reference_pixel);
    file.write_number("CRVAL" + n, axes[i].reference_value);
    file.write_number("CDELT" + n, axes[i].increment);
  }
  file.write_number("LONPOLE", 180);
  file.write_number("LATPOLE", g.phase_centre.dec_rad / degree);
  file.write_text("RADESYS", g.phase_centre.frame);
  file.write_number("EQUINOX", g.phase_centre.frame == "FK4" ? 1950 : 2000);
}

std::string read_frame(const FitsFile& file) {
  if (std::string frame = file.text("RADESYS"); !frame.empty()) return frame;
  const std::optional<double> equinox = file.number("EQUINOX");
  if (!equinox) return "ICRS";
  return *equinox < 1984 ? "FK4" : "FK5";  // Calabretta & Greisen 2002, section 3.1
}

void check_projection(const FitsFile& file) {
  const std::string x = file.text("CTYPE1"), y = file.text("CTYPE2");
  if (!(x.empty() && y.empty()) && !(x == "RA---SIN" && y == "DEC--SIN"))
    file.fail("its axes are '" + x + "' and '" + y + "', not RA---SIN and DEC--SIN");
  for (const char* key : {"CROTA1", "CROTA2", "PC1_2", "PC2_1", "CD1_2", "CD2_1", "PV2_1", "PV2_2"})
    if (const double value = file.number(key).value_or(0); value != 0)
      file.fail(std::string(key) + " = " + std::to_string(value) + ", where only 0 (no rotation, no slant) is known");
}

ImageGeometry read_geometry(const FitsFile& file, const Image& image) {
  check_projection(file);
  const double east = -file.needed_number("CDELT1"), north = file.needed_number("CDELT2");
  if (!(north > 0) || !(std::abs(east - north) <= 1e-6 * north))
    file.fail("its pixels are not square with east on the left: CDELT1 = " + std::to_string(-east) +
              ", CDELT2 = " + std::to_string(north));
  ImageGeometry geometry{image.width, image.height, north * degree, {}};
  geometry.centre = {(file.needed_number("CRPIX1") - (geometry.centre_column() + 1)) * geometry.cell_rad,
                     (geometry.centre_row() + 1 - file.needed_number("CRPIX2")) * geometry.cell_rad};
  geometry.phase_centre = {file.number("CRVAL1").value_or(0) * degree, file.number("CRVAL2").value_or(0) * degree,
                           read_frame(file)};
  return geometry;
}

Observation read_observation(const FitsFile& file) {
  Observation observation;
  observation.telescope = file.text("TELESCOP");
  observation.observer = file.text("OBSERVER");
  observation.object = file.text("OBJECT");
  observation.date_obs = file.text("DATE-OBS");
  observation.spectral_frame = file.text("SPECSYS");
  observation.frequency_hz = file.number("RESTFRQ").value_or(0);
  for (const char* axis : {"3", "4"})
    if (file.text(std::string("CTYPE") + axis) == "FREQ") {
      observation.frequency_hz = file.needed_number(std::string("CRVAL") + axis);
      observation.bandwidth_hz = file.number(std::string("CDELT") + axis).value_or(0);
    }
  return observation;
}

}  // namespace

void write_header(FitsFile& file, const SkyImage& sky, const FitsAxis& stokes) {
  file.write_text("BUNIT", sky.unit);
  file.write_text("BTYPE", "Intensity");
  write_axes(file, sky, stokes);
  const Observation& observation = sky.observation;
  file.write_text("SPECSYS", observation.spectral_frame);
  file.write_number("RESTFRQ", observation.frequency_hz, "Hz");
  file.write_text("TELESCOP", observation.telescope);
  file.write_text("OBSERVER", observation.observer);
  file.write_text("OBJECT", observation.object);
  file.write_text("TIMESYS", "UTC");
  file.write_text("DATE-OBS", observation.date_obs);
  file.write_text("ORIGIN", "misfit");
  if (sky.has_beam) {
    file.write_number("BMAJ", sky.beam.major_rad / degree, "major axis of the beam, FWHM, deg");
    file.write_number("BMIN", sky.beam.minor_rad / degree, "minor axis of the beam, FWHM, deg");
    file.write_number("BPA", sky.beam.position_angle_rad / degree, "position angle, north through east, deg");
  }
  for (const HeaderCard& card : sky.cards) file.write_number(card.keyword, card.value, card.comment);
  for (const std::string& line : sky.history) file.write_history(line);
}

SkyImage with_header(const FitsFile& file, Image plane) {
  SkyImage sky;
  sky.image = std::move(plane);
  sky.geometry = read_geometry(file, sky.image);
  sky.observation = read_observation(file);
  sky.observation.phase_centre = sky.geometry.phase_centre;
  sky.unit = file.text("BUNIT");
  const double major_deg = file.number("BMAJ").value_or(0);
  sky.has_beam = major_deg > 0;
  if (sky.has_beam)
    sky.beam = {major_deg * degree, file.needed_number("BMIN") * degree, file.number("BPA").value_or(0) * degree};
  return sky;
}

}  // namespace misfit::imager
