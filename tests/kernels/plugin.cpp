// A kernel library from outside, built many times: in each NAME says what is wrong with it, if anything is.
#include <cfenv>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "kernels/kernel_plugin.h"

namespace {

const std::string name = NAME;

double gauss(double u, int, double, void*) {
  return std::exp(-u * u);
}

double of_context(double u, int, double, void* context) {
  return std::exp(-u * u / *static_cast<const double*>(context));
}

double one(double, int, double, void*) {
  return 1;
}

/// What the header promises to ask for only: throws anywhere else, and where cells meet.
double strict(double u, int width, double x0, void*) {
  const double from_border = std::remainder(u - width / 2.0, 1);
  if (!(u >= 0 && u < width / 2.0 && from_border != 0)) throw std::logic_error("u = " + std::to_string(u));
  if (width < 1 || width > 20 || !(x0 >= 0.01 && x0 <= 0.49)) throw std::logic_error("width or x0");
  return 1e-300 * (width * width - u * u);
}

double tent(double u, int, double, void*) {
  return u < 1.25 ? 1 - u / 2.5 : 0;
}

double throwing(double u, int, double, void*) {
  if (u > 1) throw std::runtime_error("no value\nbeyond 1");
  return 1;
}

double no_number(double u, int width, double, void*) {
  return width > 2 && u > 1 ? std::numeric_limits<double>::quiet_NaN() : 1;
}

double infinite(double u, int, double, void*) {
  return 1 / (u > 1 ? 0.0 : 1);
}

double negative(double u, int, double, void*) {
  return u - 10;
}

#ifdef IS_unresolved
}  // namespace
extern "C" double misfit_test_function_that_is_nowhere(double u, int width, double x0, void* context);
namespace {
#endif

#ifdef IS_rounding_up
[[maybe_unused]] const int changed_by_loading = std::fesetround(FE_UPWARD);
#endif

double wider = 4;

}  // namespace

extern "C" void REGISTER(MisfitKernelPlugin* p);

extern "C" void REGISTER(MisfitKernelPlugin* p) {
  if (name == "silent") return;
  if (name == "refusing") throw std::runtime_error("no licence\nfor this kernel");
  if (name == "breaking") throw 1;
  p->version = name == "aged" ? MISFIT_KERNEL_PLUGIN_VERSION + 1 : MISFIT_KERNEL_PLUGIN_VERSION;
  p->name = name == "nameless" ? nullptr : name == "misnamed" ? "someone-else" : NAME;
  p->description = "a test";
  p->min_width = name == "narrow" ? 0 : name == "crossed" ? 6 : 1;
  p->max_width = name == "wide" ? 21 : name == "crossed" ? 5 : 20;
  if (name == "beyond-x0") p->max_x0 = 0.5;
  if (name == "crossed-x0") p->min_x0 = 0.3, p->max_x0 = 0.2;
  p->value = gauss;
  if (name == "reserving") p->reserved[3] = &wider;
  if (name == "valueless") p->value = nullptr;
  if (name == "gauss-wide") p->value = of_context, p->context = &wider, p->min_x0 = 0.1, p->max_x0 = 0.3;
  if (name == "steep") p->value = strict;
  if (name == "box") p->value = one;
  if (name == "bent") p->value = tent;
  if (name == "throwing") p->value = throwing;
  if (name == "nan") p->value = no_number;
  if (name == "infinite") p->value = infinite;
  if (name == "negative") p->value = negative;
#ifdef IS_unresolved
  p->value = misfit_test_function_that_is_nowhere;
#endif
  if (name == "aged") {  // where it has everything else, nobody else can know
    p->name = reinterpret_cast<const char*>(1);
    p->min_width = -1;
  }
}
