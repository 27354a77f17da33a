#include "kernels/c_interface.h"

#include <algorithm>
#include <array>
#include <boost/test/unit_test.hpp>
#include <climits>
#include <cmath>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "kernels/catalogue.h"
#include "kernels/kernel_table.h"
#include "kernels/sampled_function.h"
#include "tests/kernels/kernels.h"
#include "tests/temporary_folder.h"

using namespace misfit::kernels;
using misfit::testing::TemporaryFolder;

namespace {

constexpr double not_a_number = NAN;

using Handle = std::unique_ptr<MisfitKernel, void (*)(MisfitKernel*)>;

Handle solved(const char* family, int width, double x0) {
  MisfitKernel* kernel = nullptr;
  BOOST_REQUIRE(misfit_kernel_solve(family, width, x0, &kernel) == MISFIT_KERNEL_OK);
  return {kernel, misfit_kernel_free};
}

/// What the last failed call says holds every word of `expected`.
bool says(const std::vector<std::string>& expected) {
  const std::string said = misfit_kernel_last_error();
  bool all = said.find('\n') == std::string::npos;
  for (const std::string& word : expected) all = all && said.find(word) != std::string::npos;
  if (!all) BOOST_TEST_MESSAGE(said);
  return all;
}

/// `call(positions, count, results)` gives the bits of `values`.
template <typename Call>
void check_same(const Eigen::VectorXd& at, const Eigen::VectorXd& values, Call call) {
  std::vector<double> results(static_cast<std::size_t>(values.size()));
  BOOST_TEST(call(at.data(), static_cast<std::size_t>(at.size()), results.data()) == MISFIT_KERNEL_OK);
  bool same = true;
  for (std::size_t i = 0; i < results.size(); ++i) same = same && results[i] == values[static_cast<Eigen::Index>(i)];
  BOOST_TEST(same);
}

void check_same(const MisfitKernel* handle, const Kernel& kernel) {
  const PiecewisePolynomial& c = kernel.polynomial;
  int width = 0;
  double x0 = 0, mean = 0, max = 0;
  const char* name = nullptr;
  BOOST_TEST(misfit_kernel_width(handle, &width) == MISFIT_KERNEL_OK);
  BOOST_TEST(misfit_kernel_x0(handle, &x0) == MISFIT_KERNEL_OK);
  BOOST_TEST(misfit_kernel_name(handle, &name) == MISFIT_KERNEL_OK);
  BOOST_TEST(misfit_kernel_mean_error(handle, &mean) == MISFIT_KERNEL_OK);
  BOOST_TEST(misfit_kernel_max_error(handle, &max) == MISFIT_KERNEL_OK);
  BOOST_TEST(width == kernel.width());
  BOOST_TEST(x0 == kernel.x0);
  BOOST_TEST(name == kernel.name);
  BOOST_TEST(mean == kernel.misfit.mean);
  BOOST_TEST(max == kernel.misfit.max);

  const Eigen::VectorXd half = Eigen::VectorXd::LinSpaced(101, -0.5, 0.5);
  Eigen::MatrixXd taps(width, half.size());  // whose columns follow each other
  for (Eigen::Index i = 0; i < half.size(); ++i) {
    taps.col(i) = c(half[i]);
    check_same(half.segment(i, 1), taps.col(i),
               [&](const double* t, std::size_t, double* out) { return misfit_kernel_taps(handle, *t, out); });
  }
  const auto by = [&](auto function) {
    return [=](const double* at, std::size_t count, double* out) { return function(handle, at, count, out); };
  };
  check_same(half, taps.reshaped(), by(misfit_kernel_taps_at));
  check_same(half, optimal_correction(c, half), by(misfit_kernel_correction));
  check_same(half, map_error(c, half), by(misfit_kernel_map_error));
  const Eigen::VectorXd u = Eigen::VectorXd::LinSpaced(997, -0.6 * width, 0.6 * width);
  check_same(u, function_values(c, u), by(misfit_kernel_values));
}

}  // namespace

BOOST_AUTO_TEST_SUITE(c_interface)

BOOST_AUTO_TEST_CASE(every_family_has_the_bits_of_the_interface_in_cpp) {
  for (const KernelFamily& family : kernel_catalogue())
    for (const int width : {family.min_width, std::clamp(7, family.min_width, family.max_width)})
      for (const double x0 : {0.25, 0.4}) check_same(solved(family.name.c_str(), width, x0).get(), family.make(width, x0));
}

BOOST_AUTO_TEST_CASE(a_file_gives_the_kernel_that_was_written) {
  const TemporaryFolder folder;
  const std::string path = folder / "k.fits";
  const Kernel kernel = kernel_family("least-misfit").make(6, 0.3);
  write_kernel_table(kernel, {}, path);
  MisfitKernel* handle = nullptr;
  BOOST_TEST(misfit_kernel_read(path.c_str(), &handle) == MISFIT_KERNEL_OK);
  check_same(handle, kernel);
  misfit_kernel_free(handle);
}

