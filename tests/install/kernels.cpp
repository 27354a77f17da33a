// Solves for a kernel, and takes it through a file.
#include <cstdio>
#include <string>

#include "kernels/catalogue.h"
#include "kernels/kernel_table.h"
#include "kernels/version.h"

int main() {
  using namespace misfit::kernels;
  const Kernel kernel = kernel_family("least-misfit").make(7, 0.25);
  if (!(kernel.misfit.mean < 1.5e-14)) return 1;
  const char* const file = "kernel.fits";
  write_kernel_table(kernel, TableSampling{}, file);
  const KernelTable table = read_intact_kernel_table(file);
  std::remove(file);
  return table.version == MISFIT_VERSION && table.kernel.misfit.mean == kernel.misfit.mean ? 0 : 2;
}
