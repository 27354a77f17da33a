#include "tools/clean_curve.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "tools/numbers.h"

namespace misfit::tools {
namespace {

std::string flux(double value_jy) {
  const ScaledUnit unit = scaled_unit(value_jy, "Jy/beam");
  return significant(value_jy / unit.size, 3) + " " + unit.name;
}

}  // namespace

std::string clean_curve(std::vector<CurvePoint> points) {
  std::erase_if(points, [](const CurvePoint& point) { return !(point.peak_jy > 0) || !std::isfinite(point.peak_jy); });
  if (points.size() < 3 || points.back().iterations <= 0) return "";
  const auto [lowest, highest] = std::minmax_element(
      points.begin(), points.end(), [](const CurvePoint& a, const CurvePoint& b) { return a.peak_jy < b.peak_jy; });
  const double low = lowest->peak_jy;
  const double high = highest->peak_jy;
  if (!(high > low)) return "";

  std::ostringstream line;
  std::ostringstream dots;
  line.precision(4);
  dots.precision(4);
  for (const CurvePoint& point : points) {
    const double x = 10 + 380 * point.iterations / points.back().iterations;
    const double y = 24 + 100 * std::log(high / point.peak_jy) / std::log(high / low);
    line << x << ',' << y << ' ';
    dots << "<circle cx=\"" << x << "\" cy=\"" << y << "\" r=\"3.5\"></circle>";
  }
  return "<svg class=\"curve\" viewBox=\"0 0 400 160\" role=\"img\" aria-label=\"Peak residual against iterations\">"
         "<path d=\"M10 14V134H394\"></path><polyline points=\"" +
         line.str() + "\"></polyline>" + dots.str() + "<text x=\"18\" y=\"16\">" + flux(high) +
         "</text><text x=\"18\" y=\"128\">" + flux(low) + "</text><text x=\"392\" y=\"152\" text-anchor=\"end\">" +
         grouped(std::llround(points.back().iterations)) +
         " iterations</text><text x=\"10\" y=\"152\">peak residual, log scale</text></svg>\n";
}

}  // namespace misfit::tools
