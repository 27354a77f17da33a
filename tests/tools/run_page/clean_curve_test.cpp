#include "tools/run_page/clean_curve.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <limits>
#include <sstream>

#include "tests/tools/markup.h"

BOOST_AUTO_TEST_SUITE(clean_curve)

using misfit::tools::CurvePoint;
using misfit::tools::testing::contains;

namespace {

struct Place {
  double x = 0;
  double y = 0;
};

/// The points of the line of a kind; of its entry in the legend too, which comes first.
std::vector<std::vector<Place>> lines_of(const std::string& svg, const std::string& kind) {
  const std::string start = "<polyline class=\"" + kind + "\" points=\"";
  std::vector<std::vector<Place>> lines;
  for (std::size_t at = svg.find(start); at != std::string::npos; at = svg.find(start, at + 1)) {
    std::istringstream text(svg.substr(at + start.size(), svg.find('"', at + start.size()) - at - start.size()));
    lines.emplace_back();
    char comma = 0;
    for (Place place; text >> place.x >> comma >> place.y;) lines.back().push_back(place);
  }
  return lines;
}

const std::vector<CurvePoint> course{{0, 1, 0.1, 0, 0}, {50, 0.1, 0.05, 0.12, 2}, {100, 0.01, 0.005, 0.012, 3}};

constexpr double rounding = 0.11;  // coordinates have one decimal

}  // namespace

BOOST_AUTO_TEST_CASE(equal_ratios_of_peaks_are_equal_steps_down) {
  const auto peak = lines_of(misfit::tools::clean_curve(course), "peak").back();
  BOOST_TEST_REQUIRE(peak.size() == 3U);
  BOOST_TEST(std::abs(peak[2].y - 2 * peak[1].y + peak[0].y) < 2 * rounding);
  BOOST_TEST(peak[1].y > peak[0].y);
}

BOOST_AUTO_TEST_CASE(all_curves_share_the_axis_of_iterations) {
  const std::string svg = misfit::tools::clean_curve(course);
  const auto peak = lines_of(svg, "peak").back(), noise = lines_of(svg, "noise").back(), flux = lines_of(svg, "flux").back();
  BOOST_TEST(std::abs(peak[2].x - 2 * peak[1].x + peak[0].x) < 2 * rounding);
  for (std::size_t k = 0; k < 3; ++k) {
    BOOST_TEST(peak[k].x == noise[k].x);
    BOOST_TEST(peak[k].x == flux[k].x);
  }
}

BOOST_AUTO_TEST_CASE(noise_and_depth_lie_on_the_scale_of_the_peak) {
  const std::string svg = misfit::tools::clean_curve(course);
  const auto peak = lines_of(svg, "peak").back(), noise = lines_of(svg, "noise").back(), depth = lines_of(svg, "depth").back();
  BOOST_TEST(noise[0].y == peak[1].y);  // both 0.1 Jy/beam
  const double decade = peak[1].y - peak[0].y;
  BOOST_TEST_REQUIRE(depth.size() == 4U);  // level through either cycle
  BOOST_TEST(depth[0].x == peak[0].x);
  BOOST_TEST(depth[1].x == peak[1].x);
  BOOST_TEST(depth[0].y == depth[1].y);
  BOOST_TEST(std::abs(depth[0].y - (peak[1].y - decade * std::log10(0.12 / 0.1))) < 2 * rounding);
  BOOST_TEST(std::abs(depth[2].y - depth[1].y - decade) < 2 * rounding);
}

BOOST_AUTO_TEST_CASE(flux_is_linear_from_zero) {
  const auto flux = lines_of(misfit::tools::clean_curve(course), "flux").back();
  BOOST_TEST(std::abs((flux[1].y - flux[0].y) / 2 - (flux[2].y - flux[0].y) / 3) < 2 * rounding);
  BOOST_TEST(flux[2].y < flux[0].y);
}

BOOST_AUTO_TEST_CASE(what_cannot_be_shown_is_left_out) {
  std::vector<CurvePoint> points = course;
  points[1].noise_jy = std::numeric_limits<double>::quiet_NaN();
  points[2].flux_jy = std::numeric_limits<double>::infinity();
  for (CurvePoint& point : points) point.depth_jy = 0;
  const std::string svg = misfit::tools::clean_curve(points);
  BOOST_TEST(lines_of(svg, "noise").back().size() == 2U);
  BOOST_TEST(lines_of(svg, "flux").back().size() == 2U);
  BOOST_TEST(lines_of(svg, "depth").size() == 1U);  // that of the legend
  for (const char* nonsense : {"nan", "inf"}) BOOST_TEST(!contains(svg, nonsense), nonsense);
  BOOST_TEST(misfit::tools::testing::balanced(svg));
}

BOOST_AUTO_TEST_CASE(the_curves_are_told_in_words_too) {
  BOOST_TEST(contains(misfit::tools::clean_curve(course),
                      "From 0 to 100 iterations the peak residual went from 1\u00a0Jy/beam to "
                      "10\u00a0mJy/beam, the model’s flux from 0\u00a0Jy to 3\u00a0Jy."));
}

BOOST_AUTO_TEST_CASE(there_is_no_curve_without_two_numbers_of_iterations) {
  BOOST_TEST(misfit::tools::clean_curve({}).empty());
  BOOST_TEST(misfit::tools::clean_curve({{0, 1.0}}).empty());
  BOOST_TEST(misfit::tools::clean_curve({{0, 1.0}, {50, 0.0}}).empty());
  BOOST_TEST(misfit::tools::clean_curve({{50, 1.0}, {50, 1.0}}).empty());
  BOOST_TEST(!misfit::tools::clean_curve({{0, 1.0}, {50, 1.0}}).empty());
}

BOOST_AUTO_TEST_SUITE_END()