BOOST_AUTO_TEST_CASE(a_file_that_is_none_or_damaged_fails_and_is_named) {
  const TemporaryFolder folder;
  MisfitKernel* handle = nullptr;
  const auto refused = [&](const std::string& path) {
    return misfit_kernel_read(path.c_str(), &handle) == MISFIT_KERNEL_FAILED && handle == nullptr &&
           says({"misfit_kernel_read: ", path});
  };
  BOOST_TEST(refused(folder / "nothing.fits"));
  BOOST_TEST(refused(folder / ""));
  const std::string path = folder / "k.fits";
  misfit::kernels::testing::put(path, "no FITS file");
  BOOST_TEST(refused(path));
  write_kernel_table(kernel_family("linear").make(2, 0.25), {}, path);
  std::string bytes = misfit::kernels::testing::content(path);
  bytes.at(bytes.size() - 2880) ^= 1;  // the first number of the table
  misfit::kernels::testing::put(path, bytes);
  BOOST_TEST(refused(path));
}

BOOST_AUTO_TEST_CASE(what_no_family_offers_is_a_bad_argument_with_what_is_offered) {
  MisfitKernel* handle = nullptr;
  const auto refused = [&](const char* family, int width, double x0, const std::vector<std::string>& words) {
    return misfit_kernel_solve(family, width, x0, &handle) == MISFIT_KERNEL_BAD_ARGUMENT && handle == nullptr && says(words);
  };
  BOOST_TEST(refused("least-misfat", 7, 0.25, {"misfit_kernel_solve: ", "\"least-misfat\"", "least-misfit, minimax"}));
  BOOST_TEST(refused("", 7, 0.25, {"\"\"", "expected one of"}));
  BOOST_TEST(refused("two\nlines", 7, 0.25, {"\"two lines\""}));
  BOOST_TEST(refused(std::string(5000, 'x').c_str(), 7, 0.25, {"\"xxx"}));
  BOOST_TEST(std::string(misfit_kernel_last_error()).size() == 1023U);
  for (const int width : {0, -1, 21, INT_MAX, INT_MIN})
    BOOST_TEST(refused("least-misfit", width, 0.25, {"width " + std::to_string(width) + ", expected 1 to 20"}));
  for (const double x0 : {0.0, -0.25, 0.5, not_a_number, HUGE_VAL, -HUGE_VAL})
    BOOST_TEST(refused("least-misfit", 7, x0, {"x0 = ", ", expected 0.01 to 0.49"}));
}

BOOST_AUTO_TEST_CASE(a_null_pointer_is_a_bad_argument_and_is_named) {
  const Handle kernel = solved("linear", 2, 0.25);
  const MisfitKernel* const k = kernel.get();
  MisfitKernel* other = nullptr;
  int width = 0;
  double number = 0;
  const char* name = nullptr;
  std::array<double, 2> taps{};
  const auto refused = [](MisfitKernelStatus status, const char* what) {
    return status == MISFIT_KERNEL_BAD_ARGUMENT &&
           says({"misfit_kernel_", std::string(what) + " is a null pointer; expected "});
  };
  BOOST_TEST(refused(misfit_kernel_solve(nullptr, 7, 0.25, &other), "family"));
  BOOST_TEST(refused(misfit_kernel_solve("linear", 2, 0.25, nullptr), "kernel"));
  BOOST_TEST(refused(misfit_kernel_read(nullptr, &other), "path"));
  BOOST_TEST(refused(misfit_kernel_read("k.fits", nullptr), "kernel"));
  BOOST_TEST(refused(misfit_kernel_width(nullptr, &width), "kernel"));
  BOOST_TEST(refused(misfit_kernel_width(k, nullptr), "the result"));
  BOOST_TEST(refused(misfit_kernel_x0(nullptr, &number), "kernel"));
  BOOST_TEST(refused(misfit_kernel_x0(k, nullptr), "the result"));
  BOOST_TEST(refused(misfit_kernel_name(nullptr, &name), "kernel"));
  BOOST_TEST(refused(misfit_kernel_name(k, nullptr), "the result"));
  BOOST_TEST(refused(misfit_kernel_mean_error(nullptr, &number), "kernel"));
  BOOST_TEST(refused(misfit_kernel_mean_error(k, nullptr), "the result"));
  BOOST_TEST(refused(misfit_kernel_max_error(nullptr, &number), "kernel"));
  BOOST_TEST(refused(misfit_kernel_max_error(k, nullptr), "the result"));
  BOOST_TEST(refused(misfit_kernel_taps(nullptr, 0, taps.data()), "kernel"));
  BOOST_TEST(refused(misfit_kernel_taps(k, 0, nullptr), "the result"));
  for (const auto function : {misfit_kernel_taps_at, misfit_kernel_values, misfit_kernel_correction, misfit_kernel_map_error}) {
    BOOST_TEST(refused(function(nullptr, &number, 1, taps.data()), "kernel"));
    BOOST_TEST(refused(function(k, &number, 1, nullptr), "the result"));
    BOOST_TEST(function(k, nullptr, 1, taps.data()) == MISFIT_KERNEL_BAD_ARGUMENT);
    BOOST_TEST(says({" is a null pointer; expected an array"}));
    BOOST_TEST(function(k, nullptr, 0, nullptr) == MISFIT_KERNEL_OK);
  }
  misfit_kernel_free(nullptr);
}

