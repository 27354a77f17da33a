#include "tools/hosts/casacore_table.h"

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
  const Eigen::VectorXd inside = width < casacore_cells ? kernels::sampled_to_both_ends(function, per_cell)
                                                        : kernels::sampled_function(function, per_cell);
  Eigen::VectorXd table = Eigen::VectorXd::Zero((casacore_support + 1) * Eigen::Index{per_cell});
  table.head(inside.size()) = inside;
  return table;
}

kernels::TapFunction casacore_taps(const Eigen::VectorXd& table, int per_cell) {
  return [nearest = kernels::nearest_entries(table, per_cell, casacore_support)](double t) -> Eigen::VectorXd {
    const Eigen::VectorXd taps = nearest(t);
    return taps / taps.sum();
  };
}

}  // namespace misfit::hosts
