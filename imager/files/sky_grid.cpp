#include "imager/files/sky_grid.h"

#include <Eigen/Dense>
#include <algorithm>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "imager/data/phase_shift.h"
#include "imager/numerics/constants.h"

namespace misfit::imager {
namespace {

using Plane = std::array<double, 2>;

constexpr std::array<std::pair<Projection, const char*>, 5> known_projections{{{Projection::sin, "SIN"},
                                                                               {Projection::tan, "TAN"},
                                                                               {Projection::stg, "STG"},
                                                                               {Projection::arc, "ARC"},
                                                                               {Projection::zea, "ZEA"}}};

using Turn = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

/// The matrix whose rows are the unit vectors to the east, to the north, and towards a direction.
Turn axes_at(const SkyDirection& at) {
  const UvwAxes axes = uvw_axes(at);
  return Turn{{axes.u[0], axes.u[1], axes.u[2]}, {axes.v[0], axes.v[1], axes.v[2]}, {axes.w[0], axes.w[1], axes.w[2]}};
}

FrameRotation rotation_of(const Turn& turn) {
  FrameRotation rotation{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) rotation[i][j] = turn(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
  return rotation;
}

/// The point of the plane where a projection has the direction (l, m, n), n its cosine from the reference: R(ψ)/sin ψ · (l, m).
Plane projected(const SkyGrid& grid, double l, double m, double n) {
  double stretch = 1;
  switch (grid.projection) {
    case Projection::sin:
      return {l + grid.slant[0] * (1 - n), m + grid.slant[1] * (1 - n)};
    case Projection::tan:
      stretch = 1 / n;
      break;
    case Projection::stg:
      stretch = 2 / (1 + n);
      break;
    case Projection::arc: {
      const double sine = std::hypot(l, m);
      stretch = sine > 0 ? std::atan2(sine, n) / sine : 1;
      break;
    }
    case Projection::zea:
      stretch = std::sqrt(2 / (1 + n));
      break;
  }
  return {stretch * l, stretch * m};
}

/// True if a direction with the cosine n from the reference has a point of its own in the plane. In projections that reach
/// around the sphere the farthest direction lies at infinity, or is a circle instead of a point.
bool reaches(Projection projection, double n) {
  return n > (projection == Projection::sin || projection == Projection::tan ? 0 : -1 + 1e-12);
}

std::array<Plane, 2> inverse_of(const std::array<Plane, 2>& a) {
  const double determinant = a[0][0] * a[1][1] - a[0][1] * a[1][0];
  return {{{a[1][1] / determinant, -a[0][1] / determinant}, {-a[1][0] / determinant, a[0][0] / determinant}}};
}

std::string six_digits(double value) {
  std::ostringstream text;
  text.precision(6);
  text << value;
  return text.str();
}

std::string arcseconds(double angle_rad) {
  return six_digits(angle_rad * 180 * 3600 / pi);
}

/// How many pixels the point of a place lies from where `step` has it.
double away(const SkyGrid& grid, const Plane& point, const PixelPlace& place) {
  const double columns = place.column - grid.reference_pixel.column, rows = place.row - grid.reference_pixel.row;
  return std::hypot(grid.step[0][0] * columns + grid.step[0][1] * rows - point[0],
                    grid.step[1][0] * columns + grid.step[1][1] * rows - point[1]) /
         std::min(grid.column_step_rad(), grid.row_step_rad());
}

/// The largest distance, pixels, between corners of the grid and of an upright geometry, where the plane of projection is the
/// same. Both are linear, so none lies farther than a corner.
double turned_away(const SkyGrid& grid, const ImageGeometry& upright) {
  double most = 0;
  for (const int row : {0, grid.height - 1})
    for (const int column : {0, grid.width - 1}) {
      const DirectionCosines at = upright.at(row, column);
      most = std::max(most, away(grid, {at.l, at.m}, {double(column), double(row)}));
    }
  return most;
}

/// The largest distance, pixels, by which the grid's projection differs from SIN without slant. It grows with the distance from
/// the reference.
double bent_away(const SkyGrid& grid, const ImageGeometry& upright) {
  if (grid.projection == Projection::sin && grid.slant == Plane{}) return 0;
  double most = 0;
  for (const DirectionCosines& at : upright.corners()) {
    const Plane point = projected(grid, at.l, at.m, 1 + n_minus_1(at));
    const double bent = std::hypot(point[0] - at.l, point[1] - at.m) / std::min(upright.cell_rad, upright.cell_height_rad());
    most = bent <= most ? most : bent;  // NaN too
  }
  return std::isnan(most) ? std::numeric_limits<double>::infinity() : most;
}

/// Says in words the main difference between the grid's axes and an upright geometry's.
std::string turned_in_words(const SkyGrid& grid) {
  const double angle_rad = grid.position_angle_rad(), width_rad = grid.column_step_rad(), height_rad = grid.row_step_rad();
  const double turned = std::abs(std::sin(angle_rad)), oblong = std::abs(height_rad / width_rad - 1);
  const double skewed =
      std::abs(grid.step[0][0] * grid.step[0][1] + grid.step[1][0] * grid.step[1][1]) / (width_rad * height_rad);
  constexpr double alike = 0.99;  // a skew of rows is a turn of rows
  if (grid.is_mirrored()) return "its pixels show the sky mirrored (CDELT1 or CDELT2 of the other sign)";
  if (std::cos(angle_rad) < 0 || turned >= alike * std::max(oblong, skewed))
    return "its pixels are turned by " + six_digits(angle_rad * 180 / pi) + " degrees from north" +
           (grid.reference.dec_rad < 90 * (pi / 180) ? "" : " (LONPOLE, which is 0 at the north pole where it is not stated)");
  if (skewed > oblong)
    return "the sides of its pixels are " + six_digits(std::asin(skewed) * 180 / pi) + " degrees from a right angle";
  return "its pixels are " + arcseconds(width_rad) + "arcsec wide and " + arcseconds(height_rad) + "arcsec high";
}

}  // namespace

std::string projection_name(Projection projection) {
  for (const auto& [known, name] : known_projections)
    if (known == projection) return name;
  return "";
}

std::optional<Projection> projection_named(const std::string& letters) {
  for (const auto& [known, name] : known_projections)
    if (letters == name) return known;
  return std::nullopt;
}

bool SkyGrid::is_regular() const {
  const double area = step[0][0] * step[1][1] - step[0][1] * step[1][0];
  const double farthest = std::hypot(column_step_rad() * (std::abs(reference_pixel.column) + width),
                                     row_step_rad() * (std::abs(reference_pixel.row) + height));
  return std::isfinite(1 / area) && area != 0 && std::isfinite(farthest);
}

void set_pole(SkyGrid& grid, double longitude_rad) {
  const double turn = longitude_rad - pi, c = std::cos(turn), s = std::sin(turn);
  const auto turned = [&](double x, double y) { return Plane{c * x + s * y, c * y - s * x}; };
  const Plane column = turned(grid.step[0][0], grid.step[1][0]), row = turned(grid.step[0][1], grid.step[1][1]);
  grid.step = {{{column[0], row[0]}, {column[1], row[1]}}};
  grid.slant = turned(grid.slant[0], grid.slant[1]);
}

SkyGrid grid_of(const ImageGeometry& g) {
  SkyGrid grid;
  grid.width = g.width;
  grid.height = g.height;
  grid.reference = g.phase_centre;
  grid.reference_pixel = {g.centre_column() + g.centre.l / g.cell_rad, g.centre_row() - g.centre.m / g.cell_height_rad()};
  grid.step = {{{-g.cell_rad, 0}, {0, g.cell_height_rad()}}};
  return grid;
}

UprightGeometry upright_geometry(const SkyGrid& grid) {
  constexpr double infinite = std::numeric_limits<double>::infinity(), rounding = 1e-9;  // pixels
  const std::string& frame = grid.reference.frame;
  UprightGeometry upright{{grid.width, grid.height, grid.column_step_rad(), grid.reference}, infinite, ""};
  ImageGeometry& g = upright.geometry;
  const double aspect = grid.row_step_rad() / g.cell_rad, oblong = std::abs(aspect - 1) * grid.height;
  // If rows are farther off, square pixels are taken, which lie half as far away in the last row or in the first.
  if (oblong > rounding && oblong < 2 * same_place_pixels) g.pixel_aspect = aspect;
  g.centre = {(grid.reference_pixel.column - g.centre_column()) * g.cell_rad,
              (g.centre_row() - grid.reference_pixel.row) * g.cell_height_rad()};
  if (frame != "ICRS" && frame != "FK5" && frame != "FK4") {
    upright.difference = "its directions are in " + frame + "; expected ICRS, FK5 (J2000) or FK4 (B1950)";
    return upright;
  }
  const double turned = turned_away(grid, g), bent = bent_away(grid, g);
  upright.off_pixels = turned + bent;
  if (!(upright.off_pixels > rounding)) return upright;
  if (turned >= std::min(bent, same_place_pixels))
    upright.difference = turned_in_words(grid) + "; expected square pixels with north up and east on the left";
  else if (grid.projection != Projection::sin)
    upright.difference = "its projection is " + projection_name(grid.projection) + "; expected SIN";
  else
    upright.difference = "its SIN projection is slanted by " + six_digits(grid.slant[0]) + ", " + six_digits(grid.slant[1]) +
                         " (PV2_1 and PV2_2, or NCP); expected SIN without slant";
  return upright;
}

ImageGeometry geometry_on(const std::optional<SkyGrid>& grid, Grids wanted, const ImageGeometry& size) {
  if (wanted == Grids::any) return {size.width, size.height, 0, {}};
  if (!grid)
    throw std::invalid_argument(
        "it does not say where its pixels lie on the sky; expected right ascension and declination, in SIN");
  UprightGeometry upright = upright_geometry(*grid);
  if (!(upright.off_pixels < same_place_pixels))
    throw std::invalid_argument(upright.difference + "; regrid it first, as with CASA's imregrid");
  return upright.geometry;
}

FrameRotation rotation_between(const std::array<SkyDirection, 2>& from, const std::array<SkyDirection, 2>& to) {
  const auto axes = [](const std::array<SkyDirection, 2>& pair) {
    const Eigen::Vector3d first = axes_at(pair[0]).row(2), second = axes_at(pair[1]).row(2);
    const Eigen::Vector3d side = first.cross(second).normalized();
    Turn all;
    all << first.transpose(), side.transpose(), first.cross(side).transpose();
    return all;
  };
  return rotation_of(axes(to).transpose() * axes(from));
}

GridMap::GridMap(const ImageGeometry& image, const SkyGrid& grid, const FrameRotation& rotation)
    : image_(image), grid_(grid), inverse_(inverse_of(grid.step)) {
  const Turn between = Eigen::Map<const Turn>(rotation[0].data());
  turn_ = rotation_of(axes_at(grid.reference) * between * axes_at(image.phase_centre).transpose());
}

PixelPlace GridMap::operator()(int row, int column) const {
  const DirectionCosines at = image_.at(row, column);
  const double n_there = 1 + n_minus_1(at);  // NaN beyond the horizon
  const auto along = [&](std::size_t axis) { return turn_[axis][0] * at.l + turn_[axis][1] * at.m + turn_[axis][2] * n_there; };
  const double n = along(2);
  if (!reaches(grid_.projection, n)) {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    return {none, none};
  }
  const Plane point = projected(grid_, along(0), along(1), n);
  return {grid_.reference_pixel.column + inverse_[0][0] * point[0] + inverse_[0][1] * point[1],
          grid_.reference_pixel.row + inverse_[1][0] * point[0] + inverse_[1][1] * point[1]};
}

}  // namespace misfit::imager
