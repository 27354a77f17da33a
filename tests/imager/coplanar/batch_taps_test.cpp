#include "imager/coplanar/batch_taps.h"

#include <hwy/targets.h>

#include <boost/mpl/list.hpp>
#include <boost/test/unit_test.hpp>
#include <limits>
#include <random>

BOOST_AUTO_TEST_SUITE(batch_taps)

using namespace misfit;
using namespace misfit::imager;

using Precisions = boost::mpl::list<float, double>;

BOOST_AUTO_TEST_CASE_TEMPLATE(taps_are_the_polynomials_for_every_width_count_and_instruction_set, Real, Precisions) {
  constexpr int degree = 9, most = 21;
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    for (int width = 1; width <= most_taps; ++width)
      for (const int count : {0, 1, 3, 8, most}) {
        const kernels::PiecewisePolynomial taps{
            Eigen::MatrixXd::NullaryExpr(degree + 1, width, [&] { return uniform(random); })};
        const TapTable<Real> table(taps);
        BatchTaps<Real, most + 1> out;
        std::fill(std::begin(out.value), std::end(out.value), Real(7));
        Real t[most];
        for (Real& x : t) x = static_cast<Real>(uniform(random) / 2);
        evaluate_taps(table, t, count, out.value);
        double largest = 0;
        for (int i = 0; i < count; ++i) {
          const Eigen::VectorXd should = taps(double{t[i]});
          for (int r = 0; r < table.padded; ++r)
            largest = std::max(largest, std::abs(double{out.value[i * table.padded + r]} - (r < width ? should[r] : 0)));
        }
        // No tap exceeds Σ_d 2^−d < 2, and each of 2 · degree + 1 operations rounds once.
        BOOST_TEST(largest <= 2 * (2 * degree + 1) * double{std::numeric_limits<Real>::epsilon()});
        BOOST_TEST(out.value[count * table.padded] == Real(7));  // nothing beyond
      }
  }
  hwy::SetSupportedTargetsForTest(0);
}

BOOST_AUTO_TEST_CASE_TEMPLATE(looked_up_taps_are_those_of_the_table_for_every_instruction_set, Real, Precisions) {
  constexpr int most = 9;
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    for (const int width : {1, 4, 7, 12, 20})
      for (int degree = 0; degree <= 3; ++degree) {
        const kernels::PiecewisePolynomial polynomial{Eigen::MatrixXd::NullaryExpr(8, width, [&] { return uniform(random); })};
        const kernels::TableOptions options{37, static_cast<kernels::Interpolation>(degree)};
        const kernels::LookupTable<Real> looked_up(polynomial, options);
        const TapTable<Real> table(polynomial, options);
        Real t[most] = {Real(-0.5), Real(0.5), 0};
        for (int i = 3; i < most; ++i) t[i] = static_cast<Real>(uniform(random) / 2);
        BatchTaps<Real, most> out;
        evaluate_taps(table, t, most, out.value);
        double largest = 0;
        for (int i = 0; i < most; ++i) {
          Real should[most_taps] = {};
          looked_up.taps(t[i], should);
          for (int r = 0; r < table.padded; ++r)
            largest = std::max(largest, std::abs(double{out.value[i * table.padded + r]} - double{should[r]}));
        }
        // Entries are below 2, the weights' magnitudes add up to less than 2, and sums of four may be fused or not.
        BOOST_TEST(largest <= 16 * double{std::numeric_limits<Real>::epsilon()});
      }
  }
  hwy::SetSupportedTargetsForTest(0);
}

BOOST_AUTO_TEST_SUITE_END()
