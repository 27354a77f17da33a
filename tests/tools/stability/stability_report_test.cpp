#include "tools/stability/stability_report.h"

#include <boost/test/unit_test.hpp>
#include <cmath>

#include "tools/base/numbers.h"

BOOST_AUTO_TEST_SUITE(stability_report)

using namespace misfit::tools;

namespace {

const Series& series_of(const Figure& figure, const std::string& label) {
  for (const Series& series : figure.series)
    if (series.label == label) return series;
  throw std::out_of_range(label);
}

double value_at(const Series& series, double x) {
  for (std::size_t i = 0; i < series.x.size(); ++i)
    if (series.x[i] == x) return series.y[i];
  throw std::out_of_range(series.label);
}

/// |sum / exact − 1| of a plain loop that adds 0.1 as `Real` holds it.
template <typename Real>
double error_of_a_loop(int additions) {
  const volatile Real term = static_cast<Real>(0.1L);
  volatile Real sum = 0;  // rounded at every step
  for (int i = 0; i < additions; ++i) sum = sum + term;
  return static_cast<double>(std::abs(static_cast<long double>(sum) / (additions * static_cast<long double>(term)) - 1));
}

}  // namespace

BOOST_AUTO_TEST_CASE(sums_of_equal_terms_are_those_of_a_plain_loop) {
  const ReportSection section = accumulation_section();
  const Figure& equal = section.figures.at(0);
  for (const int additions : {1, 20, 1000, 50000, 5000000}) {
    BOOST_TEST(value_at(series_of(equal, "single"), additions) == error_of_a_loop<float>(additions));
    BOOST_TEST(value_at(series_of(equal, "double"), additions) == error_of_a_loop<double>(additions));
  }
  BOOST_TEST(section.paragraphs.at(0).find(grouped(1 << 24)) != std::string::npos);
  // A compensated sum is as good as the rounding of its result, whatever the number of terms.
  for (const double error : series_of(section.figures.at(1), "single, compensated").y) BOOST_TEST(error <= 0x1p-23);
}

BOOST_AUTO_TEST_CASE(gridding_in_double_keeps_its_error_whatever_the_size_of_the_values) {
  const ReportSection section = magnitudes_section();
  for (const auto& row : section.tables.at(0).rows) {
    const double error = std::get<double>(row.at(1));
    if (std::get<std::string>(row.at(0)).find("10⁻³²⁰") != std::string::npos) continue;  // denormals of 12 bits
    BOOST_TEST(error < 2e-12);                                                           // √(2E) of W = 12 is 9e-13
  }
}

BOOST_AUTO_TEST_CASE(crossing_a_boundary_changes_images_by_no_more_than_they_err) {
  const ReportSection section = boundaries_section();
  for (const auto& row : section.tables.at(0).rows) {
    const double rms = std::get<double>(row.at(1));
    BOOST_TEST(std::get<double>(row.at(4)) < 5 * rms);  // twice the largest error at a position, which is 2.5 times the RMS
    BOOST_TEST(std::get<std::string>(row.at(6)) == "equal");
  }
}

BOOST_AUTO_TEST_CASE(errors_of_far_coordinates_follow_the_rounding_of_doubles) {
  const Figure figure = coordinates_section().figures.at(0);
  const Series& wide = series_of(figure, "double, W = 13");
  const Series& law = series_of(figure, "law, double");
  // 10%: 400 random samples stand for the mean.
  for (const double cells : {0x1p20, 0x1p30})
    BOOST_TEST(value_at(wide, cells) == value_at(law, cells), boost::test_tools::tolerance(0.1));
}

BOOST_AUTO_TEST_SUITE_END()
