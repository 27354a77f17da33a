#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "tools/drawing/stretch.h"

namespace misfit::tools {

/// The longer side of what a picture shows, screen pixels.
inline constexpr int picture_side = 640;

/// A picture's measures, screen pixels: a plot with a title above, axes to its left and below and a colour bar to its right.
/// All pictures are equally wide, so that type is equally large wherever they are shown.
struct PictureLayout {
  int plot_width = picture_side;
  int plot_height = picture_side;
  int width = 0;
  int height = 0;

  /// The layout of a plot whose sides have the ratio across : up.
  PictureLayout(int across, int up);

  double x(double from_left) const { return from_left / width; }     ///< gnuplot's screen coordinate
  double y(double from_top) const { return 1 - from_top / height; }  ///< the same
};

struct PlotAxis {
  char name = 'x';
  std::string label;
  double from = 0;
  double to = 1;
};

/// Colours for values between `low` and `high`, in gnuplot's syntax, and the words below the bar.
struct ColourBar {
  std::string palette;
  double low = 0;
  double high = 1;
  std::vector<Tick> ticks;
  std::vector<std::string> notes;
};

/// The beginning of a script that leaves the picture in "png".
void write_beginning(std::ostream& script, const PictureLayout& layout);
/// A title and two lines about it.
void write_titles(std::ostream& script, const PictureLayout& layout, const std::vector<std::string>& lines);
void write_axes(std::ostream& script, const PictureLayout& layout, const PlotAxis& x, const PlotAxis& y);
void write_colour_bar(std::ostream& script, const PictureLayout& layout, const ColourBar& bar);

}  // namespace misfit::tools
