#include "imager/files/fits_celestial.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <sstream>
#include <utility>

#include "imager/numerics/constants.h"

namespace misfit::imager {
namespace {

constexpr double deg_rad = pi / 180;

std::string shown(double value) {
  std::ostringstream text;
  text.precision(12);
  text << value;
  return text.str();
}

/// "RA---SIN" of RA and SIN.
std::string axis_type(const std::string& coordinate, const std::string& projection) {
  return (coordinate + "----").substr(0, 5) + projection;
}

struct CelestialType {
  bool galactic = false;
  std::string projection;  ///< three letters
};

CelestialType read_type(const FitsFile& file) {
  const std::string x = file.text("CTYPE1"), y = file.text("CTYPE2");
  for (const char* projection : {"SIN", "TAN", "STG", "ARC", "ZEA", "NCP"}) {
    if (x == axis_type("RA", projection) && y == axis_type("DEC", projection)) return {false, projection};
    if (x == axis_type("GLON", projection) && y == axis_type("GLAT", projection)) return {true, projection};
  }
  file.fail("its axes are '" + x + "' and '" + y +
            "'; expected RA---SIN and DEC--SIN, or GLON and GLAT, or one of TAN, STG, ARC, ZEA and NCP in place of SIN");
}

/// Tells whether the header has no sky coordinates at all. Throws where it has a step without saying of which coordinate.
bool says_nothing(const FitsFile& file) {
  for (const std::string n : {"1", "2"}) {
    const std::string type = file.text("CTYPE" + n);
    if (!type.empty() && type != "LINEAR" && type != "PIXEL") return false;
    for (const std::string& key : {"CDELT" + n, "CD" + n + "_" + n})
      if (const double step = file.number(key).value_or(1); type.empty() && std::abs(step) != 1)
        file.fail("its " + key + " is " + shown(step) + ", but there is no CTYPE" + n + " that says of what; expected " +
                  (n == "1" ? "RA---SIN" : "DEC--SIN"));
  }
  return true;
}

/// Radians in one of the unit of an axis; FITS has degrees, programs write others too.
double unit_rad(const FitsFile& file, const std::string& key) {
  static const std::pair<const char*, double> units[]{
      {"", deg_rad}, {"deg", deg_rad}, {"degree", deg_rad},      {"degrees", deg_rad},       {"rad", 1},
      {"radian", 1}, {"radians", 1},   {"arcmin", deg_rad / 60}, {"arcsec", deg_rad / 3600}, {"mas", deg_rad / 36e5}};
  const std::string unit = file.text(key);
  std::string lower = unit;
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char letter) { return std::tolower(letter); });
  for (const auto& [name, rad] : units)
    if (lower == name) return rad;
  file.fail("its " + key + " is " + unit + "; expected deg, rad, arcmin, arcsec or mas");
}

double reference_rad(const FitsFile& file, const std::string& n, double unit, double most_deg) {
  const double value_rad = file.needed_number("CRVAL" + n) * unit;
  if (!(std::abs(value_rad) <= most_deg * deg_rad * (1 + 1e-12)))
    file.fail("its CRVAL" + n + " is " + shown(value_rad / deg_rad) + " degrees; expected at most " + shown(most_deg));
  return value_rad;
}

/// A year as a number, or as some programs write it, J2000 or B1950. None where there is no card of the key.
std::optional<double> read_equinox(const FitsFile& file, const std::string& key) {
  const std::string year = file.text(key);
  if (year == "J2000" || year == "J2000.0") return 2000;
  if (year == "B1950" || year == "B1950.0") return 1950;
  return file.number(key);
}

/// Calabretta & Greisen 2002, section 3.1; RADECSYS and EPOCH are what older programs write.
std::string read_frame(const FitsFile& file) {
  const std::string key = file.text("RADESYS").empty() ? "RADECSYS" : "RADESYS";
  const std::string of_equinox = file.text("EQUINOX").empty() ? "EPOCH" : "EQUINOX";
  const std::optional<double> equinox = read_equinox(file, of_equinox);
  std::string frame = file.text(key);
  if (frame.empty()) frame = !equinox ? "ICRS" : *equinox < 1984 ? "FK4" : "FK5";
  if (frame != "ICRS" && frame != "FK5" && frame != "FK4")
    file.fail("its " + key + " is " + frame + "; expected ICRS, FK5 or FK4");
  if (const double year = frame == "FK4" ? 1950 : 2000; equinox && *equinox != year)
    file.fail("its " + of_equinox + " is " + shown(*equinox) + "; expected " + shown(year) + " of " + frame);
  return frame;
}

