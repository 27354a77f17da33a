#include "tools/hosts/casacore_table.h"

#include <cmath>
#include <cstdlib>
#include <stdexcept>
#include <string>

#include "kernels/kernel_table.h"
#include "kernels/sampled_function.h"

namespace misfit::hosts {

Eigen::VectorXd casacore_table(const kernels::PiecewisePolynomial& function, int per_cell) {
  const int width = function.width();
  if (width > casacore_cells)
    throw std::invalid_argument("kernel width " + std::to_string(width) + " for a table of casacore's; expected at most " +
                                std::to_string(casacore_cells));
  if (per_cell < 1 || per_cell > kernels::kernel_table_max_per_cell)
    throw std::invalid_argument(std::to_string(per_cell) + " entries a cell; expected 1 to " +
                                std::to_string(kernels::kernel_table_max_per_cell));
  const Eigen::VectorXd inside = kernels::sampled_function(function, per_cell);
  Eigen::VectorXd table = Eigen::VectorXd::Zero((casacore_support + 1) * Eigen::Index{per_cell});
  table.head(inside.size()) = inside;
  const bool ends_on_an_entry = width * per_cell % 2 == 0;
  if (ends_on_an_entry && width < casacore_cells) table[inside.size() - 1] /= 2;
  return table;
}

kernels::TapFunction casacore_taps(const Eigen::VectorXd& table, int per_cell) {
  return [table, per_cell](double t) {
    const long shift = std::lround(-t * per_cell);
    Eigen::VectorXd taps(casacore_cells);
    for (int r = 0; r < casacore_cells; ++r) taps[r] = table[std::labs((r - casacore_support) * long{per_cell} + shift)];
    return Eigen::VectorXd(taps / taps.sum());
  };
}

}  // namespace misfit::hosts
