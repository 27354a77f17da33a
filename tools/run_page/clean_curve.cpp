#include "tools/run_page/clean_curve.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iomanip>
#include <sstream>

#include "tools/base/numbers.h"
#include "tools/drawing/ticks.h"

namespace misfit::tools {
namespace {

constexpr double left = 84, right = 504;
constexpr double residual_top = 64, residual_bottom = 286;
constexpr double flux_top = 312, flux_bottom = 436;

std::string with_prefix(double value, const std::string& base, int digits) {
  const ScaledUnit unit = scaled_unit(value, base);
  return significant(value / unit.size, digits) + "\u00a0" + unit.name;
}

std::string decimal(double coordinate) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(1) << coordinate;
  return text.str();
}

bool can_show(double value, bool logarithmic) {
  return std::isfinite(value) && (!logarithmic || value > 0);
}

/// Values from `low` to `high` on a line from pixel `from` to pixel `to`.
struct Scale {
  double low, high, from, to;
  bool logarithmic = false;

  double operator()(double value) const {
    const double part = logarithmic ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
    return from + part * (to - from);
  }
  bool shows(double value) const { return can_show(value, logarithmic); }
};

using Member = double CurvePoint::*;

/// The smallest and the largest of some members, of those that a scale can show.
struct Range {
  double low = HUGE_VAL, high = -HUGE_VAL;

  Range(const std::vector<CurvePoint>& points, const std::vector<Member>& members, bool logarithmic) {
    for (const CurvePoint& point : points)
      for (const Member member : members)
        if (can_show(point.*member, logarithmic)) {
          low = std::min(low, point.*member);
          high = std::max(high, point.*member);
        }
  }
};

std::string text(const std::string& kind, double x, double y, const std::string& content) {
  return "<text class=\"" + kind + "\" x=\"" + decimal(x) + "\" y=\"" + decimal(y) + "\">" + content + "</text>";
}

std::string across(const std::string& content, double y) {
  return "<text class=\"middle\" transform=\"translate(14 " + decimal(y) + ") rotate(-90)\">" + content + "</text>";
}

std::string line(const std::string& kind, const std::string& points) {
  return points.empty() ? "" : "<polyline class=\"" + kind + "\" points=\"" + points + "\"></polyline>";
}

void append_point(std::string& path, double x, double y) {
  if (!path.empty()) path += ' ';
  path.append(decimal(x)).append(",").append(decimal(y));
}

std::string path_of(const std::vector<CurvePoint>& points, const Scale& x, const Scale& y, Member member) {
  std::string path;
  for (const CurvePoint& point : points)
    if (y.shows(point.*member)) append_point(path, x(point.iterations), y(point.*member));
  return path;
}

/// Level through each cycle, from its first iteration to its last.
std::string steps_of(const std::vector<CurvePoint>& points, const Scale& x, const Scale& y, Member member) {
  std::string path;
  for (std::size_t k = 1; k < points.size(); ++k) {
    if (!y.shows(points[k].*member)) continue;
    const double level = y(points[k].*member);
    append_point(path, x(points[k - 1].iterations), level);
    append_point(path, x(points[k].iterations), level);
  }
  return path;
}

std::string dots(const std::vector<CurvePoint>& points, const Scale& x, const Scale& y, Member member) {
  const bool flux = member == &CurvePoint::flux_jy;
  std::string marks;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const CurvePoint& point = points[k];
    if (!y.shows(point.*member)) continue;
    marks += "<circle cx=\"" + decimal(x(point.iterations)) + "\" cy=\"" + decimal(y(point.*member)) + "\" r=\"3\"" +
             (flux ? " class=\"flux\"" : "") + "><title>" + (k == 0 ? "start" : "cycle " + std::to_string(k)) + ", " +
             grouped(std::llround(point.iterations)) +
             " iterations: " + with_prefix(point.*member, flux ? "Jy" : "Jy/beam", 4) + "</title></circle>";
  }
  return marks;
}

/// The lines of a grid, each with its `label`.
std::string horizontal_grid(const Scale& y, const std::vector<double>& values,
                            const std::function<std::string(double value)>& label) {
  std::string grid;
  for (const double value : values)
    grid += "<path class=\"grid\" d=\"M" + decimal(left) + " " + decimal(y(value)) + "H" + decimal(right) + "\"></path>" +
            text("end", left - 7, y(value) + 4, label(value));
  return grid;
}

