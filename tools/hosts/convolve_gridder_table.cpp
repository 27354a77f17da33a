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
  if (file.kernel.width() > casacore_cells)
    throw std::runtime_error("kernel table " + kernel_table.string() + " has W = " + std::to_string(file.kernel.width()) +
                             "; casacore's ConvolveGridder takes at most " + std::to_string(casacore_cells));
  if (!per_cell && !file.sampling)
    throw std::runtime_error("kernel table " + kernel_table.string() +
                             " has no table CONVFUNC; expected one, or entries a cell");
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
