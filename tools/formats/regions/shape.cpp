#include "tools/formats/regions/shape.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "imager/numerics/constants.h"

namespace misfit::tools::regions {
namespace {

constexpr double on_border = 1e-6;  ///< pixels

/// An interval of numbers, both ends included; empty where first > last.
struct Interval {
  double first = 0;
  double last = 0;
};

/// The rows that an outline may reach.
Interval rows_of(const Ellipse& e) {
  const double reach = std::hypot(e.x_radius * std::sin(e.turn_rad), e.y_radius * std::cos(e.turn_rad)) + on_border;
  return {e.centre.row - reach, e.centre.row + reach};
}

Interval rows_of(const Polygon& p) {
  const auto [low, high] =
      std::minmax_element(p.corners.begin(), p.corners.end(), [](const Point& a, const Point& b) { return a.row < b.row; });
  return {low->row - on_border, high->row + on_border};
}

/// The columns of a row within an ellipse: those where a x² + 2 b x + c ≤ 1, x from the centre.
std::vector<Interval> columns_of(const Ellipse& e, double row) {
  const double sine = std::sin(e.turn_rad), cosine = std::cos(e.turn_rad), y = row - e.centre.row;
  const double p = std::pow(e.x_radius + on_border, -2), q = std::pow(e.y_radius + on_border, -2);
  const double a = p * cosine * cosine + q * sine * sine, b = y * sine * cosine * (p - q);
  const double c = y * y * (p * sine * sine + q * cosine * cosine);
  const double root = std::sqrt(b * b - a * (c - 1));
  if (std::isnan(root)) return {};
  return {{e.centre.column + (-b - root) / a, e.centre.column + (-b + root) / a}};
}

/// The columns along a line of constant row where the winding number of a polygon is not 0, and the sides that lie along the
/// line.
std::vector<Interval> crossed_columns(const Polygon& p, double row) {
  std::vector<Interval> found;
  std::vector<std::pair<double, int>> crossings;  // columns, and whether the side goes up or down
  Point from = p.corners.back();
  for (const Point& to : p.corners) {
    if (std::max(std::abs(from.row - row), std::abs(to.row - row)) <= on_border)
      found.push_back({std::min(from.column, to.column), std::max(from.column, to.column)});
    if ((from.row <= row) != (to.row <= row))
      crossings.emplace_back(from.column + (row - from.row) / (to.row - from.row) * (to.column - from.column),
                             to.row > from.row ? 1 : -1);
    from = to;
  }
  std::sort(crossings.begin(), crossings.end());
  int winding = 0;
  double begin = 0;
  for (const auto& [column, step] : crossings) {
    if (winding == 0) begin = column;
    winding += step;
    if (winding == 0) found.push_back({begin, column});
  }
  return found;
}

/// The columns of a row within a polygon; columns on lines a millionth of a pixel below and above the row count, too.
std::vector<Interval> columns_of(const Polygon& p, double row) {
  std::vector<Interval> found;
  for (const double line : {row - on_border, row, row + on_border})
    for (const Interval& columns : crossed_columns(p, line))
      found.push_back({columns.first - on_border, columns.last + on_border});
  return found;
}

/// The whole numbers from 0 to size − 1 in an interval.
std::pair<int, int> pixels_in(const Interval& interval, int size) {
  return {static_cast<int>(std::ceil(std::clamp(interval.first, 0.0, 1.0 * size))),
          static_cast<int>(std::floor(std::clamp(interval.last, -1.0, size - 1.0)))};
}

/// Sets the columns of a row that the outline holds.
void set_columns(const Outline& outline, int row, bool value, std::vector<bool>& columns) {
  const auto intervals = std::visit([&](const auto& o) { return columns_of(o, row); }, outline);
  for (const Interval& interval : intervals) {
    const auto [first, last] = pixels_in(interval, static_cast<int>(columns.size()));
    for (int c = first; c <= last; ++c) columns[static_cast<std::size_t>(c)] = value;
  }
}

bool holds(const Sector& sector, int column, int row) {
  const double x = column - sector.centre.column, y = row - sector.centre.row, turn = 2 * imager::pi;
  const auto beside = [&](double border_rad) {  // the border that lies in this direction
    const double c = std::cos(border_rad), s = std::sin(border_rad);
    return std::abs(y * c - x * s) <= on_border && x * c + y * s >= -on_border;
  };
  const double past_rad = std::fmod(std::fmod(std::atan2(y, x) - sector.from_rad, turn) + turn, turn);
  return past_rad <= sector.span_rad || beside(sector.from_rad) || beside(sector.from_rad + sector.span_rad);
}

}  // namespace

Polygon polygon_of(const Rectangle& r) {
  const double sine = std::sin(r.turn_rad), cosine = std::cos(r.turn_rad);
  Polygon polygon;
  for (const auto& [right, up] : {std::pair(-1, -1), std::pair(1, -1), std::pair(1, 1), std::pair(-1, 1)}) {
    const double x = right * r.width / 2, y = up * r.height / 2;
    polygon.corners.push_back({r.centre.column + x * cosine - y * sine, r.centre.row + x * sine + y * cosine});
  }
  return polygon;
}

Point centre_of(const Shape& shape) {
  if (const auto* ellipse = std::get_if<Ellipse>(&shape.outline)) return ellipse->centre;
  const std::vector<Point>& corners = std::get<Polygon>(shape.outline).corners;
  Point centre;
  for (const Point& corner : corners) {
    centre.column += corner.column / static_cast<double>(corners.size());
    centre.row += corner.row / static_cast<double>(corners.size());
  }
  return centre;
}

void for_each_pixel(const Shape& shape, int width, int height, const std::function<void(int row, int column)>& visit) {
  const Interval rows = std::visit([](const auto& o) { return rows_of(o); }, shape.outline);
  const auto [first, last] = pixels_in(rows, height);
  std::vector<bool> columns(static_cast<std::size_t>(width));
  for (int row = first; row <= last; ++row) {
    columns.assign(columns.size(), false);
    set_columns(shape.outline, row, true, columns);
    if (shape.hole) set_columns(*shape.hole, row, false, columns);
    for (int column = 0; column < width; ++column)
      if (columns[static_cast<std::size_t>(column)] && (!shape.sector || holds(*shape.sector, column, row))) visit(row, column);
  }
}

}  // namespace misfit::tools::regions
