#include "tools/report/data_table.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/tools/markup.h"

BOOST_AUTO_TEST_SUITE(data_table)

using namespace misfit::tools;
using misfit::tools::testing::balanced;
using misfit::tools::testing::contains;

namespace {

DataTable table() {
  return {.name = "numbers",
          .title = "Numbers",
          .caption = "",
          .columns = {"what, and why", "E"},
          .rows = {{"say \"<E>\"", 1.0 / 3e9}, {"", 1630.0}, {"none", std::nan("")}}};
}

}  // namespace

BOOST_AUTO_TEST_CASE(fields_of_csv_are_quoted_and_numbers_keep_their_bits) {
  BOOST_TEST(table_csv(table()) == "\"what, and why\",E\n\"say \"\"<E>\"\"\"," + csv_number(1.0 / 3e9) + "\n,1630\nnone,\n");
  BOOST_TEST(std::stod(csv_number(1.0 / 3e9)) == 1.0 / 3e9);
}

BOOST_AUTO_TEST_CASE(html_is_escaped_and_aligns_columns_of_numbers) {
  const std::string page = table_html(table());
  BOOST_TEST(balanced(page));
  BOOST_TEST(contains(page, "<td>say &quot;&lt;E&gt;&quot;</td><td class=\"number\">3.33 × 10<sup>−10</sup></td>"));
  BOOST_TEST(contains(page, "<td class=\"number\">1\u2009630</td>"));
  BOOST_TEST(contains(page, "<td class=\"number\">–</td>"));
}

BOOST_AUTO_TEST_CASE(json_has_every_cell) {
  const nlohmann::json json = nlohmann::json::parse(table_json(table()).dump());
  BOOST_TEST(json["rows"].size() == 3U);
  BOOST_TEST(json["rows"][0][1].get<double>() == 1.0 / 3e9);
  BOOST_TEST(json["rows"][2][1].is_null());
}

BOOST_AUTO_TEST_CASE(rows_of_another_length_are_refused) {
  DataTable uneven = table();
  uneven.rows.push_back({1.0});
  BOOST_CHECK_THROW(table_csv(uneven), std::logic_error);
  BOOST_CHECK_THROW(table_html(uneven), std::logic_error);
}

BOOST_AUTO_TEST_SUITE_END()
