#include "tools/kernel_report/kernel_report.h"

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>

BOOST_AUTO_TEST_SUITE(kernel_report)

using namespace misfit::tools;

namespace {

const Figure& figure_called(const ReportSection& section, const std::string& name) {
  const auto found =
      std::find_if(section.figures.begin(), section.figures.end(), [&](const Figure& f) { return f.name == name; });
  BOOST_REQUIRE(found != section.figures.end());
  return *found;
}

SolvedKernels& solved() {
  static SolvedKernels all;
  return all;
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_function_is_drawn_over_half_its_width_and_broken_between_cells) {
  for (const int width : {1, 4, 7}) {
    const Series drawn = function_curve("C", solved()(width, 0.25).taps);
    const auto gaps = std::count_if(drawn.y.begin(), drawn.y.end(), [](double y) { return std::isnan(y); });
    BOOST_TEST(gaps == (width + 1) / 2);
    BOOST_TEST(drawn.x.front() == 0);
    BOOST_TEST(drawn.x.back() == width / 2.0);
    BOOST_TEST(std::is_sorted(drawn.x.begin(), drawn.x.end()));
    BOOST_TEST(drawn.y.front() == solved()(width, 0.25).taps(width % 2 == 1 ? 0 : 0.5)[width / 2]);
  }
}

BOOST_AUTO_TEST_CASE(a_least_misfit_correction_is_1_in_the_centre) {
  // The solver leaves h to 1e-8.
  BOOST_TEST(std::abs(correction_curve("h", solved()(6, 0.3).taps, 0.3).y.front() - 1) < 1e-7);
}

BOOST_AUTO_TEST_CASE(no_function_errs_by_less_than_half_at_the_edge) {
  // There the image and its alias weigh the same; half of the power is lost.
  const ReportSection section = classical_section(solved());
  for (const Series& series : figure_called(section, "classical-functions").series)
    BOOST_TEST(series.y.back() > 0.5 - 1e-12, series.label);
}

BOOST_AUTO_TEST_CASE(the_reciprocal_taper_errs_by_l_over_1_minus_l) {
  const ReportSection section = spheroidal_section(solved());
  const auto& series = figure_called(section, "spheroidal-6-map-error").series;
  // ℓ is 4e-9 or more here, a sum of squares of differences rounded at 1e-16.
  for (std::size_t k = 0; k < series[0].y.size(); ++k)
    BOOST_TEST(std::abs(series[1].y[k] * (1 - series[0].y[k]) / series[0].y[k] - 1) < 1e-9);
}

BOOST_AUTO_TEST_CASE(wider_least_misfit_functions_err_less_everywhere_they_are_made_for) {
  const ReportSection section = least_misfit_section(solved());
  const auto& series = figure_called(section, "least-misfit-by-width").series;
  for (std::size_t k = 1; k < series.size(); ++k)
    for (std::size_t i = 0; series[k].x[i] <= 0.25; ++i) BOOST_TEST(series[k].y[i] < series[k - 1].y[i]);
}

BOOST_AUTO_TEST_CASE(tables_err_as_the_law_drawn_beside_them_says, *boost::unit_test::label("sweep")) {
  const ReportSection section = evaluation_section(solved());
  const auto& series = figure_called(section, "table-rms").series;
  const Series& law = series.back();
  std::size_t at = 0;
  for (std::size_t k = 0; k + 1 < series.size(); ++k, ++at) {
    for (std::size_t i = 0; i < series[k].y.size(); ++i, ++at) {
      // The law is the leading term: the next is smaller by (2π x0 / Ms)², with a factor near 1.
      const double next_term = std::pow(1.6 / series[k].x[i], 2);
      BOOST_TEST(std::abs(series[k].y[i] / law.y[at] - 1) < 2e-3 + 2 * next_term, series[k].label << " " << series[k].x[i]);
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