BOOST_AUTO_TEST_CASE(a_position_out_of_range_is_a_bad_argument_and_is_named) {
  const Handle kernel = solved("linear", 2, 0.25);
  std::array<double, 4> out{};
  for (const double t : {0.51, -0.50000001, not_a_number, HUGE_VAL}) {
    BOOST_TEST(misfit_kernel_taps(kernel.get(), t, out.data()) == MISFIT_KERNEL_BAD_ARGUMENT);
    BOOST_TEST(says({"misfit_kernel_taps: t = ", " not in [-0.5, 0.5]"}));
    const std::array<double, 2> at{0.5, t};
    BOOST_TEST(misfit_kernel_taps_at(kernel.get(), at.data(), 2, out.data()) == MISFIT_KERNEL_BAD_ARGUMENT);
    BOOST_TEST(says({"t[1] = ", " not in [-0.5, 0.5]"}));
    for (const auto function : {misfit_kernel_correction, misfit_kernel_map_error}) {
      BOOST_TEST(function(kernel.get(), at.data(), 2, out.data()) == MISFIT_KERNEL_BAD_ARGUMENT);
      BOOST_TEST(says({"x[1] = ", " not in [-0.5, 0.5]"}));
    }
  }
  BOOST_TEST(misfit_kernel_taps(kernel.get(), -0.50000001, out.data()) == MISFIT_KERNEL_BAD_ARGUMENT);
  BOOST_TEST(says({"t = -0.50000001 not"}));
  for (const double u : {not_a_number, HUGE_VAL, -HUGE_VAL}) {
    BOOST_TEST(misfit_kernel_values(kernel.get(), &u, 1, out.data()) == MISFIT_KERNEL_BAD_ARGUMENT);
    BOOST_TEST(says({"u[0] = ", "expected a finite number"}));
  }
}

BOOST_AUTO_TEST_CASE(a_value_is_the_same_alone_and_among_ten_thousand) {
  const Handle kernel = solved("least-misfit", 5, 0.25);
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(10001, -0.5, 0.5);
  Eigen::VectorXd together(x.size());
  BOOST_TEST(misfit_kernel_correction(kernel.get(), x.data(), 10001, together.data()) == MISFIT_KERNEL_OK);
  for (Eigen::Index i = 0; i < x.size(); i += 97) {
    double alone = 0;
    BOOST_TEST(misfit_kernel_correction(kernel.get(), &x[i], 1, &alone) == MISFIT_KERNEL_OK);
    BOOST_TEST(std::abs(alone - together[i]) <= 1e-13 * std::abs(alone));  // sums of some ten terms in another order
  }
}

BOOST_AUTO_TEST_CASE(threads_share_a_kernel_and_each_has_its_own_error) {
  const Handle shared = solved("least-misfit", 7, 0.25);
  std::array<bool, 4> right{};
  std::vector<std::thread> threads;
  for (int n = 0; n < 4; ++n)
    threads.emplace_back([&, n] {
      bool all = *misfit_kernel_last_error() == 0;
      for (int i = 0; i < 20; ++i) {
        std::array<double, 7> taps{}, again{};
        MisfitKernel *own = nullptr, *none = nullptr;
        all = all && misfit_kernel_taps(shared.get(), 0.1 * n, taps.data()) == MISFIT_KERNEL_OK;
        all = all && misfit_kernel_solve("no-family", 100 + n, 0.25, &none) == MISFIT_KERNEL_BAD_ARGUMENT;
        all = all && misfit_kernel_solve("least-misfit", 100 + n, 0.25, &none) == MISFIT_KERNEL_BAD_ARGUMENT;
        all = all && misfit_kernel_solve("least-misfit", 7, 0.25, &own) == MISFIT_KERNEL_OK;
        all = all && misfit_kernel_taps(own, 0.1 * n, again.data()) == MISFIT_KERNEL_OK && taps == again;
        all = all && says({"width " + std::to_string(100 + n)});
        misfit_kernel_free(own);
      }
      right.at(static_cast<std::size_t>(n)) = all;
    });
  for (std::thread& thread : threads) thread.join();
  for (const bool each : right) BOOST_TEST(each);
}

BOOST_AUTO_TEST_CASE(a_thousand_kernels_come_and_go_and_leave_nothing) {  // which sanitizers tell
  for (int i = 0; i < 1000; ++i) {
    const Handle kernel = solved("nearest", 1, 0.25);
    MisfitKernel* none = nullptr;
    BOOST_REQUIRE(misfit_kernel_solve("nearest", i - 1000, 0.25, &none) == MISFIT_KERNEL_BAD_ARGUMENT);
    double x = 0, h = 0;
    BOOST_REQUIRE(misfit_kernel_correction(kernel.get(), &x, 1, &h) == MISFIT_KERNEL_OK);
    BOOST_REQUIRE(std::abs(h - 1) < 1e-14);
  }
}

BOOST_AUTO_TEST_SUITE_END()
