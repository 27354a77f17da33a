#include "tools/report/figure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string_view>

#include "tools/base/files.h"
#include "tools/drawing/gnuplot.h"
#include "tools/drawing/ticks.h"
#include "tools/report/data_table.h"
#include "tools/report/html.h"

namespace misfit::tools {
namespace {

constexpr int font_size = 15;
/// Labels up to this many letters go to the right of the axes, longer ones below.
constexpr std::size_t narrow_label = 24;
constexpr int rows_below = 22;  ///< room for a line of the legend below

void check(const Figure& figure) {
  std::set<std::string> labels;
  for (const Series& series : figure.series) {
    if (series.x.size() != series.y.size())
      throw std::logic_error("figure " + figure.name + ": series " + series.label + " has " + std::to_string(series.x.size()) +
                             " x and " + std::to_string(series.y.size()) + " y; expected as many");
    if (!labels.insert(series.label).second)
      throw std::logic_error("figure " + figure.name + " has two series " + series.label + "; expected each label once");
  }
}

bool drawable(double value, const Axis& axis) {
  return std::isfinite(value) && (value > 0 || !axis.logarithmic);
}

/// The series as a block of lines for gnuplot; an empty line breaks the curve. Returns how many points it has.
std::size_t write_data(std::ostream& script, const Figure& figure, std::size_t number) {
  const Series& series = figure.series[number];
  std::size_t points = 0;
  script << "$s" << number << " << EOD\n";
  for (std::size_t k = 0; k < series.x.size(); ++k) {
    const bool shown = drawable(series.x[k], figure.x) && drawable(series.y[k], figure.y);
    if (shown) script << series.x[k] << ' ' << series.y[k];
    script << '\n';
    points += shown ? 1 : 0;
  }
  script << "EOD\n";
  return points;
}

/// True if gnuplot labels every power of ten on a logarithmic axis; where it leaves some out, its finer marks confuse.
bool labels_each_decade(const Axis& axis, const Figure& figure, std::vector<double> Series::*values) {
  constexpr double most_decades = 8;
  if (!axis.logarithmic) return true;
  double low = axis.from.value_or(HUGE_VAL);
  double high = axis.to.value_or(0);
  for (const Series& series : figure.series) {
    for (const double value : series.*values) {
      if (!drawable(value, axis)) continue;
      if (!axis.from) low = std::min(low, value);
      if (!axis.to) high = std::max(high, value);
    }
  }
  return std::log10(high / low) <= most_decades;
}

void script_axis(std::ostream& script, const std::string& name, const Axis& axis) {
  script << "set " << name << "label " << gnuplot_quoted(axis.label) << " noenhanced\n";
  if (axis.logarithmic) script << "set logscale " << name << "\nset format " << name << " '10^{%L}'\n";
  constexpr double few_decades = 100;
  if (axis.logarithmic && axis.from && axis.to && *axis.to / *axis.from < few_decades) {
    std::string ticks;
    for (const double tick : logarithmic_ticks(*axis.from, *axis.to)) ticks += (ticks.empty() ? "" : ", ") + csv_number(tick);
    script << "set format " << name << " '%g'\nset " << name << "tics (" << ticks << ")\n";
  }
  script << "set " << name << "range [";
  if (axis.from) script << *axis.from;
  script << ':';
  if (axis.to) script << *axis.to;
  script << "]\n";
}

/// Colours that stay apart for most colour-blind readers and on a grey printer (Okabe & Ito 2008), darkest first; with the
/// five kinds of dashes 35 lines differ.
std::string line_style(const Series& series, std::size_t number) {
  constexpr std::array<const char*, 7> colour{"#000000", "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"};
  constexpr std::array<const char*, 5> dash{"solid", "(12,4)", "(3,3)", "(12,4,3,4)", "(20,4)"};
  constexpr std::array<int, 7> mark{7, 5, 9, 13, 4, 6, 8};
  std::ostringstream style;
  if (series.law) return "with lines lw 1.2 dt (6,4) lc rgb '#000000'";
  if (series.columns) return "with boxes fill solid noborder lc rgb '#56b4e9'";
  style << "with " << (!series.points ? "lines" : series.line ? "linespoints" : "points");
  const bool marks_alone = series.points && !series.line;  // so marks alone must be visible
  style << " lw " << (series.points && !marks_alone ? 1.2 : 1.8) << " lc rgb '" << colour[number % colour.size()] << "'";
  if (series.points) style << " pt " << mark[number % mark.size()] << " ps " << (marks_alone ? 0.8 : 0.6);
  const char* dashes = dash[number % dash.size()];
  if (series.line) style << " dt " << dashes;
  return style.str();
}

/// The figure's name as the start of an id: gnuplot takes no hyphens there.
std::string id_of(const Figure& figure) {
  std::string id = figure.name;
  std::replace(id.begin(), id.end(), '-', '_');
  return id;
}

void script_legend(std::ostream& script, const Figure& figure) {
  std::size_t longest = 0;
  for (const Series& series : figure.series) {
    const auto letters = std::count_if(series.label.begin(), series.label.end(), [](char c) { return (c & 0xc0) != 0x80; });
    longest = std::max(longest, static_cast<std::size_t>(letters));
  }
  const bool below = longest > narrow_label;
  const auto rows = below ? static_cast<int>(figure.series.size()) : 0;
  script << "set terminal svg enhanced dynamic rounded name " << gnuplot_quoted(id_of(figure)) << " font 'DejaVu Sans,"
         << font_size << "' background rgb 'white' size " << figure.width << ',' << figure.height + rows * rows_below << '\n';
  if (figure.series.size() == 1) {
    script << "unset key\n";
  } else {
    script << "set key noenhanced Left reverse samplen 3.2 spacing 1.15 "
           << (below ? "below vertical maxcols 1\nset xlabel offset 0,0.4\n" : "outside right top vertical\n");
  }
}

std::string script_of(const Figure& figure) {
  std::ostringstream script;
  script.precision(std::numeric_limits<double>::max_digits10);
  script << "set encoding utf8\nset minussign\n";
  script_legend(script, figure);
  script << "set output 'figure.svg'\nset border 3 lw 1 lc rgb '#444444'\nset tics out nomirror textcolor rgb '#222222'\n"
            "set grid lw 0.6 lc rgb '#dddddd' dt solid\n";
  script_axis(script, "x", figure.x);
  script_axis(script, "y", figure.y);
  if (!labels_each_decade(figure.x, figure, &Series::x)) script << "unset mxtics\n";
  if (!labels_each_decade(figure.y, figure, &Series::y)) script << "unset mytics\n";
  std::size_t points = 0;
  for (std::size_t number = 0; number < figure.series.size(); ++number) points += write_data(script, figure, number);
  if (points == 0) throw std::logic_error("figure " + figure.name + " has no point to draw");
  for (const Series& series : figure.series)
    if (series.columns && series.x.size() > 1) script << "set boxwidth " << series.x[1] - series.x[0] << '\n';
  script << "plot ";
  for (std::size_t number = 0; number < figure.series.size(); ++number) {
    const Series& series = figure.series[number];
    script << (number == 0 ? "" : ", ") << "$s" << number << ' ' << line_style(series, number) << " title "
           << gnuplot_quoted(series.label);
  }
  script << "\nunset output\n";
  return script.str();
}

std::string replaced(std::string text, std::string_view from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}

/// gnuplot's file as an element that can stand beside others in one page.
std::string element_of(const std::string& file, const Figure& figure) {
  const std::size_t start = file.find("<svg");
  const std::size_t end = file.rfind("</svg>");
  if (start == std::string::npos || end == std::string::npos)
    throw std::runtime_error("figure " + figure.name +
                             " cannot be drawn: gnuplot could not finish it; expected room on the disk");
  const std::string id = id_of(figure);
  std::string element = file.substr(start, end + 6 - start);
  element = replaced(element, "id='gp", "id='" + id + "_gp");
  element = replaced(element, "#gp", "#" + id + "_gp");
  for (const std::string_view shared : {"gnuplot_canvas", "greybox", "textbox"})
    element = replaced(element, shared, id + "_" + std::string(shared));
  element = replaced(element, "\"DejaVu Sans\"", "\"DejaVu Sans, Verdana, sans-serif\"");
  element = replaced(element, "<title>" + id + "</title>", "<title>" + html_escaped(figure.title) + "</title>");
  return element + "\n";
}

}  // namespace

std::string draw_svg(const Figure& figure) {
  check(figure);
  const WorkFolder work(std::filesystem::temp_directory_path());
  write_file(work.path() / "script", script_of(figure));
  const std::string failure = run_gnuplot(work);
  if (!failure.empty()) throw std::runtime_error("figure " + figure.name + " cannot be drawn: " + failure);
  return element_of(read_file(work.path() / "figure.svg"), figure);
}

std::string figure_csv(const Figure& figure) {
  check(figure);
  std::string text = "series,x,y\n";
  for (const Series& series : figure.series)
    for (std::size_t k = 0; k < series.x.size(); ++k)
      text += csv_field(series.label) + "," + csv_number(series.x[k]) + "," + csv_number(series.y[k]) + "\n";
  return text;
}

nlohmann::json figure_json(const Figure& figure) {
  const auto axis = [](const Axis& a) { return nlohmann::json{{"label", a.label}, {"logarithmic", a.logarithmic}}; };
  nlohmann::json all = nlohmann::json::array();
  for (const Series& series : figure.series) all.push_back({{"label", series.label}, {"x", series.x}, {"y", series.y}});
  return {{"name", figure.name}, {"title", figure.title}, {"caption", figure.caption},
          {"x", axis(figure.x)}, {"y", axis(figure.y)},   {"series", all}};
}

}  // namespace misfit::tools
