#pragma once

#include <string>
#include <vector>

namespace misfit::tools {

/// The state after a major cycle; the first point is the state before all cycles. NaN where it is not known.
struct CurvePoint {
  double iterations = 0;  ///< in all so far
  double peak_jy = 0;     ///< magnitude of the largest residual
  double noise_jy = 0;
  double depth_jy = 0;  ///< how deep its minor cycle was to go
  double flux_jy = 0;   ///< of the model
};

/// Peak residual, noise and depth on a log scale above the model's flux on a linear one, both against the iterations, as an SVG
/// element for an HTML page. Values that are not positive on the log scale, or not finite, are left out; the whole is empty
/// where the peak is known for fewer than two numbers of iterations.
std::string clean_curve(const std::vector<CurvePoint>& points);

}  // namespace misfit::tools
