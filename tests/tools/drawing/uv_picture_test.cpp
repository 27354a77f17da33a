#include "tools/drawing/uv_picture.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <cstring>

#include "imager/numerics/constants.h"
#include "tests/tools/markup.h"
#include "tests/tools/program.h"
#include "tools/drawing/pictures.h"

BOOST_AUTO_TEST_SUITE(uv_picture)

using namespace misfit;
using namespace misfit::tools::testing;

namespace {

/// One sample at every one of these places, in wavelengths, but `copies` at the first.
imager::UvCoverage coverage_of(double reach_lambda, const std::vector<std::pair<double, double>>& places, int copies = 1) {
  imager::VisibilityBlock block;
  block.frequency_hz = {imager::speed_of_light_m_s};
  const auto add = [&](const std::pair<double, double>& place) {
    for (const double x : {place.first, place.second, 0.0}) block.uvw_m.edit().push_back(x);
    block.visibility.emplace_back(1);
    block.weight.push_back(1);
  };
  for (const auto& place : places) add(place);
  for (int copy = 1; copy < copies; ++copy) add(places.front());
  imager::UvCoverage coverage(reach_lambda);
  coverage.add(block);
  return coverage;
}

struct Drawing {
  std::string script;
  std::vector<float> shades;  ///< [v][u]
  int side = 0;
};

Drawing drawing_of(const imager::UvCoverage& coverage) {
  const TemporaryFolder folder;
  tools::write_uv_script(coverage, folder / "");
  Drawing drawing{.script = content(folder / "script"), .shades = {}, .side = 0};
  const std::string bytes = content(folder / "data");
  drawing.shades.resize(bytes.size() / sizeof(float));
  std::memcpy(drawing.shades.data(), bytes.data(), bytes.size());
  drawing.side = static_cast<int>(std::lround(std::sqrt(static_cast<double>(drawing.shades.size()))));
  return drawing;
}

}  // namespace

BOOST_AUTO_TEST_CASE(shades_are_logarithms_of_counts_and_empty_cells_are_left_out) {
  // Twenty places on a line fill enough cells that none is drawn larger.
  std::vector<std::pair<double, double>> places;
  for (int k = 0; k < 20; ++k) places.emplace_back(0.2 * k - 1.95, 0.25);
  const Drawing drawing = drawing_of(coverage_of(32, places, 100));
  BOOST_TEST(drawing.side == 22);  // ten cells of 0.2 wavelengths to either side of 0, and one for a margin
  const int row = drawing.side / 2 + 1, column = drawing.side / 2 - 10;
  BOOST_TEST(drawing.shades[static_cast<std::size_t>(row * drawing.side + column)] == 2.0F);
  BOOST_TEST(drawing.shades[static_cast<std::size_t>(row * drawing.side + column + 1)] == 0.0F);
  BOOST_TEST(std::isnan(drawing.shades[static_cast<std::size_t>((row + 1) * drawing.side + column)]));
  const auto shown = std::count_if(drawing.shades.begin(), drawing.shades.end(), [](float shade) { return shade >= 0; });
  BOOST_TEST(shown == 40);
}

BOOST_AUTO_TEST_CASE(a_few_samples_can_be_seen) {
  const Drawing drawing = drawing_of(coverage_of(100, {{90, 80}}));
  const auto shown = std::count_if(drawing.shades.begin(), drawing.shades.end(), [](float shade) { return shade >= 0; });
  BOOST_TEST(shown == 18);  // the sample and its mirror image, three cells a side each
}

BOOST_AUTO_TEST_CASE(units_suit_the_distance) {
  for (const auto& [reach, unit] : {std::pair{900.0, "'u, λ'"}, {9e4, "'u, kλ'"}, {9e6, "'u, Mλ'"}, {9e9, "'u, Gλ'"}})
    BOOST_TEST(contains(drawing_of(coverage_of(reach, {{0.9 * reach, 0}})).script, unit), unit);
}

BOOST_AUTO_TEST_CASE(the_samples_are_counted_in_the_title) {
  const Drawing drawing = drawing_of(coverage_of(16, {{10, 3}, {-4, 5}}, 7));
  BOOST_TEST(contains(drawing.script, "'8 samples and their mirror images'"));
  BOOST_TEST(contains(drawing.script, "'in cells of 0.1 λ'"));
}

BOOST_AUTO_TEST_CASE(gnuplot_draws_it_even_where_there_is_nothing) {
  const TemporaryFolder folder;
  tools::PictureDrawing drawing;
  drawing.add(coverage_of(100, {{90, 80}}), folder / "one.png");
  drawing.add(imager::UvCoverage(100), folder / "none.png");
  BOOST_TEST(drawing.finish() == "");
  for (const char* name : {"one.png", "none.png"}) BOOST_TEST(content(folder / name).starts_with("\x89PNG"), name);
}

BOOST_AUTO_TEST_SUITE_END()
