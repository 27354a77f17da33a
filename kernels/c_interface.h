#ifndef MISFIT_KERNELS_C_INTERFACE_H
#define MISFIT_KERNELS_C_INTERFACE_H

/// Gridding functions for C (C99 or later), and for languages that call C: link libmisfit_kernels_c.
///
///     MisfitKernel* kernel;
///     double taps[7];
///     if (misfit_kernel_solve("least-misfit", 7, 0.25, &kernel) != MISFIT_KERNEL_OK) give_up(misfit_kernel_last_error());
///     misfit_kernel_taps(kernel, 0.3, taps);
///     misfit_kernel_free(kernel);
///
/// A gridding function C(u), u in cells, is symmetric, and 0 beyond |u| = W/2; W, a whole number, is its width. A visibility
/// adds C(s_r − t) of itself to the W cells around it, r = 0 … W−1, where t is its position from the middle of its cell, in
/// cells, and s_r = r − (W−1)/2. The image is multiplied by the correction h(x) along each axis, where x is a pixel's offset
/// from the phase centre over the size of the FFT. The map error ℓ(x) is what then still differs from the exact transform, the
/// square of a relative error in one dimension; kernels/map_error.h has the equations. A function is made for |x| ≤ x0, which
/// is image size / (2 × FFT size), and is scaled so that h(0) = 1.
///
/// - Status: functions that may fail return one. After a failure a kernel asked for is NULL, and other results must not be
///   read. No C++ exception leaves a function, and a null pointer or a number out of its range is MISFIT_KERNEL_BAD_ARGUMENT.
/// - Ownership: a kernel belongs to the caller, from misfit_kernel_solve or misfit_kernel_read to misfit_kernel_free. Arrays
///   are the caller's, and not kept.
/// - Threads: any thread may call any function at any time, also with a kernel that other threads use, as long as none frees it
///   meanwhile. misfit_kernel_read calls CFITSIO: a program whose other threads call it needs a reentrant build of it.
/// - Later versions of libmisfit_kernels_c.so.0 may add functions and statuses, and change no others.

#include <stddef.h>  // NOLINT(modernize-deprecated-headers): C has no other

#if defined(__GNUC__)
#define MISFIT_KERNEL_API __attribute__((visibility("default")))
#else
#define MISFIT_KERNEL_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/// A gridding function.
typedef struct MisfitKernel MisfitKernel;

typedef enum MisfitKernelStatus {
  MISFIT_KERNEL_OK = 0,
  MISFIT_KERNEL_BAD_ARGUMENT = 1,  ///< null, out of range, or no name of a family
  MISFIT_KERNEL_FAILED = 2,        ///< a file cannot be used, or a solution does not converge
  MISFIT_KERNEL_OUT_OF_MEMORY = 3
} MisfitKernelStatus;

/// The reason for this thread's last failure: a line that names the function, the thing, its value and what was expected; ""
/// before any failure. It stays until the next failure in this thread. Each thread has its own line, so that none reads what
/// another writes, and no call takes a buffer. Lines of more than 1023 bytes are cut.
MISFIT_KERNEL_API const char* misfit_kernel_last_error(void);

/// Makes the function of a `family`, "least-misfit", "kaiser-bessel", …, of `width` cells for `x0`. The error for an unknown
/// name lists the families. Most have widths to 20, and all x0 from 0.01 to 0.49. "least-misfit" takes milliseconds at width 7
/// and two seconds at 20, "minimax" ten times as long.
MISFIT_KERNEL_API MisfitKernelStatus misfit_kernel_solve(const char* family, int width, double x0, MisfitKernel** kernel);

/// Reads the function from a kernel-table file, bit for bit as `misfit kernel --output` wrote it (kernels/kernel_table.h). A
/// file whose checksum does not match is not used.
MISFIT_KERNEL_API MisfitKernelStatus misfit_kernel_read(const char* path, MisfitKernel** kernel);

/// Releases the kernel; for NULL it does nothing.
MISFIT_KERNEL_API void misfit_kernel_free(MisfitKernel* kernel);

/// W.
MISFIT_KERNEL_API MisfitKernelStatus misfit_kernel_width(const MisfitKernel* kernel, int* width);
MISFIT_KERNEL_API MisfitKernelStatus misfit_kernel_x0(const MisfitKernel* kernel, double* x0);
/// The family's name. The text is the kernel's, and lasts as long as it.
MISFIT_KERNEL_API MisfitKernelStatus misfit_kernel_name(const MisfitKernel* kernel, const char** name);
/// E, the mean of ℓ over |x| ≤ x0.
MISFIT_KERNEL_API MisfitKernelStatus misfit_kernel_mean_error(const MisfitKernel* kernel, double* mean_error);
/// The largest ℓ over |x| ≤ x0.
MISFIT_KERNEL_API MisfitKernelStatus misfit_kernel_max_error(const MisfitKernel* kernel, double* max_error);

/// The W values C(s_r − t) at t in [−1/2, 1/2]: taps[r].
MISFIT_KERNEL_API MisfitKernelStatus misfit_kernel_taps(const MisfitKernel* kernel, double t, double* taps);
/// The taps at t[0 … count−1]: taps[i * W + r]. Here and below arrays may be NULL where `count` is 0.
MISFIT_KERNEL_API MisfitKernelStatus misfit_kernel_taps_at(const MisfitKernel* kernel, const double* t, size_t count,
                                                           double* taps);

/// C(u[i]) at any finite u, for i = 0 … count−1. Where C jumps, between two cells, it is the mean of both sides, and at |u| =
/// W/2 the limit from inside.
MISFIT_KERNEL_API MisfitKernelStatus misfit_kernel_values(const MisfitKernel* kernel, const double* u, size_t count,
                                                          double* values);

/// The correction that makes ℓ smallest at every x: h(x[i]), for x in [−1/2, 1/2] and i = 0 … count−1.
MISFIT_KERNEL_API MisfitKernelStatus misfit_kernel_correction(const MisfitKernel* kernel, const double* x, size_t count,
                                                              double* h);

/// ℓ(x[i]) with that correction, for x in [−1/2, 1/2] and i = 0 … count−1.
MISFIT_KERNEL_API MisfitKernelStatus misfit_kernel_map_error(const MisfitKernel* kernel, const double* x, size_t count,
                                                             double* error);

#ifdef __cplusplus
}
#endif

#endif
