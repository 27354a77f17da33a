#include "kernels/lookup_table.h"

#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <complex>
#include <string>

#include "kernels/catalogue.h"
#include "kernels/evaluation.h"

using namespace misfit::kernels;
namespace bdata = boost::unit_test::data;

namespace {

constexpr double x0 = 0.25;

Kernel kernel_of(int width) {
  return kernel_family("least-misfit").make(width, x0);
}

Evaluation in_double(const Kernel& kernel, const TableOptions& options) {
  return evaluate_by_table(kernel.polynomial, options, Precision::double_precision);
}

/// √(E of the table − E of the function), both with the function's correction.
double error_of_table(const Kernel& kernel, const TableOptions& options) {
  const Correction h = [&](const Eigen::VectorXd& x) { return optimal_correction(kernel.polynomial, x); };
  const Evaluation table = in_double(kernel, options);
  return std::sqrt(judge(table.taps, x0, {table.steps_per_cell, h}).mean - kernel.misfit.mean);
}

}  // namespace

BOOST_AUTO_TEST_SUITE(lookup_table)

BOOST_AUTO_TEST_CASE(error_factors_are_the_published_ones) {
  // The project's independent values, to the digits they are given to.
  const double known[] = {.28868, .091287, .046004, .029369};
  for (int d = 0; d < 4; ++d)
    BOOST_TEST(interpolation_error_factor(static_cast<Interpolation>(d)) == known[d], boost::test_tools::tolerance(2e-5));
}

BOOST_DATA_TEST_CASE(error_follows_the_law_to_three_digits, bdata::xrange(5, 10) * bdata::xrange(0, 4), width, degree) {
  const Kernel kernel = kernel_of(width);
  for (const int samples : {32, 36, 64, 100, 512, 2048, 10000}) {
    const TableOptions options{samples, static_cast<Interpolation>(degree)};
    const double law = table_misfit(options, x0);
    // The stored polynomial is optimal to 1e-7 of E only: beside a smaller e² its slope would show, as √(1e-7 E e²).
    if (law < 0.1 * kernel.misfit.mean) continue;
    BOOST_TEST_CONTEXT("Ms = " << samples)
    BOOST_TEST(error_of_table(kernel, options) == std::sqrt(law), boost::test_tools::tolerance(5e-4));
  }
}

BOOST_AUTO_TEST_CASE(tables_that_keep_the_error_within_a_tenth_are_as_large_as_the_law_says) {
  const Kernel kernel = kernel_of(7);
  const TableOptions enough[] = {{1632, Interpolation::linear}, {122, Interpolation::quadratic}, {36, Interpolation::cubic}};
  for (const TableOptions& options : enough) {
    const double e = error_of_table(kernel, options);
    BOOST_TEST(e * e < 0.1 * kernel.misfit.mean);
    const double coarser = error_of_table(kernel, {options.samples_per_cell - 4, options.interpolation});
    BOOST_TEST(coarser * coarser > 0.09 * kernel.misfit.mean);
  }
}

BOOST_DATA_TEST_CASE(tables_converge_to_the_function, bdata::make({4, 7}) * bdata::xrange(1, 4), width, degree) {
  const Kernel kernel = kernel_of(width);
  const Evaluation table = in_double(kernel, {20000 >> (4 * (degree - 1)), static_cast<Interpolation>(degree)});
  BOOST_TEST(judge(table.taps, x0, table.judging()).mean == kernel.misfit.mean, boost::test_tools::tolerance(1e-3));
}

BOOST_DATA_TEST_CASE(nothing_is_interpolated_across_the_jump_where_cells_meet, bdata::xrange(4, 10) * bdata::xrange(0, 4),
                     width, degree) {
  const Kernel kernel = kernel_of(width);
  const Evaluation table = in_double(kernel, {64, static_cast<Interpolation>(degree)});
  const auto largest = [&](double from, double to) {
    double error = 0;
    for (int i = 0; i <= 200; ++i) {
      const double t = from + (to - from) * i / 200;
      error = std::max(error, (table.taps(t) - kernel.polynomial(t)).cwiseAbs().maxCoeff());
    }
    return error;
  };
  // The derivatives of C that make the error vary over the cell: by a small factor, and no jump stands out.
  for (const double end : {-0.5, 0.5}) BOOST_TEST(largest(end, 0.94 * end) < 4 * largest(0.1 * end, 0.9 * end));
}

