#include "tools/report/figure.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "tests/tools/markup.h"

BOOST_AUTO_TEST_SUITE(figure)

using misfit::tools::draw_svg;
using misfit::tools::Figure;
using misfit::tools::figure_csv;
using misfit::tools::testing::balanced;
using misfit::tools::testing::contains;
using misfit::tools::testing::ids_of;

namespace {

Figure figure_called(const std::string& name) {
  return {.name = name,
          .title = "Error & <more>",
          .caption = "",
          .x = {.label = "x, 'of' {the} image_1"},
          .y = {.label = "map error ℓ(x) \\ 2", .logarithmic = true},
          .series = {{.label = "W = 6", .x = {0, 0.1, 0.2}, .y = {1e-20, 1.0 / 3, 1e3}},
                     {.label = "a \"long, long\" label, with a comma", .x = {0, 1}, .y = {1, 2}, .points = true},
                     {.label = "law_1^2", .x = {0, 1}, .y = {1, 2}, .law = true}}};
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_drawing_is_well_formed_and_shows_every_label_as_it_is) {
  const std::string svg = draw_svg(figure_called("one"));
  BOOST_TEST(balanced(svg));
  for (const char* text : {"x, 'of' {the} image_1", "map error ℓ(x) \\ 2", "W = 6", "with a comma", "law_1^2",
                           "<title>Error &amp; &lt;more&gt;</title>"})
    BOOST_TEST(contains(svg, text), text);
}

BOOST_AUTO_TEST_CASE(drawings_can_stand_on_one_page) {
  const std::vector<std::string> ids = ids_of(draw_svg(figure_called("one")) + draw_svg(figure_called("one-more")));
  BOOST_TEST(!ids.empty());
  BOOST_TEST(std::set<std::string>(ids.begin(), ids.end()).size() == ids.size());
}

BOOST_AUTO_TEST_CASE(what_cannot_be_drawn_leaves_a_gap) {
  Figure figure = figure_called("gaps");
  figure.series = {
      {.label = "one", .x = {0, 1, 2, 3, 4}, .y = {1, -1, std::nan(""), 0, std::numeric_limits<double>::infinity()}}};
  BOOST_TEST(balanced(draw_svg(figure)));
}

BOOST_AUTO_TEST_CASE(figures_that_make_no_sense_are_refused) {
  Figure empty = figure_called("empty");
  empty.series = {{.label = "one", .x = {0}, .y = {-1}}};
  BOOST_CHECK_THROW(draw_svg(empty), std::logic_error);
  Figure repeated = figure_called("repeated");
  repeated.series.push_back(repeated.series.front());
  BOOST_CHECK_THROW(draw_svg(repeated), std::logic_error);
  Figure unequal = figure_called("unequal");
  unequal.series.front().x.pop_back();
  BOOST_CHECK_THROW(figure_csv(unequal), std::logic_error);
}

BOOST_AUTO_TEST_CASE(every_point_is_in_the_csv_file_to_the_bit) {
  const Figure figure = figure_called("points");
  std::istringstream csv(figure_csv(figure));
  std::string line;
  std::getline(csv, line);
  BOOST_TEST(line == "series,x,y");
  for (const auto& series : figure.series) {
    for (std::size_t k = 0; k < series.x.size(); ++k) {
      std::getline(csv, line);
      const auto last = line.rfind(',');
      const auto middle = line.rfind(',', last - 1);
      BOOST_TEST(contains(line.substr(0, middle), series.label.substr(0, 3)));
      BOOST_TEST(std::stod(line.substr(middle + 1)) == series.x[k]);
      BOOST_TEST(std::stod(line.substr(last + 1)) == series.y[k]);
    }
  }
  BOOST_TEST(!std::getline(csv, line));
}

BOOST_AUTO_TEST_SUITE_END()
