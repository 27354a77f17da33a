#include "tools/report/report_folder.h"

#include <boost/test/unit_test.hpp>
#include <set>

#include "tests/tools/markup.h"
#include "tests/tools/program.h"

BOOST_AUTO_TEST_SUITE(report_folder)

using namespace misfit::tools;
using namespace misfit::tools::testing;

namespace {

Figure figure_called(const std::string& name) {
  return {.name = name,
          .title = "Title of " + name,
          .caption = "Caption of " + name,
          .x = {.label = "x"},
          .y = {.label = "y"},
          .series = {{.label = "one", .x = {0, 1}, .y = {2, 3}}, {.label = "two", .x = {0, 1}, .y = {3, 2}}}};
}

Report report() {
  const DataTable table{.name = "c", .title = "Title of c", .caption = "", .columns = {"k"}, .rows = {{1.5}}};
  return {.title = "A <report>",
          .introduction = "Why & how.",
          .sections = {
              {.heading = "First", .paragraphs = {"x < y"}, .figures = {figure_called("a"), figure_called("b")}, .tables = {}},
              {.heading = "Second", .paragraphs = {}, .figures = {}, .tables = {table}}}};
}

}  // namespace

BOOST_AUTO_TEST_CASE(every_part_is_on_the_page_and_in_files_and_nothing_else_is_left) {
  const TemporaryFolder folder;
  const std::string path = folder / "new/deep";
  prepare_report_folder(path);
  write_report(report(), path);
  std::set<std::string> names;
  for (const auto& [name, bytes] : files_below(path)) names.insert(std::filesystem::path(name).filename());
  BOOST_TEST(names == (std::set<std::string>{"index.html", "report.json", "a.svg", "a.csv", "b.svg", "b.csv", "c.csv"}),
             boost::test_tools::per_element());
  const std::string page = content(path + "/index.html");
  for (const char* text :
       {"Title of a", "Caption of b", "Title of c", "Second", "x &lt; y", "A &lt;report&gt;", "Why &amp; how."})
    BOOST_TEST(contains(page, text), text);
}

BOOST_AUTO_TEST_CASE(the_page_is_well_formed_and_needs_no_other_file) {
  const TemporaryFolder folder;
  write_report(report(), folder / "");
  const std::string page = content(folder / "index.html");
  BOOST_TEST(balanced(page));
  BOOST_TEST(balanced(content(folder / "a.svg")));
  const std::vector<std::string> ids = ids_of(page);
  BOOST_TEST(std::set<std::string>(ids.begin(), ids.end()).size() == ids.size());
  for (const char* outside : {"<script", "<link", "@import", "src=", "href=\"", "href='h"})
    BOOST_TEST(!contains(page, outside), outside);
}

BOOST_AUTO_TEST_CASE(the_json_file_has_every_series_and_table) {
  const TemporaryFolder folder;
  write_report(report(), folder / "");
  const auto json = nlohmann::json::parse(content(folder / "report.json"));
  const auto& first = json["sections"][0];
  BOOST_TEST(first["figures"][1]["series"][1]["y"] == nlohmann::json({3.0, 2.0}));
  BOOST_TEST(json["sections"][1]["tables"][0]["rows"][0][0] == 1.5);
}

BOOST_AUTO_TEST_CASE(two_parts_of_one_name_are_refused) {
  const TemporaryFolder folder;
  Report twice = report();
  twice.sections[1].figures.push_back(figure_called("a"));
  BOOST_CHECK_THROW(write_report(twice, folder / ""), std::logic_error);
}

BOOST_AUTO_TEST_CASE(a_folder_that_cannot_be_used_is_one_line_and_exit_1) {
  const TemporaryFolder folder;
  std::ofstream(folder / "file") << "text";
  for (const std::string& path : {folder / "file", folder / "file/below"}) {
    const Outcome outcome = run({"report", "kernels", "--output", path});
    BOOST_TEST(outcome.code == 1);
    BOOST_TEST(contains(outcome.err, path));
    BOOST_TEST(std::count(outcome.err.begin(), outcome.err.end(), '\n') == 1);
    BOOST_TEST(outcome.out == "");
  }
}

BOOST_AUTO_TEST_CASE(a_report_that_there_is_not_is_wrong_usage) {
  BOOST_TEST(run({"report"}).code == 2);
  BOOST_TEST(run({"report", "kernels"}).code == 2);
  BOOST_TEST(run({"report", "scene", "--output", "x"}).code == 2);
}

BOOST_AUTO_TEST_SUITE_END()
