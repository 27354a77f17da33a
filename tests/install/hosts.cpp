// Grids and degrids a visibility as casacore would.
#include <cmath>
#include <cstdio>

#include "kernels/catalogue.h"
#include "kernels/kernel_table.h"
#include "tools/hosts/casacore_gridder.h"
#include "tools/hosts/convolve_gridder_table.h"

/// The visibility 1 put on the grid and taken from there again, which is (Σ C²)² in two dimensions: 0 < … < 1.
bool grids(casacore::Gridder<casacore::Double, casacore::Complex>&& gridder) {
  casacore::Array<casacore::Complex> grid(casacore::IPosition(2, 32, 32), casacore::Complex(0));
  casacore::Complex value;
  const casacore::Vector<double> position(2, 16.3);
  if (!gridder.grid(grid, position, casacore::Complex(1)) || !gridder.degrid(grid, position, value)) return false;
  return value.real() > 0.01 && value.real() < 1 && std::abs(value.imag()) < 1e-6;
}

int main() {
  using namespace misfit;
  const char* const file = "host.fits";
  kernels::write_kernel_table(kernels::kernel_family("least-misfit").make(7, 0.25), kernels::TableSampling{}, file);
  const casacore::IPosition shape(2, 32, 32);
  const casacore::Vector<double> scale(2, 1.0), offset(2, 0.0);
  const bool gridded = grids(hosts::CasacoreGridder(file, shape, scale, offset)) &&
                       grids(hosts::ConvolveGridderTable(file, shape, scale, offset));
  std::remove(file);
  return gridded ? 0 : 1;
}
