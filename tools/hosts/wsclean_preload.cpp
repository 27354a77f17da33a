// A library for LD_PRELOAD that has the installed WSClean grid with the kernel of a file by `misfit kernel --emit wsclean`:
//
//     LD_PRELOAD=libmisfit_wsclean.so MISFIT_WSCLEAN_KERNEL=k.h wsclean -padding 1.2 -no-small-inversion …
//
// WSClean's w-stacking gridder fills its table with I0 times sin(πi/Ms)/(πi), calling sin() for i = 1, 2 … in turn, and divides
// the image by a DCT of the table, planned by fftw_plan_r2r_1d(). This library answers the sine for i so that the table becomes
// the file's, and replaces the DCT's result by the file's divisor. It is written against WSClean 3.1 with its default grid
// mode, and says at the end if the calls did not come as expected.
#include <dlfcn.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <mutex>
#include <string>
#include <vector>

namespace {

[[noreturn]] void fail(const std::string& what) {
  std::fprintf(stderr, "libmisfit_wsclean: %s\n", what.c_str());
  std::_Exit(1);
}

/// The content of a header for WSClean.
class EmittedKernel {
 public:
  explicit EmittedKernel(const char* path) {
    if (path == nullptr) fail("MISFIT_WSCLEAN_KERNEL is not set; expected a file by misfit kernel --emit wsclean");
    if (!std::filesystem::is_regular_file(path))
      fail("MISFIT_WSCLEAN_KERNEL=" + std::string(path) + " does not exist, or is no file");
    std::ifstream file(path);
    text_.assign(std::istreambuf_iterator<char>(file), {});
    if (text_.find("MISFIT_KERNEL_WSCLEAN_H") == std::string::npos)
      fail("MISFIT_WSCLEAN_KERNEL=" + std::string(path) + " is no file by misfit kernel --emit wsclean");
    taps = static_cast<int>(number("misfit_kernel_size ="));
    per_cell = static_cast<int>(number("misfit_oversampling ="));
    x0 = number("double x0 =");
    divisor_series = numbers("misfit_divisor_series[");
    const std::vector<double> table = numbers("misfit_kernel[");
    half.assign(table.begin() + static_cast<std::ptrdiff_t>(table.size() / 2), table.end());
  }

  /// The divisor of the image at x, as misfit_divisor() in the file.
  double divisor(double x) const {
    const double part = std::fmin(std::fabs(x) / x0, 1), y = 2 * part * part - 1;
    double next = 0, after = 0;
    for (std::size_t k = divisor_series.size() - 1; k > 0; --k) {
      const double sum = divisor_series[k] + 2 * y * next - after;
      after = next;
      next = sum;
    }
    return divisor_series[0] + y * next - after;
  }

  int taps = 0;
  int per_cell = 0;
  double x0 = 0;
  std::vector<double> half;  ///< from the middle outwards
  std::vector<double> divisor_series;

 private:
  const char* after(const std::string& key) const {
    const std::size_t at = text_.find(key);
    if (at == std::string::npos) fail("its kernel file has no " + key);
    return text_.c_str() + at + key.size();
  }
  double number(const std::string& key) const { return std::strtod(after(key), nullptr); }
  std::vector<double> numbers(const std::string& key) const {
    std::vector<double> found;
    for (const char* at = std::strchr(after(key), '{'); at != nullptr && *at != '}';) {
      char* end = nullptr;
      found.push_back(std::strtod(at + 1, &end));
      at = end == at + 1 ? nullptr : end + std::strspn(end, " \n");
    }
    if (found.empty()) fail("its kernel file has nothing in " + key + "]");
    return found;
  }
  std::string text_;
};

/// A DCT that WSClean has planned.
struct Transform {
  const void* in = nullptr;
  void* out = nullptr;
  int size = 0;
};

/// The calls so far, and the words on them at the end.
struct State {
  EmittedKernel kernel{std::getenv("MISFIT_WSCLEAN_KERNEL")};
  std::mutex mutex;
  std::map<void*, Transform> transforms;  ///< DCTs by their plans
  bool served = false;