BOOST_DATA_TEST_CASE(symmetry_of_the_kernel_is_exact, bdata::make({6, 7}) * bdata::xrange(0, 4), width, degree) {
  for (const Precision precision : {Precision::single_precision, Precision::double_precision}) {
    const Evaluation table =
        evaluate_by_table(kernel_of(width).polynomial, {33, static_cast<Interpolation>(degree)}, precision);
    for (const double t : {0.01, 0.25, 0.499, 0.5}) BOOST_TEST((table.taps(-t) == table.taps(t).reverse()));
  }
}

BOOST_DATA_TEST_CASE(entries_are_reproduced, bdata::make({1, 2, 7, 64, 121}) * bdata::xrange(0, 4), samples, degree) {
  const Kernel kernel = kernel_of(5);
  const Evaluation table = in_double(kernel, {samples, static_cast<Interpolation>(degree)});
  for (int k = 0; 2 * k <= samples; ++k) {
    const double t = static_cast<double>(k) / samples;
    // Far beyond the cell, which tables of few entries reach, the polynomial is large: rounding is relative to that.
    const double scale = kernel.polynomial(t + 3.0 / samples).norm() + 1;
    BOOST_TEST((table.taps(t) - kernel.polynomial(t)).norm() < 1e-13 * scale);
  }
}

BOOST_AUTO_TEST_CASE(bytes_are_those_of_half_the_cells_and_the_entries_beyond) {
  const PiecewisePolynomial polynomial = kernel_of(6).polynomial;
  BOOST_TEST(LookupTable<double>(polynomial, {64, Interpolation::nearest}).bytes() == 6 * (32 + 1) * sizeof(double));
  BOOST_TEST(LookupTable<float>(polynomial, {64, Interpolation::cubic}).bytes() == 6 * (32 + 3) * sizeof(float));
}

BOOST_AUTO_TEST_CASE(sizes_outside_the_range_are_refused) {
  const PiecewisePolynomial polynomial = kernel_of(2).polynomial;
  for (const int samples : {0, -3, (1 << 24) + 1})
    BOOST_CHECK_THROW(LookupTable<double>(polynomial, {samples, Interpolation::linear}), std::invalid_argument);
}

BOOST_AUTO_TEST_CASE(tables_are_judged_by_all_positions_and_fine_ones_by_a_law_that_bounds_them) {
  for (const Interpolation interpolation :
       {Interpolation::nearest, Interpolation::linear, Interpolation::quadratic, Interpolation::cubic})
    for (const int samples : {8, 50, 512, 513, 2000}) {
      const Kernel kernel = kernel_family("spheroidal").make(5, x0);
      const TableOptions options{samples, interpolation};
      const Evaluation table = in_double(kernel, options);
      const Misfit said = judge_table(kernel.polynomial, kernel.misfit, options, x0);
      const auto h = [&](const Eigen::VectorXd& x) { return optimal_correction(kernel.polynomial, x); };
      const Misfit is = judge(table.taps, x0, {table.steps_per_cell, h});
      BOOST_TEST(said.mean == is.mean, boost::test_tools::tolerance(1e-3));  // what the law leaves out
      const Eigen::VectorXd edge = Eigen::VectorXd::Constant(1, x0);
      const double at_edge = h(edge)[0];
      double worst = 0;
      for (int i = 0; i <= 40000; ++i) {
        const double t = i / 80000.0;
        const Eigen::VectorXd taps = table.taps(t);
        std::complex<double> sum = 0;
        for (int r = 0; r < 5; ++r) sum += taps[r] * std::polar(1.0, 2 * M_PI * (r - 2 - t) * x0);
        worst = std::max(worst, std::norm(1.0 - at_edge * sum));
      }
      BOOST_TEST(worst <= 1.02 * said.worst);  // which is looked for at points, see gridding_plan.cpp
      BOOST_TEST(is.worst_mean <= 1.02 * said.worst_mean);
    }
}

BOOST_AUTO_TEST_SUITE_END()
