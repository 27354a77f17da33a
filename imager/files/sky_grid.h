#pragma once

#include <array>
#include <optional>
#include <string>

#include "imager/data/geometry.h"

namespace misfit::imager {

/// Zenithal projections (Calabretta & Greisen 2002, A&A 395, 1077, section 5.1). A direction at the angle ψ from the reference
/// lies R(ψ) from the reference in the plane of projection: SIN sin ψ, TAN tan ψ, STG 2 tan(ψ/2), ARC ψ, ZEA 2 sin(ψ/2).
enum class Projection { sin, tan, stg, arc, zea };

/// FITS's three letters for a projection: "SIN".
std::string projection_name(Projection projection);
/// None where the letters stand for another projection.
std::optional<Projection> projection_named(const std::string& letters);

/// A place among pixels, as fractions of them counted from 0; NaN where there is none.
struct PixelPlace {
  double column = 0;
  double row = 0;
};

/// Where the pixels of an image lie on the sky, as its file states it. Pixel (column, row) is the point
///     (x, y) = step · (column − reference_pixel.column, row − reference_pixel.row)
/// of the plane of projection, x to the east and y to the north of `reference`, rad; the projection maps directions to it. An
/// ImageGeometry is the grid in SIN whose step is (−cell, 0; 0, cell · aspect).
struct SkyGrid {
  int width = 0;
  int height = 0;
  Projection projection = Projection::sin;
  SkyDirection reference;  ///< CRVAL; the frame may also be "GALACTIC", with longitude and latitude
  PixelPlace reference_pixel;
  std::array<std::array<double, 2>, 2>
      step{};  ///< [x, y][per column, per row], rad: CDELT, PC or CD, CROTA and LONPOLE together
  /// (ξ, η) of a slanted SIN projection, in x and y: a direction with cosines l, m, n lies at (l, m) + slant · (1 − n)
  /// (equation 61). NCP of the declination δ is the slant (0, cot δ).
  std::array<double, 2> slant{};

  double column_step_rad() const { return std::hypot(step[0][0], step[1][0]); }
  double row_step_rad() const { return std::hypot(step[0][1], step[1][1]); }
  /// The position angle of the direction in which rows count up, from north through east.
  double position_angle_rad() const { return std::atan2(step[0][1], step[1][1]); }
  /// True if the sky is seen as from outside, with east on the right where north is up.
  bool is_mirrored() const { return step[0][0] * step[1][1] - step[0][1] * step[1][0] > 0; }
  /// True if pixels have an area, and the farthest of them a finite place.
  bool is_regular() const;
};

/// Turns the step and the slant of a grid whose native longitude φ of the celestial pole (LONPOLE) is not 180 degrees to
/// SkyGrid's east and north. Before the turn the pole lies towards (sin φ, −cos φ) (equations 12 and 13).
void set_pole(SkyGrid& grid, double longitude_rad);

/// The grid of an image's pixels.
SkyGrid grid_of(const ImageGeometry& geometry);

/// The farthest, in pixels, that pixels of a grid may lie from their places in an upright geometry that stands for it. The
/// effect on predicted visibilities depends on the length of baselines.
inline constexpr double same_place_pixels = 1e-3;

/// The nearest that an ImageGeometry in ICRS, FK5 or FK4 comes to a grid: it has the grid's reference and its steps along
/// columns and rows, in SIN, north up and east on the left.
struct UprightGeometry {
  ImageGeometry geometry;
  double off_pixels = 0;   ///< largest distance of a pixel from its place in the geometry; infinite where they are not alike
  std::string difference;  ///< the main difference of the grid, and what was expected; empty where pixels agree
};
UprightGeometry upright_geometry(const SkyGrid& grid);

/// The images that are opened: images whose pixels an ImageGeometry describes, or images on any grid or none, whose header's
/// geometry holds their size alone.
enum class Grids { upright, any };

/// The geometry of an image of this size on this grid, to same_place_pixels, or its size alone where any grid will do. Throws
/// std::invalid_argument that says what the grid has and what was expected.
ImageGeometry geometry_on(const std::optional<SkyGrid>& grid, Grids wanted, const ImageGeometry& size);

/// A turn of the sphere that takes the unit vectors of one frame, (cos dec cos ra, cos dec sin ra, sin dec), to those of
/// another.
using FrameRotation = std::array<std::array<double, 3>, 3>;

/// The turn that takes one pair of directions to another pair as far apart; exactly the first, and the second as near as a turn
/// can.
FrameRotation rotation_between(const std::array<SkyDirection, 2>& from, const std::array<SkyDirection, 2>& to);

/// Where the pixels of an image lie among the pixels of a grid.
class GridMap {
 public:
  /// `rotation`: from the frame of the image to that of the grid.
  GridMap(const ImageGeometry& image, const SkyGrid& grid, const FrameRotation& rotation = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}});

  /// The place in the grid of a pixel of the image; NaN beyond the image's horizon, and where the grid's projection does not
  /// reach.
  PixelPlace operator()(int row, int column) const;

 private:
  ImageGeometry image_;
  SkyGrid grid_;
  FrameRotation turn_;                            ///< from (l, m, n) about the image's phase centre to the grid's reference
  std::array<std::array<double, 2>, 2> inverse_;  ///< of the grid's step
};

}  // namespace misfit::imager
