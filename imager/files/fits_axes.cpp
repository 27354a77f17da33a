#include "imager/files/fits_axes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

#include "imager/files/fits_spectral.h"
#include "imager/numerics/constants.h"

namespace misfit::imager {
namespace {

/// An element of a matrix of axes, "PC" or "CD", as it is written now, or as it was (PC001002).
std::optional<double> element(const FitsFile& file, const std::string& matrix, std::size_t i, std::size_t j) {
  const std::string row = std::to_string(i + 1), column = std::to_string(j + 1);
  if (const std::optional<double> value = file.number(matrix + row + "_" + column)) return value;
  return file.number(matrix + "00" + row + "00" + column);
}

double cdelt(const FitsFile& file, std::size_t axis) {
  return file.number("CDELT" + std::to_string(axis + 1)).value_or(1);
}

/// The matrix if any of its elements is stated. Other elements are 0, except on the diagonal: 1 in PC, and in CD the CDELT of
/// axes beyond the first two.
std::optional<FitsSteps> read_matrix(const FitsFile& file, const std::string& matrix, std::size_t axes) {
  FitsSteps all(axes, std::vector<double>(axes));
  bool any = false;
  for (std::size_t i = 0; i < axes; ++i)
    for (std::size_t j = 0; j < axes; ++j) {
      const std::optional<double> value = element(file, matrix, i, j);
      any = any || value;
      all[i][j] = value.value_or(i != j ? 0 : matrix == "PC" ? 1 : i > 1 ? cdelt(file, i) : 0);
      if (i != j && (i > 1 || j > 1) && all[i][j] != 0)
        file.fail("its " + matrix + std::to_string(i + 1) + "_" + std::to_string(j + 1) + " is " + std::to_string(all[i][j]) +
                  "; expected 0, since only the first two axes may depend on each other");
    }
  return any ? std::optional(all) : std::nullopt;
}

/// The angle by which CROTA2 turns the first two axes, rad; 0 where a matrix says how they are turned.
double turn_rad(const FitsFile& file, std::size_t axes, bool has_matrix) {
  const double turn = file.number("CROTA2").value_or(0);
  for (std::size_t i = 0; i < axes; ++i) {
    const std::string key = "CROTA" + std::to_string(i + 1);
    const double other = file.number(key).value_or(0);
    if (other != 0 && (i > 1 || other != turn))
      file.fail("its " + key + " is " + std::to_string(other) + "; expected 0, and the turn of the image in CROTA2");
  }
  if (has_matrix && turn != 0) file.fail("its CROTA2 is " + std::to_string(turn) + " beside a matrix PC; expected one of them");
  return turn * pi / 180;
}

constexpr std::size_t most_axes = 9;

/// The pixels along each axis of coordinates: 1 along those that the header describes beyond NAXIS.
std::vector<long> lengths_of_axes(const FitsFile& file) {
  std::vector<long> lengths = file.size();
  if (lengths.size() > most_axes)
    file.fail("it has " + std::to_string(lengths.size()) + " axes; expected at most " + std::to_string(most_axes));
  for (std::size_t axis = most_axes; axis > lengths.size(); --axis)
    if (!file.text("CTYPE" + std::to_string(axis)).empty()) lengths.resize(axis, 1);
  return lengths;
}

/// Throws where keywords contradict each other.
FitsSteps read_steps(const FitsFile& file, std::size_t axes) {
  const std::optional<FitsSteps> cd = read_matrix(file, "CD", axes), pc = read_matrix(file, "PC", axes);
  if (cd && pc) file.fail("it has a matrix CD and a matrix PC of its axes; expected one of them");
  if (cd) return *cd;  // CDELT and CROTA may stand beside it, for programs that do not know it
  FitsSteps steps(axes, std::vector<double>(axes));
  for (std::size_t i = 0; i < axes; ++i)
    for (std::size_t j = 0; j < axes; ++j) steps[i][j] = cdelt(file, i) * (pc ? (*pc)[i][j] : i == j ? 1 : 0);
  if (const double turn = turn_rad(file, axes, pc.has_value()); turn != 0) {
    const double x = steps[0][0], y = steps[1][1], c = std::cos(turn), s = std::sin(turn);
    steps[0] = {c * x, -s * y};
    steps[1] = {s * x, c * y};
    for (std::size_t i : {0, 1}) steps[i].resize(axes);
  }
  return steps;
}

Stokes stokes_of(const FitsFile& file, const FitsAxis& axis, long plane) {
  const double code = axis.reference_value + (static_cast<double>(plane) - axis.reference_pixel) * axis.increment;
  const double whole = std::round(code);
  if (!(std::abs(whole) <= 8) || !is_fits_stokes_code(static_cast<int>(whole)) || std::abs(code - whole) > 0.01)
    file.fail("plane " + std::to_string(plane) + " of its STOKES axis has the code " + std::to_string(code) +
              "; expected 1 to 4, for I, Q, U and V, or -1 to -8, for correlations");
  return stokes_of_fits_code(static_cast<int>(whole));
}

}  // namespace

FitsAxis stokes_axis(const std::vector<Stokes>& stokes) {
  if (stokes.empty()) throw std::invalid_argument("a FITS image of no planes; expected one at least");
  const auto code = [&](std::size_t i) { return fits_stokes_code(stokes[i]); };
  const int step = stokes.size() == 1 ? 1 : code(1) - code(0);
  for (std::size_t i = 1; i < stokes.size(); ++i)
    if (step == 0 || code(i) - code(i - 1) != step)
      throw std::invalid_argument("STOKES codes " + std::to_string(code(i - 1)) + " and " + std::to_string(code(i)) +
                                  " in one FITS image; expected evenly spaced ones");
  return {"STOKES", "", 1, static_cast<double>(code(0)), static_cast<double>(step)};
}

FitsAxis read_axis(const FitsFile& file, const FitsPlanes& planes, std::size_t axis) {
  const std::string n = std::to_string(axis + 1);
  return {file.text("CTYPE" + n), file.text("CUNIT" + n), file.needed_number("CRPIX" + n), file.needed_number("CRVAL" + n),
          planes.steps[axis][axis]};
}

FitsPlanes find_planes(const FitsFile& file) {
  const std::vector<long> size = file.size();
  const auto fits = [](long length) { return length >= 1 && length <= std::numeric_limits<int>::max(); };
  if (size.size() < 2 || !std::all_of(size.begin(), size.end(), fits))
    file.fail(
        "its primary image has no two axes of pixels; expected the image there: copy one out of an extension into a file "
        "of its own, and uncompress one of fpack with funpack");
  FitsPlanes planes;
  planes.axes = size.size();
  planes.lengths = lengths_of_axes(file);
  for (std::size_t i = 2; i < planes.lengths.size(); ++i) {
    const std::string type = file.text("CTYPE" + std::to_string(i + 1));
    if (type == "STOKES" && !planes.stokes)
      planes.stokes = i;
    else if (is_spectral(type) && !planes.spectral)
      planes.spectral = i;
    else if (const bool untyped = type.empty() || type == "LINEAR" || type == "PIXEL"; !untyped || planes.lengths[i] > 1)
      file.fail("its axis " + std::to_string(i + 1) + " of type '" + type + "' has length " +
                std::to_string(planes.lengths[i]) + "; expected one STOKES axis, one of " + spectral_types +
                ", and others of length 1 without a type");
  }
  planes.steps = read_steps(file, planes.lengths.size());
  return planes;
}

std::vector<long> first_pixel(const FitsPlanes& planes, const PlaneIndex& at) {
  std::vector<long> first(planes.lengths.size(), 1);
  if (planes.spectral) first[*planes.spectral] = at.channel + 1;
  if (planes.stokes) first[*planes.stokes] = at.stokes + 1;
  first.resize(planes.axes);
  return first;
}

std::vector<Stokes> read_stokes(const FitsFile& file, const FitsPlanes& planes) {
  if (!planes.stokes) return {Stokes::I};
  const FitsAxis axis = read_axis(file, planes, *planes.stokes);
  std::vector<Stokes> list;
  for (long plane = 1; plane <= planes.lengths[*planes.stokes]; ++plane) {
    const Stokes stokes = stokes_of(file, axis, plane);
    if (std::find(list.begin(), list.end(), stokes) != list.end()) file.fail("it has two planes of " + stokes_name(stokes));
    list.push_back(stokes);
  }
  return list;
}

}  // namespace misfit::imager
