#include "kernels/c_interface.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <memory>
#include <new>
#include <stdexcept>
#include <string>

#include "kernels/catalogue.h"
#include "kernels/kernel_table.h"
#include "kernels/sampled_function.h"

struct MisfitKernel {
  misfit::kernels::Kernel kernel;
};

namespace misfit::kernels {
namespace {

/// The message has a fixed size, so that keeping one cannot fail.
thread_local std::array<char, 1024> last_error{};

/// Keeps "function: message", on one line.
MisfitKernelStatus failed(MisfitKernelStatus status, const char* function, const char* message) noexcept {
  auto end = last_error.begin();
  for (const char* part : {function, ": ", message})
    for (; *part != 0 && end != last_error.end() - 1; ++part, ++end) *end = *part == '\n' ? ' ' : *part;
  *end = 0;
  return status;
}

/// Calls `call`, and turns an exception into a status.
template <typename Call>
MisfitKernelStatus status_of(const char* function, Call call) noexcept {
  try {
    call();
    return MISFIT_KERNEL_OK;
  } catch (const std::invalid_argument& error) {
    return failed(MISFIT_KERNEL_BAD_ARGUMENT, function, error.what());
  } catch (const std::bad_alloc&) {
    return failed(MISFIT_KERNEL_OUT_OF_MEMORY, function, "out of memory");
  } catch (const std::exception& error) {
    return failed(MISFIT_KERNEL_FAILED, function, error.what());
  } catch (...) {
    return failed(MISFIT_KERNEL_FAILED, function, "failed and does not say why");
  }
}

void require(const void* pointer, const char* name, const char* expected) {
  if (pointer == nullptr) throw std::invalid_argument(std::string(name) + " is a null pointer; expected " + expected);
}

const Kernel& of(const MisfitKernel* handle) {
  require(handle, "kernel", "one of misfit_kernel_solve or misfit_kernel_read");
  return handle->kernel;
}

/// Stores the result of `make` as a new handle, or null if it throws.
template <typename Make>
MisfitKernelStatus made(const char* function, MisfitKernel** kernel, Make make) noexcept {
  if (kernel != nullptr) *kernel = nullptr;
  return status_of(function, [&] {
    require(kernel, "kernel", "where to put it");
    *kernel = std::make_unique<MisfitKernel>(MisfitKernel{make()}).release();
  });
}

/// Stores the kernel's `fact`.
template <typename Value, typename Fact>
MisfitKernelStatus told(const char* function, const MisfitKernel* kernel, Value* value, Fact fact) noexcept {
  return status_of(function, [&] {
    const Kernel& known = of(kernel);
    require(value, "the result", "where to put it");
    *value = fact(known);
  });
}

/// The shortest text that is this number and no other.
std::string text_of_all(double value) {
  std::array<char, 32> text{};
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), value).ptr};
}

/// A condition on numbers.
struct Condition {
  bool (*holds)(double);
  const char* text;  ///< the words behind a number that fails

  void check(double value, const std::string& name) const {
    if (!holds(value)) throw std::invalid_argument(name + " = " + text_of_all(value) + text);
  }
};

constexpr Condition within_half{[](double value) { return std::abs(value) <= 0.5; }, " not in [-0.5, 0.5]"};
constexpr Condition is_finite{[](double value) { return std::isfinite(value); }, "; expected a finite number"};

/// A caller's array, and one for as many results.
struct Arrays {
  const char* name;
  const double* in;
  std::size_t count;
  double* out;

  void check(const Condition& condition) const {
    if (count == 0) return;
    require(in, name, "an array");
    require(out, "the result", "an array");
    for (std::size_t i = 0; i < count; ++i)
      if (!condition.holds(in[i])) condition.check(in[i], std::string(name) + "[" + std::to_string(i) + "]");
  }
  /// Stores values(numbers), some thousand at a time, since the memory needed meanwhile grows with their number.
  template <typename Values>
  void fill(Values values) const {
    constexpr std::size_t at_once = 4096;
    for (std::size_t done = 0; done < count; done += at_once) {
      const auto size = static_cast<Eigen::Index>(std::min(at_once, count - done));
      const Eigen::VectorXd block = Eigen::Map<const Eigen::VectorXd>(in + done, size);
      Eigen::Map<Eigen::VectorXd>(out + done, size) = values(block);
    }
  }
};

