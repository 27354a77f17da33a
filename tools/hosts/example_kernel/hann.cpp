// A kernel from outside misfit: the raised cosine C(u) = 1 + cos(2πu/W). In this folder, with misfit installed in PREFIX:
//
//     cmake -B build -D CMAKE_PREFIX_PATH=PREFIX
//     cmake --build build
//     misfit kernel --kernel hann --kernel-folder build --width 6 --x0 0.25 --output hann.fits
#include <cmath>

#include "kernels/kernel_plugin.h"

static double hann(double u, int width, double, void*) {
  return 1 + std::cos(2 * M_PI * u / width);
}

extern "C" void register_hann(MisfitKernelPlugin* plugin) {
  plugin->version = MISFIT_KERNEL_PLUGIN_VERSION;
  plugin->name = "hann";
  plugin->description = "a raised cosine, 1 + cos(2πu/W)";
  plugin->min_width = 2;
  plugin->max_width = 20;
  plugin->value = hann;
}
