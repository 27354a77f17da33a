#include "tools/drawing/picture_layout.h"

#include <algorithm>
#include <cmath>
#include <ostream>

#include "tools/drawing/gnuplot.h"
#include "tools/drawing/ticks.h"

namespace misfit::tools {
namespace {

/// The room around the plot, screen pixels. Pages show pictures at about half their size, hence the large type.
constexpr int margin_left = 116;
constexpr int margin_right = 172;
constexpr int margin_top = 130;
constexpr int margin_bottom = 94;
constexpr int least_height = 260;  ///< of the colour bar

/// A line of text at a place on the screen.
struct Label {
  int tag = 0;
  std::string text;
  int from_left = 0;
  int from_top = 0;
  std::string look = "font 'sans,15' tc rgb '#444444'";
};

void write_label(std::ostream& script, const PictureLayout& at, const Label& label) {
  script << "set label " << label.tag << ' ' << gnuplot_quoted(label.text) << " at screen " << at.x(label.from_left)
         << ", screen " << at.y(label.from_top) << ' ' << label.look << '\n';
}

/// Writes an axis with as many marks as `pixels` have room for.
void write_axis(std::ostream& script, const PlotAxis& axis, int pixels) {
  const int marks = std::clamp(pixels / 100, 3, 6);
  script << "set " << axis.name << "label " << gnuplot_quoted(axis.label) << "\nset " << axis.name << "tics "
         << round_step(std::abs(axis.to - axis.from) / marks) << "\nset " << axis.name << "range [" << axis.from << ':'
         << axis.to << "]\n";
}

}  // namespace

PictureLayout::PictureLayout(int across, int up) {
  const double scale = 1.0 * picture_side / std::max(across, up);
  plot_width = std::max(1, static_cast<int>(std::lround(scale * across)));
  plot_height = std::max(1, static_cast<int>(std::lround(scale * up)));
  width = picture_side + margin_left + margin_right;
  height = std::max(plot_height, least_height) + margin_top + margin_bottom;
}

void write_beginning(std::ostream& script, const PictureLayout& layout) {
  script.precision(12);
  script
      << "reset\nset encoding utf8\nset minussign\nset terminal pngcairo noenhanced background rgb 'white' font 'sans,16' size "
      << layout.width << ',' << layout.height << "\nset output 'png'\n";
}

void write_titles(std::ostream& script, const PictureLayout& layout, const std::vector<std::string>& lines) {
  constexpr int from_top[] = {34, 74, 106};
  for (int k = 0; k < static_cast<int>(lines.size()); ++k) {
    Label label{.tag = k + 1, .text = lines[static_cast<std::size_t>(k)], .from_left = margin_left, .from_top = from_top[k]};
    if (k == 0) label.look = "font 'sans:Bold,22'";
    write_label(script, layout, label);
  }
}

void write_axes(std::ostream& script, const PictureLayout& at, const PlotAxis& x, const PlotAxis& y) {
  script << "set lmargin at screen " << at.x(margin_left) << "\nset rmargin at screen " << at.x(margin_left + at.plot_width)
         << "\nset tmargin at screen " << at.y(margin_top) << "\nset bmargin at screen " << at.y(margin_top + at.plot_height)
         << "\nset border lw 1 lc rgb '#444444'\nset tics out nomirror textcolor rgb '#222222'\nunset key\n";
  write_axis(script, x, at.plot_width);
  write_axis(script, y, at.plot_height);
}

void write_colour_bar(std::ostream& script, const PictureLayout& at, const ColourBar& bar) {
  const int left = margin_left + at.plot_width + 20, height = std::max(at.plot_height, least_height);
  script << "set palette maxcolors 1024 defined (" << bar.palette << ")\nset cbrange [" << bar.low << ':' << bar.high
         << "]\nset colorbox user origin " << at.x(left) << ',' << at.y(margin_top + height) << " size " << at.x(28) << ','
         << 1 - at.y(height) << "\nset cbtics (";
  const char* comma = "";
  for (const Tick& tick : bar.ticks) {
    script << comma << gnuplot_quoted(tick.label) << ' ' << tick.value;
    comma = ", ";
  }
  script << ")\n";
  const int beside_last_mark = left + 10;  // of the x axis, whose number may reach beyond the plot
  int tag = 4, below = 28;
  for (const std::string& note : bar.notes) {
    write_label(script, at,
                {.tag = tag++, .text = note, .from_left = beside_last_mark, .from_top = margin_top + height + below});
    below += 26;
  }
}

}  // namespace misfit::tools
