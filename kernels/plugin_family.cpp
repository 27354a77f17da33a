#include "kernels/plugin_family.h"

#include <dlfcn.h>

#include <algorithm>
#include <array>
#include <cfenv>
#include <cmath>
#include <iterator>
#include <stdexcept>
#include <string_view>

#include "kernels/families/even_taps.h"
#include "kernels/kernel_plugin.h"
#include "kernels/map_error.h"
#include "kernels/text_internal.h"

namespace misfit::kernels {
namespace {

namespace fs = std::filesystem;

constexpr int widest = 20;
constexpr std::string_view prefix = "libmisfit_kernel_", ending = ".so";

[[noreturn]] void fail(const std::string& whose, const std::string& message) {
  throw std::runtime_error(whose + " " + message);
}

/// Turns exceptions of other people's code into an error about `where()`, on one line.
template <typename Call, typename Where>
auto translated(Call call, Where where) {
  try {
    return call();
  } catch (const std::exception& error) {
    std::string what = error.what();
    std::replace(what.begin(), what.end(), '\n', ' ');
    fail(where(), "failed: " + what);
  } catch (...) {
    fail(where(), "threw something that is no std::exception and says nothing; expected std::runtime_error or the like");
  }
}

std::string function_name(const std::string& kernel) {
  std::string name = "register_" + kernel;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

using Register = void (*)(MisfitKernelPlugin*);

Register load(const std::string& file, const std::string& function) {
  std::error_code none;
  if (!fs::exists(file, none)) fail("kernel library " + file, "does not exist");
  std::fenv_t arithmetic;
  std::fegetenv(&arithmetic);
  void* const library = dlopen(fs::absolute(file).c_str(), RTLD_NOW | RTLD_LOCAL);
  std::fesetenv(&arithmetic);  // libraries linked with -ffast-math have everybody's small numbers become 0
  if (library == nullptr)
    fail("kernel library " + file, "cannot be loaded: " + std::string(dlerror()) +
                                       "; expected a shared library for this machine, with all that it needs");
  void* const found = dlsym(library, function.c_str());
  if (found == nullptr)
    fail("kernel library " + file,
         "has no function " + function + "; expected extern \"C\" void " + function + "(MisfitKernelPlugin*)");
  return reinterpret_cast<Register>(found);
}

/// The struct, with room for fields that libraries for a later interface may fill in.
struct Form {
  MisfitKernelPlugin plugin;
  std::array<unsigned char, 4096> beyond;
};

MisfitKernelPlugin filled_in(const std::string& file, const std::string& kernel) {
  const std::string function = function_name(kernel);
  const Register fill = load(file, function);
  const auto whose = [&] { return "kernel library " + file + ": " + function; };
  Form form{};
  translated([&] { fill(&form.plugin); }, whose);
  if (form.plugin.version == 0)
    fail(whose(), "sets no version; expected MISFIT_KERNEL_PLUGIN_VERSION there, and the rest of the struct filled in");
  if (form.plugin.version != MISFIT_KERNEL_PLUGIN_VERSION)
    fail("kernel library " + file, "was built for version " + std::to_string(form.plugin.version) +
                                       " of the kernel interface, this program has version " +
                                       std::to_string(MISFIT_KERNEL_PLUGIN_VERSION) +
                                       ": build it anew against the installed misfit");
  return form.plugin;
}

void check(const MisfitKernelPlugin& p, const std::string& whose, const std::string& kernel) {
  if (p.name == nullptr) fail(whose, "sets no name; expected \"" + kernel + "\", as in the file's name");
  if (p.name != kernel)
    fail(whose, "sets the name \"" + std::string(p.name) + "\"; expected \"" + kernel + "\", as in the file's");
  if (p.value == nullptr) fail(whose, "sets no value; expected the function that computes C(u)");
  if (p.reserved_number != 0 || std::any_of(std::begin(p.reserved), std::end(p.reserved), [](void* r) { return r != nullptr; }))
    fail(whose, "sets what is reserved; expected 0 there, as in the struct that it gets");
  if (!(p.min_width >= 1 && p.min_width <= p.max_width && p.max_width <= widest))
    fail(whose, "offers widths " + std::to_string(p.min_width) + " to " + std::to_string(p.max_width) +
                    "; expected min_width of 1 or more, and max_width from there to " + std::to_string(widest));
  if (!(p.min_x0 > 0 && p.min_x0 <= p.max_x0 && p.max_x0 < 0.5))
    fail(whose, "offers x0 from " + text_of(p.min_x0) + " to " + text_of(p.max_x0) +
                    "; expected min_x0 above 0, and max_x0 from there to below 0.5, or 0 for what is usual");
}

/// A library's function for one width and x0.
struct PluginFunction {
  std::string kernel;  ///< with the file it comes from, as messages name it
  MisfitKernelPlugin plugin;
  int width = 1;
  double x0 = 0.25;

  std::string name() const { return kernel + ", width " + std::to_string(width) + ", x0 " + text_of(x0); }

  double operator()(double u) const {
    const auto here = [&] { return name() + ": value at u = " + text_of(u); };
    const double value = translated([&] { return plugin.value(u, width, x0, plugin.context); }, here);
    if (!std::isfinite(value)) fail(here(), "is " + text_of(value) + "; expected a finite number");
    return value;
  }
};

/// The taps, asked for inside of cells only, by a power of two so that ∫ C du lies in [1, 2).
TapFunction moderate_taps(const PluginFunction& function) {
  const TapFunction plain = taps_over_cells(function.width, function);
  const double integral = image_taper(plain, Eigen::VectorXd::Zero(1))[0];
  if (!(integral > 0 && std::isfinite(integral)))
    fail(function.name(), "has an integral over u of " + text_of(integral) + "; expected a finite one above 0");
  return [plain, power = -std::ilogb(integral)](double t) {
    constexpr double edge = 0.5 - 1e-9;
    return Eigen::VectorXd(plain(std::clamp(t, -edge, edge)).unaryExpr([&](double c) { return std::scalbn(c, power); }));
  };
}

Kernel solved(const std::string& name, const PluginFunction& function) {
  constexpr double most = 1e14;  // the rounding of doubles, so amplified, is a hundredth of the image
  const TapFunction taps = moderate_taps(function);
  const double gain = largest_noise_gain(taps, function.x0);
  if (!(gain <= most))
    fail(function.name(),
         "cannot be corrected for: its transform and its aliases all but vanish somewhere in |x| <= x0, so that the "
         "correction amplifies rounding " +
             text_of(gain) + " times; expected less than " + text_of(most));
  return make_kernel(name, function.x0, taps);
}

}  // namespace

fs::path plugin_file(const fs::path& folder, const std::string& name) {
  return folder / (std::string(prefix) + name + std::string(ending));
}

std::vector<std::string> plugins_in(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code none;
  for (fs::directory_iterator entry(folder, none), end; !none && entry != end; entry.increment(none)) {
    const std::string file = entry->path().filename();
    const std::size_t affixes = prefix.size() + ending.size();
    if (file.size() > affixes && file.rfind(prefix, 0) == 0 && file.substr(file.size() - ending.size()) == ending)
      names.push_back(file.substr(prefix.size(), file.size() - affixes));
  }
  std::sort(names.begin(), names.end());
  return names;
}

KernelFamily plugin_family(const fs::path& folder, const std::string& name) {
  const std::string file = plugin_file(folder, name);
  MisfitKernelPlugin plugin = filled_in(file, name);
  KernelFamily family;
  if (plugin.min_x0 == 0) plugin.min_x0 = family.min_x0;
  if (plugin.max_x0 == 0) plugin.max_x0 = family.max_x0;
  check(plugin, "kernel library " + file + ": " + function_name(name), name);
  family.name = name;
  family.description = plugin.description == nullptr ? "" : plugin.description;
  family.min_width = plugin.min_width;
  family.max_width = plugin.max_width;
  family.min_x0 = plugin.min_x0;
  family.max_x0 = plugin.max_x0;
  family.solve = [name, kernel = "kernel " + name + " of " + file, plugin](int width, double x0) {
    return solved(name, {kernel, plugin, width, x0});
  };
  return family;
}

}  // namespace misfit::kernels
