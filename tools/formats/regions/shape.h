#pragma once

#include <functional>
#include <optional>
#include <variant>
#include <vector>

namespace misfit::tools::regions {

/// A point of an image's plane, in pixels; the first pixel's centre is 0, 0. Columns run to the right, rows upwards.
struct Point {
  double column = 0;
  double row = 0;
};

/// (x / x_radius)² + (y / y_radius)² ≤ 1, with x and y from the centre along axes that are turned anticlockwise by `turn_rad`
/// from columns and rows.
struct Ellipse {
  Point centre;
  double x_radius = 0;  ///< pixels
  double y_radius = 0;  ///< pixels
  double turn_rad = 0;
};

/// The area that closed straight sides go round, once or more often: parts that overlap belong to it, as in CASA.
struct Polygon {
  std::vector<Point> corners;
};

using Outline = std::variant<Ellipse, Polygon>;

/// A rectangle about a centre, turned anticlockwise by `turn_rad`.
struct Rectangle {
  Point centre;
  double width = 0;   ///< pixels
  double height = 0;  ///< pixels
  double turn_rad = 0;
};
Polygon polygon_of(const Rectangle& rectangle);

/// Directions from a centre, anticlockwise from one that is turned by `from_rad` from columns over `span_rad`, at most a whole
/// turn; both borders included.
struct Sector {
  Point centre;
  double from_rad = 0;
  double span_rad = 0;
};

/// An outline without the hole in it and, if there is one, within the sector.
struct Shape {
  Outline outline;
  std::optional<Outline> hole = {};
  std::optional<Sector> sector = {};
};

/// The centre of the outline: a polygon's is the mean of its corners.
Point centre_of(const Shape& shape);

/// Calls `visit` once for each pixel of an image that the shape holds: those whose centres lie within the outline or on it,
/// and not within the hole nor on its border. A centre within a millionth of a pixel of a border lies on it; angles and frames
/// are rounded by less.
void for_each_pixel(const Shape& shape, int width, int height, const std::function<void(int row, int column)>& visit);

}  // namespace misfit::tools::regions
