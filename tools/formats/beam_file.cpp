#include "tools/formats/beam_file.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "imager/beams/image_pattern.h"
#include "imager/files/fits_file.h"
#include "imager/numerics/constants.h"
#include "tools/base/numbers.h"

namespace misfit::tools {
namespace {

std::string card(const std::string& key, int axis) {
  return key + std::to_string(axis);
}

/// An axis' unit in rad; 1 for direction cosines, which have none.
double unit_rad(const imager::FitsFile& file, int axis) {
  static const std::map<std::string, double> units{{"", 1},
                                                   {"rad", 1},
                                                   {"deg", imager::pi / 180},
                                                   {"degree", imager::pi / 180},
                                                   {"degrees", imager::pi / 180},
                                                   {"arcmin", imager::pi / 180 / 60},
                                                   {"arcsec", imager::pi / 180 / 3600}};
  std::string unit = file.text(card("CUNIT", axis));
  std::transform(unit.begin(), unit.end(), unit.begin(), [](unsigned char c) { return std::tolower(c); });
  const std::string type = file.text(card("CTYPE", axis));
  if (unit.empty() && (type.rfind("RA--", 0) == 0 || type.rfind("DEC-", 0) == 0)) unit = "deg";  // FITS's default
  const auto known = units.find(unit);
  if (known == units.end())
    file.fail(card("CUNIT", axis) + " is '" + unit + "'; expected deg, arcmin, arcsec, rad, or none of direction cosines");
  return known->second;
}

/// 1 where the axis counts to the east, or north, when the zenith is north; −1 for azimuths, which then count to the west.
double direction_of(const imager::FitsFile& file, int axis) {
  const std::vector<std::pair<std::string, double>> known[] = {{{"", 1}, {"RA", 1}, {"X", 1}, {"L", 1}, {"AZ", -1}},
                                                               {{"", 1}, {"DEC", 1}, {"Y", 1}, {"M", 1}, {"EL", 1}}};
  const std::string type = file.text(card("CTYPE", axis)), name = type.substr(0, type.find('-'));
  for (const auto& [accepted, sign] : known[axis - 1])
    if (name == accepted) return sign;
  file.fail(card("CTYPE", axis) + " is '" + type + "'; expected " + (axis == 1 ? "RA, X, L or AZ" : "DEC, Y, M or EL"));
}

/// Throws where axes are turned: they would need another frame than the dish's.
void require_upright(const imager::FitsFile& file) {
  for (const char* key : {"CROTA1", "CROTA2", "PC1_2", "PC2_1", "CD1_1", "CD1_2", "CD2_1", "CD2_2"})
    if (const auto value = file.number(key); value && *value != 0)
      file.fail(std::string(key) + " is " + significant(*value, 6) +
                "; expected axes that are not turned, by CDELT1 and CDELT2");
}

/// An axis' unit in Hz.
double unit_hz(const imager::FitsFile& file, int axis) {
  static const std::map<std::string, double> units{{"", 1}, {"Hz", 1}, {"kHz", 1e3}, {"MHz", 1e6}, {"GHz", 1e9}};
  const std::string unit = file.text(card("CUNIT", axis));
  const auto known = units.find(unit);
  if (known == units.end()) file.fail(card("CUNIT", axis) + " is '" + unit + "'; expected Hz, kHz, MHz or GHz");
  return known->second;
}

bool is_of_sines(const imager::FitsFile& file, int axis) {
  const std::string type = file.text(card("CTYPE", axis));
  return (type.size() > 4 && type.compare(type.size() - 3, 3, "SIN") == 0) || file.text(card("CUNIT", axis)).empty();
}

/// The place of the frequency among the axes, from 1; 0 where there is none. All axes beyond the second but this one are of
/// length 1.
int frequency_axis(const imager::FitsFile& file, const std::vector<long>& size) {
  int found = 0;
  for (int axis = 3; axis <= static_cast<int>(size.size()); ++axis) {
    if (file.text(card("CTYPE", axis)).rfind("FREQ", 0) == 0)
      found = axis;
    else if (size[static_cast<std::size_t>(axis) - 1] != 1)
      file.fail("axis " + std::to_string(axis) + " of " + file.text(card("CTYPE", axis)) + " has " +
                std::to_string(size[static_cast<std::size_t>(axis) - 1]) +
                " pixels; expected the frequency alone beside the sky");
  }
  return found;
}

std::vector<double> frequencies_hz(const imager::FitsFile& file, const std::vector<long>& size, int axis) {
  if (axis == 0) {
    const auto hz = file.number("RESTFRQ");
    if (!hz || !(*hz > 0)) file.fail("it states no frequency; expected an axis FREQ, or RESTFRQ");
    return {*hz};
  }
  const double unit = unit_hz(file, axis);
  const long planes = size[static_cast<std::size_t>(axis) - 1];
  if (planes > 1 && file.needed_number(card("CDELT", axis)) == 0)
    file.fail(card("CDELT", axis) + " is 0; expected the step of " + std::to_string(planes) + " frequencies");
  std::vector<double> hz;
  for (long k = 0; k < planes; ++k)
    hz.push_back(unit * (file.needed_number(card("CRVAL", axis)) +
                         (static_cast<double>(k + 1) - file.needed_number(card("CRPIX", axis))) *
                             file.needed_number(card("CDELT", axis))));
  for (const double value : hz)
    if (!(value > 0)) file.fail("its frequencies include " + significant(value, 6) + " Hz; expected positive ones");
  return hz;
}

}  // namespace

imager::Pattern read_beam_file(const std::string& path, BeamPixels pixels) {
  constexpr double near_1 = 0.02, largest = 1.1;
  imager::FitsFile file("read", path);
  file.open(path);
  const std::vector<long> size = file.size();
  if (size.size() < 2) file.fail("it has " + std::to_string(size.size()) + " axes; expected two of the sky, and the frequency");
  require_upright(file);
  imager::PatternGrid grid;
  grid.width = static_cast<int>(size[0]);
  grid.height = static_cast<int>(size[1]);
  grid.axis_column = file.needed_number("CRPIX1") - 1;
  grid.axis_row = file.needed_number("CRPIX2") - 1;
  grid.column_rad = direction_of(file, 1) * file.needed_number("CDELT1") * unit_rad(file, 1);
  grid.row_rad = direction_of(file, 2) * file.needed_number("CDELT2") * unit_rad(file, 2);
  if (grid.column_rad == 0 || grid.row_rad == 0) file.fail("CDELT1 and CDELT2 are the size of a pixel; expected other than 0");
  grid.of_sines = is_of_sines(file, 1);
  const int axis = frequency_axis(file, size);
  const std::vector<double> hz = frequencies_hz(file, size, axis);
  for (std::size_t k = 0; k < hz.size(); ++k) {
    std::vector<long> first(size.size(), 1);
    if (axis != 0) first[static_cast<std::size_t>(axis) - 1] = static_cast<long>(k) + 1;
    imager::PatternGrid::Plane plane{
        hz[k], std::vector<double>(static_cast<std::size_t>(grid.width) * static_cast<std::size_t>(grid.height))};
    file.read_pixels(first, plane.voltage);
    for (double& value : plane.voltage) {
      if (std::isnan(value)) value = 0;
      if (!(std::abs(value) <= largest))
        file.fail("it has a pixel of " + significant(value, 4) + "; expected a magnitude of 1 at most");
      if (pixels == BeamPixels::power) value = std::sqrt(std::max(0.0, value));
    }
    grid.planes.push_back(std::move(plane));
  }
  std::sort(grid.planes.begin(), grid.planes.end(),
            [](const auto& a, const auto& b) { return a.frequency_hz < b.frequency_hz; });
  try {
    const imager::Pattern pattern = imager::image_pattern(grid);
    for (imager::PatternGrid::Plane& plane : grid.planes) {
      const double on_axis = pattern->voltage_at(0, 0, plane.frequency_hz);
      if (!(std::abs(on_axis - 1) < near_1))
        file.fail("on its axis, at the reference pixel, it is " +
                  significant(pixels == BeamPixels::power ? on_axis * on_axis : on_axis, 4) + " at " +
                  significant(plane.frequency_hz / 1e9, 6) + " GHz; expected 1");
      for (double& value : plane.voltage) value /= on_axis;
    }
    return imager::image_pattern(std::move(grid));
  } catch (const std::invalid_argument& error) {
    file.fail(error.what());
  }
}

}  // namespace misfit::tools
