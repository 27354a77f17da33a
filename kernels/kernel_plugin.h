#ifndef MISFIT_KERNEL_PLUGIN_H
#define MISFIT_KERNEL_PLUGIN_H

/// A gridding function in a shared library of its own, in C++ or C. `--kernel hann --kernel-folder DIR` loads
/// DIR/libmisfit_kernel_hann.so and calls its
///
///     extern "C" void register_hann(MisfitKernelPlugin* plugin)   // for a name with hyphens: _ in place of each
///
/// which fills in the struct. tools/hosts/example_kernel has a whole one.
///
/// The function is C(u) for width W and retained fraction 2·x0, symmetric, and 0 beyond W/2. A visibility at u adds
/// C(u − k) of itself to the W cells k nearest to it. The correction h, the error of images and a fast evaluation are derived
/// from it, and its scale does not matter.
/// - C is evaluated inside cells only and stored as one polynomial a cell: it must be smooth inside cells, and may jump or bend
///   where they meet: at whole u for even W, at halves for odd W, where the middle cell is |u| < 1/2.
/// - ∫ C du must be above 0, and all of h(x) over |x| ≤ x0 finite.

/// The version of the interface: of the layout and meaning of MisfitKernelPlugin. Libraries for another version are refused.
#define MISFIT_KERNEL_PLUGIN_VERSION 1

#ifdef __cplusplus
extern "C" {
#endif

/// A library's description of its kernel. All bytes are 0 when register_<name> gets it, and bytes that it has no value for must
/// stay 0. Its pointers must stay valid as long as the program runs. register_<name> may be called more than once. In C++
/// register_<name> and `value` may throw: the user reads what() of a std::exception as an error.
typedef struct MisfitKernelPlugin {
  int version;              ///< MISFIT_KERNEL_PLUGIN_VERSION
  int min_width;            ///< smallest W in cells, 1 or more
  int max_width;            ///< largest W, 20 or less
  int reserved_number;      ///< 0
  double min_x0;            ///< smallest x0 = image size / (2 × FFT size), above 0; 0 stands for 0.01
  double max_x0;            ///< largest, below 1/2; 0 stands for 0.49
  const char* name;         ///< as in the names of library and function
  const char* description;  ///< a line for a person who chooses
  /// C(u) = C(−u) for 0 ≤ u ≤ width/2 in cells, and the struct's `context`: finite, the same whenever it is asked for. Several
  /// threads may call it at once.
  double (*value)(double u, int width, double x0, void* context);
  void* context;       ///< passed to `value`, not looked at
  void* reserved[24];  ///< 0; so that the struct's size never changes
} MisfitKernelPlugin;

#ifdef __cplusplus
}
#endif

#endif