std::string vertical_grid(const Scale& x) {
  std::string grid;
  for (const double value : linear_ticks(x.low, x.high, 5)) {
    for (const auto& [top, bottom] : {std::pair{residual_top, residual_bottom}, std::pair{flux_top, flux_bottom}})
      grid += "<path class=\"grid\" d=\"M" + decimal(x(value)) + " " + decimal(top) + "V" + decimal(bottom) + "\"></path>";
    grid += text("middle", x(value), flux_bottom + 18, grouped(std::llround(value)));
  }
  return grid;
}

std::string legend_entry(const std::string& kind, double x, const std::string& name) {
  return line(kind, decimal(x) + ",44 " + decimal(x + 26) + ",44") + text("", x + 33, 48, name);
}

std::string residual_panel(const std::vector<CurvePoint>& points, const Scale& x) {
  const Range range(points, {&CurvePoint::peak_jy, &CurvePoint::noise_jy, &CurvePoint::depth_jy}, true);
  const Scale y{range.low / 1.2, range.high * 1.2, residual_bottom, residual_top, true};
  return horizontal_grid(y, logarithmic_ticks(y.low, y.high), [](double value) { return with_prefix(value, "Jy", 1); }) +
         across("residual, per beam", (residual_top + residual_bottom) / 2) + legend_entry("peak", left, "peak residual") +
         legend_entry("noise", left + 138, "noise") + legend_entry("depth", left + 236, "depth of a cycle") +
         line("depth", steps_of(points, x, y, &CurvePoint::depth_jy)) +
         line("noise", path_of(points, x, y, &CurvePoint::noise_jy)) +
         line("peak", path_of(points, x, y, &CurvePoint::peak_jy)) + dots(points, x, y, &CurvePoint::peak_jy);
}

std::string flux_panel(const std::vector<CurvePoint>& points, const Scale& x) {
  const Range range(points, {&CurvePoint::flux_jy}, false);
  const double low = std::min(0.0, range.low), high = std::max(0.0, range.high);
  const double reach = high > low ? high - low : 1;
  const ScaledUnit unit = scaled_unit(std::max(high, -low), "Jy");
  const Scale y{low < 0 ? low - 0.08 * reach : 0, low + 1.08 * reach, flux_bottom, flux_top};
  const auto label = [&](double value) { return significant(value / unit.size, 3); };
  return horizontal_grid(y, linear_ticks(y.low, y.high, 4), label) +
         across("model flux, " + unit.name, (flux_top + flux_bottom) / 2) +
         line("flux", path_of(points, x, y, &CurvePoint::flux_jy)) + dots(points, x, y, &CurvePoint::flux_jy);
}

/// The curves in words, for those who cannot see them.
std::string in_words(const CurvePoint& first, const CurvePoint& last) {
  const bool flux_known = std::isfinite(first.flux_jy) && std::isfinite(last.flux_jy);
  return "From " + grouped(std::llround(first.iterations)) + " to " + grouped(std::llround(last.iterations)) +
         " iterations the peak residual went from " + with_prefix(first.peak_jy, "Jy/beam", 3) + " to " +
         with_prefix(last.peak_jy, "Jy/beam", 3) +
         (flux_known
              ? ", the model’s flux from " + with_prefix(first.flux_jy, "Jy", 3) + " to " + with_prefix(last.flux_jy, "Jy", 3)
              : "") +
         ".";
}

}  // namespace

std::string clean_curve(const std::vector<CurvePoint>& points) {
  std::vector<CurvePoint> known;
  for (const CurvePoint& point : points)
    if (point.peak_jy > 0 && std::isfinite(point.peak_jy)) known.push_back(point);
  if (known.empty() || known.back().iterations <= known.front().iterations) return "";
  const Scale x{0, known.back().iterations, left, right};
  return "<svg class=\"curve\" viewBox=\"0 0 520 487\" role=\"img\" aria-label=\"" + in_words(known.front(), known.back()) +
         "\">" + text("title", left, 26, "Progress of CLEAN") + vertical_grid(x) + residual_panel(known, x) +
         flux_panel(known, x) + text("middle", (left + right) / 2, flux_bottom + 40, "iterations") + "</svg>\n";
}

}  // namespace misfit::tools
