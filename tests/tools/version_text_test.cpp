#include "tools/version_text.h"

#include <boost/test/unit_test.hpp>
#include <regex>
#include <sstream>

#include "tests/tools/program.h"
#include "tools/build_facts.h"
#include "tools/mpi/world.h"

BOOST_AUTO_TEST_SUITE(version_text)

namespace {

using namespace misfit::tools;

/// The lines of the text.
std::vector<std::string> lines(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> all;
  for (std::string line; std::getline(stream, line);) all.push_back(line);
  return all;
}

}  // namespace

BOOST_AUTO_TEST_CASE(the_first_line_is_the_program_and_its_version_alone) {
  const testing::Outcome outcome = testing::run({"--version"});
  BOOST_TEST(outcome.code == 0);
  BOOST_TEST(outcome.err == "");
  BOOST_TEST(outcome.out == misfit::tools::version_text() + '\n');
  BOOST_TEST(std::regex_match(lines(outcome.out).front(), std::regex(R"(misfit \d+\.\d+\.\d+)")));
}

BOOST_AUTO_TEST_CASE(each_other_line_is_a_fact_in_the_same_column) {
  const std::vector<std::pair<std::string, std::string>> facts{
      {"commit", "[0-9a-f]{12,}"},      {"build", R"(\w+ [\d.]+, \w+(, sanitizers [a-z,]+)?)"},
      {"casacore", R"([\d.]+)"},        {"CFITSIO", R"(\d+\.\d+\.\d+)"},
      {"FFTW", R"(\d+\.\d+\.\d+)"},     {"Eigen", R"(3\.\d+\.\d+)"},
      {"MPI", R"(.+ v?\d+\.\d+\.\d+)"}, {"Highway", R"(\d+\.\d+\.\d+, loops run with [A-Z0-9_]+)"}};
  const std::vector<std::string> said = lines(misfit::tools::version_text());
  std::size_t at = 1;
  for (const auto& [name, value] : facts) {
    if (name == "commit" && std::string(build_facts.commit).empty()) continue;  // of sources that are no checkout
    if (name == "MPI" && misfit::tools::mpi_version().empty()) continue;        // of a build without
    BOOST_REQUIRE(at < said.size());
    BOOST_TEST(std::regex_match(said[at], std::regex(name + std::string(10 - name.size(), ' ') + value)), said[at]);
    ++at;
  }
  BOOST_TEST(at == said.size());
}

BOOST_AUTO_TEST_SUITE_END()
