#pragma once

#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

namespace misfit::tools {

/// A curve: y over x, of one length. Values that are not finite, or not positive on a logarithmic axis, leave a gap.
struct Series {
  std::string label;  ///< for the legend, unlike all others of the figure
  std::vector<double> x;
  std::vector<double> y;
  bool points = false;   ///< marks at its points
  bool line = true;      ///< a line through them
  bool law = false;      ///< thin, dashed and black: theory for the series around it
  bool columns = false;  ///< in place of both: filled, from the axis up, side by side about evenly spaced x
};

struct Axis {
  std::string label;
  bool logarithmic = false;
  std::optional<double> from{};  ///< nothing: chosen by the data
  std::optional<double> to{};
};

/// A figure with the numbers behind it. All text is plain UTF-8.
struct Figure {
  std::string name;  ///< stem of its files: letters, digits and hyphens
  std::string title;
  std::string caption;
  Axis x;
  Axis y;
  std::vector<Series> series;
  /// The drawing's size, in units of 1/15 of a line of text. Where 760 units are the 18 cm of a printed page, a line is 10
  /// points, and a page holds two figures of this height.
  int width = 760;
  int height = 430;
};

/// The figure as an SVG element, drawn by gnuplot: curves differ in colour and in dashes or marks, the legend lies outside the
/// axes. Ids in it begin with the figure's name. Throws
/// std::logic_error for a figure without a point to draw, with labels that repeat or series of unequal lengths;
/// std::runtime_error where gnuplot is not installed or fails.
std::string draw_svg(const Figure& figure);

/// "series,x,y" and a line for each point, with as many digits as doubles need.
std::string figure_csv(const Figure& figure);

/// {name, title, caption, x: {label, logarithmic}, y, series: [{label, x, y}]}.
nlohmann::json figure_json(const Figure& figure);

}  // namespace misfit::tools
