#include "tools/hosts/convolve_gridder_table.h"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "kernels/kernel_table.h"
#include "tools/hosts/casacore_table.h"
#include "tools/hosts/image_divisor_internal.h"

namespace misfit::hosts {

using casacore::Complex;
using casacore::Double;

ConvolveGridderTable::ConvolveGridderTable(const std::filesystem::path& kernel_table, const casacore::IPosition& grid_shape,
                                           const casacore::Vector<Double>& cells_per_unit,
                                           const casacore::Vector<Double>& origin_cell, std::optional<int> per_cell)
    : ConvolveGridder<Double, Complex>(grid_shape, cells_per_unit, origin_cell, "SF") {
  const kernels::KernelTable file = kernels::read_intact_kernel_table(kernel_table);
  const auto refuse = [&](const std::string& why) { throw std::runtime_error("kernel table " + kernel_table.string() + why); };
  if (file.kernel.width() > casacore_cells)
    refuse(" has W = " + std::to_string(file.kernel.width()) + "; casacore's ConvolveGridder takes at most " +
           std::to_string(casacore_cells) + ", and CasacoreGridder any");
  if (!per_cell && !file.sampling)
    refuse(" has no table CONVFUNC; expected a file by misfit kernel --emit casacore, or entries a cell");
  if (!per_cell && file.sampling->interpolation != 0)
    refuse(
        " has a table to be interpolated, and casacore takes the nearest entry; expected a file by misfit kernel --emit "
        "casacore, or entries a cell");
  if (grid_shape.size() != 2 || cells_per_unit.size() != 2 || origin_cell.size() != 2)
    throw std::invalid_argument("a grid of " + std::to_string(grid_shape.size()) + " axes with " +
                                std::to_string(cells_per_unit.size()) + " scales and " + std::to_string(origin_cell.size()) +
                                " offsets; expected 2 of each");
  cSampling() = per_cell ? *per_cell : file.sampling->per_cell;
  table_ = casacore_table(file.kernel.polynomial, cSampling());
  cFunction().resize(static_cast<std::size_t>(table_.size()));
  std::copy(table_.begin(), table_.end(), cFunction().begin());
  cSupport() = casacore_support;
  fillCorrectionVectors();
}

Complex ConvolveGridderTable::correctionFactor1D(casacore::Int pixel, casacore::Int len) {
  // casacore's constructor never comes here: it calls its own.
  if (divisor_.size() != len) divisor_ = image_divisor(casacore_taps(table_, cSampling()), len, cSampling());
  return {static_cast<float>(divisor_[pixel]), 0};
}

}  // namespace misfit::hosts