/// Refuses parameters of projections that are not read: another reference point than the pole, polynomials. PV1_3 and PV1_4 are
/// LONPOLE and LATPOLE.
void refuse_parameters(const FitsFile& file, bool slanted) {
  for (const int axis : {1, 2})
    for (int m = 0; m < 40; ++m) {
      if ((axis == 2 && slanted && (m == 1 || m == 2)) || (axis == 1 && (m == 3 || m == 4))) continue;
      const std::string key = "PV" + std::to_string(axis) + "_" + std::to_string(m);
      const double usual = axis == 1 && m == 2 ? 90 : 0;
      if (const double value = file.number(key).value_or(usual); value != usual)
        file.fail("its " + key + " is " + shown(value) + "; expected " + shown(usual) + " of this projection");
    }
  for (const char* key : {"CPDIS1", "CPDIS2", "CQDIS1", "CQDIS2", "D2IMDIS1", "D2IMDIS2"})
    if (const std::string name = file.text(key); !name.empty())
      file.fail("its " + std::string(key) + " is " + name + "; expected no distortion of pixels");
  for (const char* key : {"A_ORDER", "B_ORDER"})
    if (const double order = file.number(key).value_or(0); order != 0)
      file.fail("its " + std::string(key) + " is " + shown(order) + "; expected no distortion of pixels");
}

/// NCP is a slant (Calabretta & Greisen 2002, section 5.1.5), without which SIN has PV2_1 and PV2_2.
std::array<double, 2> read_slant(const FitsFile& file, const std::string& projection, double dec_rad) {
  if (projection == "SIN") return {file.number("PV2_1").value_or(0), file.number("PV2_2").value_or(0)};
  if (projection != "NCP") return {};
  if (!(std::abs(std::tan(dec_rad)) > 1e-6))
    file.fail("its projection is NCP on the equator, where NCP maps nothing; expected another projection");
  return {0, 1 / std::tan(dec_rad)};
}

/// LATPOLE tells nothing where the reference is the pole of the projection.
double read_pole_deg(const FitsFile& file, double dec_rad) {
  const double usual = dec_rad >= 90 * deg_rad ? 0 : 180;  // equation 8
  const std::optional<double> stated = file.number("LONPOLE"), parameter = file.number("PV1_3");
  if (stated && parameter && *stated != *parameter)
    file.fail("its LONPOLE is " + shown(*stated) + " and its PV1_3 " + shown(*parameter) + "; expected one value");
  return parameter ? *parameter : stated.value_or(usual);
}

}  // namespace

std::optional<SkyGrid> read_sky_grid(const FitsFile& file, const FitsSteps& steps) {
  if (says_nothing(file)) return std::nullopt;
  const CelestialType type = read_type(file);
  if (!file.number("CD1_1") && !file.number("CD001001"))
    for (const char* key : {"CDELT1", "CDELT2"}) file.needed_number(key);
  const double units[]{unit_rad(file, "CUNIT1"), unit_rad(file, "CUNIT2")};
  SkyGrid grid;
  const std::vector<long> size = file.size();
  grid.width = static_cast<int>(size[0]);
  grid.height = static_cast<int>(size[1]);
  grid.projection = projection_named(type.projection).value_or(Projection::sin);
  grid.reference = {reference_rad(file, "1", units[0], 360), reference_rad(file, "2", units[1], 90),
                    type.galactic ? "GALACTIC" : read_frame(file)};
  grid.reference_pixel = {file.needed_number("CRPIX1") - 1, file.needed_number("CRPIX2") - 1};
  for (std::size_t i = 0; i < 2; ++i)
    for (std::size_t j = 0; j < 2; ++j) grid.step[i][j] = steps[i][j] * units[i];
  refuse_parameters(file, type.projection == "SIN");
  grid.slant = read_slant(file, type.projection, grid.reference.dec_rad);
  set_pole(grid, read_pole_deg(file, grid.reference.dec_rad) * deg_rad);
  if (!grid.is_regular())
    file.fail("its pixels have no area, or lie farther away than numbers reach: its CDELT is 0, or its CRPIX too large");
  return grid;
}

}  // namespace misfit::imager