  std::string expected() const {
    return "version 3.1, its default grid mode, no -use-wgridder, -kernel-size " + std::to_string(kernel.taps) +
           " -oversampling " + std::to_string(kernel.per_cell);
  }

  State() = default;
  State(const State&) = delete;
  State& operator=(const State&) = delete;
  ~State() {
    if (!served)
      std::fprintf(stderr, "libmisfit_wsclean: WSClean made no use of the kernel; expected %s\n", expected().c_str());
  }
};

State& state() {
  static State the;
  return the;
}

template <typename Function>
Function next_in_line(const char* name) {
  return reinterpret_cast<Function>(dlsym(RTLD_NEXT, name));
}

/// The sine that makes entry i of WSClean's table the kernel's, relative to its middle.
double sine_for(std::size_t i, const EmittedKernel& kernel) {
  constexpr double alpha = 8.6;
  const double part = static_cast<double>(i) / static_cast<double>(kernel.half.size() - 1);
  const double bessel = std::cyl_bessel_i(0.0, alpha * std::sqrt(1 - part * part)) / std::cyl_bessel_i(0.0, alpha);
  return kernel.half[i] / kernel.half[0] / bessel * M_PI * static_cast<double>(i) / kernel.per_cell;
}

template <typename Real>
void* plan_transform(const char* name, int size, Real* in, Real* out, int kind, unsigned flags) {
  constexpr int redft01 = 4;
  void* const plan = next_in_line<void* (*)(int, Real*, Real*, int, unsigned)>(name)(size, in, out, kind, flags);
  State& the = state();
  const std::lock_guard<std::mutex> lock(the.mutex);
  if (kind == redft01) the.transforms[plan] = {in, out, size};
  return plan;
}

/// Ends the program, before it writes anything, when WSClean's table from its middle outwards is not the kernel's and zeros.
template <typename Real>
void check_table(const State& the, const Transform& transform) {
  constexpr double rounding = 1e-6;
  const std::vector<double>& half = the.kernel.half;
  for (std::size_t i = 0; i < static_cast<std::size_t>(transform.size); ++i) {
    const double should = i < half.size() ? half[i] / half[0] : 0;
    if (!(std::fabs(static_cast<const Real*>(transform.in)[i] - should) < rounding))
      fail("WSClean's table is not the kernel's; expected " + the.expected());
  }
}

/// WSClean's DCT of n values for an FFT of N = 2n/Ms pixels leaves Ms·c at the pixel k.
template <typename Real>
void execute(const char* name, void* plan) {
  State& the = state();
  const std::unique_lock<std::mutex> lock(the.mutex);
  const auto found = the.transforms.find(plan);
  if (found != the.transforms.end()) check_table<Real>(the, found->second);
  next_in_line<void (*)(void*)>(name)(plan);
  if (found == the.transforms.end()) return;
  const auto [in, out, size] = found->second;
  const double pixels = 2.0 * size / the.kernel.per_cell;
  for (int k = 0; k < size; ++k)
    static_cast<Real*>(out)[k] = static_cast<Real>(the.kernel.per_cell * the.kernel.divisor(k / pixels) / the.kernel.half[0]);
  the.transforms.erase(found);
  the.served = true;
}

}  // namespace

extern "C" {

double sin(double x) {
  static const auto real_sine = next_in_line<double (*)(double)>("sin");
  thread_local std::size_t i = 1;  // the entry that comes next
  State& the = state();
  const double ratio = 1.0 / the.kernel.per_cell;
  if (x != M_PI * ratio * static_cast<double>(i)) return real_sine(x);
  const double answer = sine_for(i, the.kernel);
  const bool last = i + 1 == the.kernel.half.size();
  i = last ? 1 : i + 1;
  return answer;
}

void* fftw_plan_r2r_1d(int size, double* in, double* out, int kind, unsigned flags) {
  return plan_transform(__func__, size, in, out, kind, flags);
}

void* fftwf_plan_r2r_1d(int size, float* in, float* out, int kind, unsigned flags) {
  return plan_transform(__func__, size, in, out, kind, flags);
}

void fftw_execute(void* plan) {
  execute<double>(__func__, plan);
}

void fftwf_execute(void* plan) {
  execute<float>(__func__, plan);
}
}
