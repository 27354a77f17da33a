#include "kernels/map_error.h"

#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <complex>

#include "kernels/catalogue.h"
#include "kernels/evaluation.h"

using namespace misfit::kernels;
namespace bdata = boost::unit_test::data;

namespace {

constexpr double pi = 3.14159265358979323846;

/// |1 − h(x) Σ_r C(r−ν) exp(2πi(r−ν)x)|², written as the definition has it.
double error_at(const TapFunction& taps, double h, double x, double t) {
  const Eigen::VectorXd c = taps(t);
  std::complex<double> sum = 0;
  for (Eigen::Index r = 0; r < c.size(); ++r)
    sum += c[r] * std::polar(1.0, 2 * pi * (double(r) - double(c.size() - 1) / 2 - t) * x);
  return std::norm(1.0 - h * sum);
}

Eigen::VectorXd single(double x) {
  return Eigen::VectorXd::Constant(1, x);
}

/// The mean over t of the definition by the midpoint rule, good to 1e-4 with 400 points.
double map_error_by_midpoints(const TapFunction& taps, double h, double x) {
  double sum = 0;
  for (int i = 0; i < 400; ++i) sum += error_at(taps, h, x, (i + 0.5) / 400 - 0.5) / 400;
  return sum;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(map_error)

BOOST_DATA_TEST_CASE(equals_its_definition, bdata::make({2, 5, 8}) * bdata::make({0.0, 0.11, 0.25, 0.4}), width, x) {
  const Kernel kernel = kernel_family("least-misfit").make(width, 0.3);
  const double h = optimal_correction(kernel.polynomial, single(x))[0];
  const double defined = map_error_by_midpoints(kernel.polynomial, h, x);
  BOOST_TEST(misfit::kernels::map_error(kernel.polynomial, single(x))[0] == defined, boost::test_tools::tolerance(1e-3));
}

BOOST_DATA_TEST_CASE(optimal_correction_is_a_minimum_at_every_x, bdata::make({0.0, 0.1, 0.2, 0.3}), x) {
  for (const KernelFamily& family : kernel_catalogue()) {
    const Kernel kernel = family.make(std::clamp(5, family.min_width, family.max_width), 0.3);
    const double h = optimal_correction(kernel.polynomial, single(x))[0];
    const double best = map_error_by_midpoints(kernel.polynomial, h, x);
    BOOST_TEST(map_error_by_midpoints(kernel.polynomial, h * 1.001, x) > best);
    BOOST_TEST(map_error_by_midpoints(kernel.polynomial, h * 0.999, x) > best);
  }
}

BOOST_DATA_TEST_CASE(misfit_means_and_maxima_are_those_of_the_definition, bdata::make({1, 4, 7}), width) {
  const Kernel kernel = kernel_family("least-misfit").make(width, 0.25);
  double mean = 0;
  double max = 0;
  double worst = 0;
  std::vector<double> mean_at(201);
  constexpr int points = 200;
  for (int i = 0; i <= points; ++i) {
    const double x = 0.25 * i / points;
    const double h = optimal_correction(kernel.polynomial, single(x))[0];
    const double error = misfit::kernels::map_error(kernel.polynomial, single(x))[0];
    const double weight = (i == 0 || i == points ? 0.5 : 1.0) / points;
    mean += weight * error;
    max = std::max(max, error);
    for (int j = 0; j <= 200; ++j) {
      const double at = error_at(kernel.polynomial, h, x, j / 400.0);
      worst = std::max(worst, at);
      mean_at[static_cast<std::size_t>(j)] += weight * at;
    }
  }
  // 1%: the trapezium rule and grids of 200 points stand for integrals and maxima.
  BOOST_TEST(kernel.misfit.mean == mean, boost::test_tools::tolerance(0.01));
  BOOST_TEST(kernel.misfit.max == max, boost::test_tools::tolerance(0.01));
  BOOST_TEST(kernel.misfit.worst == worst, boost::test_tools::tolerance(0.01));
  BOOST_TEST(kernel.misfit.worst_mean == *std::max_element(mean_at.begin(), mean_at.end()), boost::test_tools::tolerance(0.01));
}

BOOST_AUTO_TEST_CASE(noise_gain_is_that_of_white_noise_on_the_grid) {
  // Of the box (W = 1, C = 1, c = sinc): h = 1/sinc up to aliases; by the midpoint rule from the optimal correction itself.
  const TapFunction box = [](double) -> Eigen::VectorXd { return Eigen::VectorXd::Ones(1); };
  double h_square = 0;
  for (int i = 0; i < 1000; ++i) h_square += std::pow(optimal_correction(box, single((i + 0.5) * 0.25 / 1000))[0], 2) / 1000;
  BOOST_TEST(noise_gain(box, 0.25) == std::sqrt(h_square), boost::test_tools::tolerance(1e-6));
  // Towards x0 = 1/2 it grows without limit.
  const KernelFamily& family = kernel_family("least-misfit");
  BOOST_TEST(noise_gain(family.make(9, 0.45).polynomial, 0.45) > 10 * noise_gain(family.make(9, 0.25).polynomial, 0.25));
}

BOOST_AUTO_TEST_CASE(the_largest_noise_gain_is_that_where_the_correction_is_largest) {
  const Kernel kernel = kernel_family("least-misfit").make(5, 0.3);
  // For even functions that fall off h is largest at x0: the two gains differ as h(x0) and its RMS do.
  double h_square = 0;
  for (int i = 0; i < 1000; ++i)
    h_square += std::pow(optimal_correction(kernel.polynomial, single((i + 0.5) * 0.3 / 1000))[0], 2) / 1000;
  const double ratio = optimal_correction(kernel.polynomial, single(0.3))[0] / std::sqrt(h_square);
  BOOST_TEST(misfit::kernels::largest_noise_gain(kernel.polynomial, 0.3) == ratio * noise_gain(kernel.polynomial, 0.3),
             boost::test_tools::tolerance(1e-5));  // the midpoint rule
}

BOOST_DATA_TEST_CASE(judging_many_pixels_tends_to_the_integral, bdata::make({2, 6}), width) {
  const Kernel kernel = kernel_family("least-misfit").make(width, 0.3);
  const Misfit pixels = judge_pixels(kernel.polynomial, 6000, 10000);
  BOOST_TEST(pixels.mean == kernel.misfit.mean, boost::test_tools::tolerance(0.01));
  BOOST_TEST(pixels.max == kernel.misfit.max, boost::test_tools::tolerance(0.01));
  BOOST_TEST(pixels.worst_mean == kernel.misfit.worst_mean, boost::test_tools::tolerance(0.01));
}

BOOST_DATA_TEST_CASE(means_over_steps_equal_brute_force, bdata::make({1, 2, 7, 64, 121, 600, 1001, 5000}) * bdata::xrange(0, 4),
                     samples, degree) {
  // Tables whose error is far above their function's, alike and far below, whether all their steps are looked at or a few.
  const Kernel kernel = kernel_family("least-misfit").make(6, 0.25);
  const Evaluation table =
      evaluate_by_table(kernel.polynomial, {samples, static_cast<Interpolation>(degree)}, Precision::double_precision);
  for (const double x : {0.05, 0.25}) {
    const double h = optimal_correction(kernel.polynomial, single(x))[0];
    const JudgeOptions options{samples, [h](const Eigen::VectorXd& at) { return Eigen::VectorXd::Constant(at.size(), h); }};
    double brute = 0;
    const int points = samples * std::max(40, 20000 / samples);  // 40 midpoints or more in every step: 6e-4 of its part
    for (int i = 0; i < points; ++i) brute += error_at(table.taps, h, x, (i + 0.5) / points - 0.5) / points;
    BOOST_TEST(misfit::kernels::map_error(table.taps, single(x), options)[0] == brute, boost::test_tools::tolerance(2e-3));
  }
}

BOOST_AUTO_TEST_CASE(worst_position_of_a_table_lies_between_its_entries) {
  const Kernel kernel = kernel_family("least-misfit").make(7, 0.25);
  for (const int samples : {64, 4000}) {
    const Evaluation table =
        evaluate_by_table(kernel.polynomial, {samples, Interpolation::linear}, Precision::double_precision);
    const Correction h = [&](const Eigen::VectorXd& x) { return optimal_correction(kernel.polynomial, x); };
    // Half-way between entries linear interpolation errs by (2πx)²/(8 Ms²), at x = x0 most; E itself adds little at 64.
    const double law = std::pow(pi * pi / (32.0 * samples * samples), 2);
    if (samples == 64)
      BOOST_TEST(judge(table.taps, 0.25, {samples, h}).worst == law, boost::test_tools::tolerance(1e-2));
    else
      BOOST_TEST(judge(table.taps, 0.25, {samples, h}).worst >= kernel.misfit.worst * 0.9);
  }
}

BOOST_DATA_TEST_CASE(steps_change_nothing_for_smooth_taps, bdata::make({1, 3, 64, 2000}) * bdata::make({2, 9}), steps, width) {
  const Kernel kernel = kernel_family("least-misfit").make(width, 0.3);
  const Misfit stepped = judge(kernel.polynomial, 0.3, {steps, {}});
  BOOST_TEST(stepped.mean == kernel.misfit.mean, boost::test_tools::tolerance(1e-5));
  BOOST_TEST(stepped.max == kernel.misfit.max, boost::test_tools::tolerance(1e-5));
  BOOST_TEST(stepped.worst == kernel.misfit.worst, boost::test_tools::tolerance(5e-2));  // found on different points
}

BOOST_DATA_TEST_CASE(the_error_of_another_correction_is_that_of_the_definition, bdata::make({0.0, 0.1, 0.24}), x) {
  const Kernel kernel = kernel_family("least-misfit").make(5, 0.25);
  const JudgeOptions options{0, [](const Eigen::VectorXd& at) -> Eigen::VectorXd { return 1 + at.array(); }};
  const double defined = map_error_by_midpoints(kernel.polynomial, 1 + x, x);
  BOOST_TEST(misfit::kernels::map_error(kernel.polynomial, single(x), options)[0] == defined,
             boost::test_tools::tolerance(1e-4));
  // The mean over x, with the optimal correction handed in, is E.
  const Correction optimal = [&](const Eigen::VectorXd& at) { return optimal_correction(kernel.polynomial, at); };
  BOOST_TEST(judge(kernel.polynomial, 0.25, {0, optimal}).mean == kernel.misfit.mean, boost::test_tools::tolerance(1e-12));
}

BOOST_AUTO_TEST_SUITE_END()