void put_taps(const PiecewisePolynomial& polynomial, double t, double* out) {
  Eigen::Map<Eigen::VectorXd>(out, polynomial.width()) = polynomial(t);
}

}  // namespace
}  // namespace misfit::kernels

using namespace misfit::kernels;

const char* misfit_kernel_last_error(void) {
  return last_error.data();
}

MisfitKernelStatus misfit_kernel_solve(const char* family, int width, double x0, MisfitKernel** kernel) {
  return made(__func__, kernel, [&] {
    require(family, "family", "a name such as \"least-misfit\"");
    return kernel_family(family).make(width, x0);
  });
}

MisfitKernelStatus misfit_kernel_read(const char* path, MisfitKernel** kernel) {
  return made(__func__, kernel, [&] {
    require(path, "path", "a kernel-table file's");
    return read_intact_kernel_table(path).kernel;
  });
}

void misfit_kernel_free(MisfitKernel* kernel) {
  delete kernel;
}

MisfitKernelStatus misfit_kernel_width(const MisfitKernel* kernel, int* width) {
  return told(__func__, kernel, width, [](const Kernel& k) { return k.width(); });
}

MisfitKernelStatus misfit_kernel_x0(const MisfitKernel* kernel, double* x0) {
  return told(__func__, kernel, x0, [](const Kernel& k) { return k.x0; });
}

MisfitKernelStatus misfit_kernel_name(const MisfitKernel* kernel, const char** name) {
  return told(__func__, kernel, name, [](const Kernel& k) { return k.name.c_str(); });
}

MisfitKernelStatus misfit_kernel_mean_error(const MisfitKernel* kernel, double* mean_error) {
  return told(__func__, kernel, mean_error, [](const Kernel& k) { return k.misfit.mean; });
}

MisfitKernelStatus misfit_kernel_max_error(const MisfitKernel* kernel, double* max_error) {
  return told(__func__, kernel, max_error, [](const Kernel& k) { return k.misfit.max; });
}

MisfitKernelStatus misfit_kernel_taps(const MisfitKernel* kernel, double t, double* taps) {
  return status_of(__func__, [&] {
    const PiecewisePolynomial& polynomial = of(kernel).polynomial;
    require(taps, "the result", "an array");
    within_half.check(t, "t");
    put_taps(polynomial, t, taps);
  });
}

MisfitKernelStatus misfit_kernel_taps_at(const MisfitKernel* kernel, const double* t, size_t count, double* taps) {
  return status_of(__func__, [&] {
    const PiecewisePolynomial& polynomial = of(kernel).polynomial;
    Arrays{"t", t, count, taps}.check(within_half);
    const auto width = static_cast<std::size_t>(polynomial.width());
    for (std::size_t i = 0; i < count; ++i) put_taps(polynomial, t[i], taps + i * width);
  });
}

MisfitKernelStatus misfit_kernel_values(const MisfitKernel* kernel, const double* u, size_t count, double* values) {
  return status_of(__func__, [&] {
    const PiecewisePolynomial& polynomial = of(kernel).polynomial;
    const Arrays arrays{"u", u, count, values};
    arrays.check(is_finite);
    arrays.fill([&](const Eigen::VectorXd& some) { return function_values(polynomial, some); });
  });
}

MisfitKernelStatus misfit_kernel_correction(const MisfitKernel* kernel, const double* x, size_t count, double* h) {
  return status_of(__func__, [&] {
    const PiecewisePolynomial& polynomial = of(kernel).polynomial;
    const Arrays arrays{"x", x, count, h};
    arrays.check(within_half);
    arrays.fill([&](const Eigen::VectorXd& some) { return optimal_correction(polynomial, some); });
  });
}

MisfitKernelStatus misfit_kernel_map_error(const MisfitKernel* kernel, const double* x, size_t count, double* error) {
  return status_of(__func__, [&] {
    const PiecewisePolynomial& polynomial = of(kernel).polynomial;
    const Arrays arrays{"x", x, count, error};
    arrays.check(within_half);
    arrays.fill([&](const Eigen::VectorXd& some) { return map_error(polynomial, some); });
  });
}
