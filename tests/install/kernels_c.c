/* Solves for a kernel in C, looks at it, and is told what is wrong. */
#include <math.h>
#include <string.h>

#include "kernels/c_interface.h"
#include "kernels/kernel_plugin.h"
#include "kernels/version.h"

#if MISFIT_VERSION_NUMBER < 100
#error "the version is older than the first"
#endif

int main(void) {
  const double at[3] = {-0.25, 0, 0.25};
  double taps[3][7], values[3], h[3], error[3], mean = 1;
  int width = 0, r;
  MisfitKernel* kernel = NULL;
  if (misfit_kernel_solve("least-misfit", 21, 0.25, &kernel) != MISFIT_KERNEL_BAD_ARGUMENT || kernel != NULL) return 1;
  if (strstr(misfit_kernel_last_error(), "width 21, expected 1 to 20") == NULL) return 2;
  if (misfit_kernel_solve("least-misfit", 7, 0.25, &kernel) != MISFIT_KERNEL_OK) return 3;
  if (misfit_kernel_width(kernel, &width) != MISFIT_KERNEL_OK || width != 7) return 4;
  if (misfit_kernel_mean_error(kernel, &mean) != MISFIT_KERNEL_OK || !(mean < 1.5e-14)) return 5;
  if (misfit_kernel_taps_at(kernel, at, 3, taps[0]) != MISFIT_KERNEL_OK) return 6;
  for (r = 0; r < 7; ++r)
    if (taps[0][r] != taps[2][6 - r]) return 7; /* C(-u) = C(u) */
  if (misfit_kernel_values(kernel, at, 3, values) != MISFIT_KERNEL_OK || values[1] != taps[1][3]) return 8;
  if (misfit_kernel_correction(kernel, at, 3, h) != MISFIT_KERNEL_OK || fabs(h[1] - 1) > 1e-14) return 9;
  if (misfit_kernel_map_error(kernel, at, 3, error) != MISFIT_KERNEL_OK || !(error[0] < 1e-12)) return 10;
  misfit_kernel_free(kernel);
  return 0;
}
