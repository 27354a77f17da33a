#include "tools/emit/nearest_entries.h"

#include <cmath>
#include <cstdlib>

#include "kernels/sampled_function.h"

namespace misfit::tools {

Eigen::VectorXd half_table(const kernels::PiecewisePolynomial& function, int per_cell) {
  Eigen::VectorXd table = kernels::sampled_function(function, per_cell);
  if (function.width() * per_cell % 2 == 0) table[table.size() - 1] /= 2;  // else no entry lies at W/2
  return table;
}

kernels::TapFunction nearest_entries(const Eigen::VectorXd& table, int per_cell, int support) {
  return [=](double t) {
    Eigen::VectorXd taps = Eigen::VectorXd::Zero(2 * support + 1);
    const long off = std::lround(t * per_cell);
    for (int r = 0; r <= 2 * support; ++r) {
      const long entry = std::labs(static_cast<long>(r - support) * per_cell - off);
      if (entry < table.size()) taps[r] = table[entry];
    }
    return taps;
  };
}

}  // namespace misfit::tools
