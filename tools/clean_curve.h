#pragma once

#include <string>
#include <vector>

namespace misfit::tools {

/// The state after a major cycle.
struct CurvePoint {
  double iterations = 0;  ///< in all so far
  double peak_jy = 0;     ///< magnitude of the largest residual
};

/// The peak residual, on a log scale, against the iterations, as an SVG element for an HTML page; empty when there are fewer
/// than three points to draw or they are all the same.
std::string clean_curve(std::vector<CurvePoint> points);

}  // namespace misfit::tools
