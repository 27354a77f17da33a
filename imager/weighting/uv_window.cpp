#include "imager/weighting/uv_window.h"

#include <cmath>

#include "imager/numerics/constants.h"

namespace misfit::imager {
namespace {

double edge(double x, double width) {
  return x < width ? 0.5 * (1 - std::cos(pi * x / width)) : 1;
}

}  // namespace

double UvWindow::factor(double r_lambda) const {
  if (r_lambda < min_lambda || r_lambda > max_lambda) return 0;
  return edge(r_lambda - min_lambda, inner_edge_lambda) * edge(max_lambda - r_lambda, outer_edge_lambda);
}

}  // namespace misfit::imager
