#include "tools/sky.h"

#include <unistd.h>

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numeric>

namespace {

using namespace misfit;
using misfit::imager::Source;

constexpr double degree = M_PI / 180;
const imager::SkyDirection phase_centre{60 * degree, 40 * degree, "FK5"};

struct TemporaryFile {
  std::string path = (std::filesystem::temp_directory_path() / ("misfit_sky_" + std::to_string(getpid()) + ".csv")).string();
  explicit TemporaryFile(const std::string& text) { std::ofstream(path, std::ios::binary) << text; }
  ~TemporaryFile() { std::filesystem::remove(path); }
};

std::vector<Source> read(const std::string& text) {
  return tools::read_component_list(TemporaryFile(text).path, phase_centre);
}

void check_error(const std::string& text, const std::string& place, const std::string& expected) {
  BOOST_CHECK_EXCEPTION(read(text), std::runtime_error, [&](const std::exception& error) {
    const std::string message = error.what();
    BOOST_TEST_INFO(message);
    BOOST_TEST(message.find(place) != message.npos);
    BOOST_TEST(message.find(expected) != message.npos);
    return message.find("misfit_sky_") != message.npos;
  });
}

}  // namespace

BOOST_AUTO_TEST_SUITE(sky)

BOOST_AUTO_TEST_CASE(direction_cosines_are_given_in_arcseconds) {
  const auto sources = read("l_arcsec,m_arcsec,flux_jy\n3600,-7200,1.5\n0,0,-2e-3\n");
  BOOST_REQUIRE(sources.size() == 2u);
  BOOST_TEST(std::abs(sources[0].position.l / degree - 1) < 1e-15);
  BOOST_TEST(std::abs(sources[0].position.m / degree + 2) < 1e-15);
  BOOST_TEST(sources[0].flux_jy == 1.5);
  BOOST_TEST(sources[1].flux_jy == -2e-3);
}

BOOST_AUTO_TEST_CASE(equatorial_positions_become_direction_cosines) {
  const auto sources = read("ra_deg,dec_deg,flux_jy\n60,40,1\n60,41,1\n60.5,40,1\n");
  BOOST_REQUIRE(sources.size() == 3u);
  BOOST_TEST(std::hypot(sources[0].position.l, sources[0].position.m) < 1e-15);
  BOOST_TEST(std::abs(sources[1].position.m - std::sin(degree)) < 1e-15);
  const auto expected = imager::direction_cosines({60.5 * degree, 40 * degree, "FK5"}, phase_centre);
  BOOST_TEST(sources[2].position.l == expected.l);
  BOOST_TEST(sources[2].position.l > 0);
}

BOOST_AUTO_TEST_CASE(columns_may_come_in_any_order_among_comments_blanks_and_carriage_returns) {
  const auto sources = read("# made by hand\r\n\r\n flux_jy , m_arcsec,\tl_arcsec\r\n# one\r\n +2 , 10,20 \r\n   \r\n");
  BOOST_REQUIRE(sources.size() == 1u);
  BOOST_TEST(sources[0].flux_jy == 2);
  BOOST_TEST(std::abs(sources[0].position.l / sources[0].position.m - 2) < 1e-15);
}

BOOST_AUTO_TEST_CASE(errors_name_the_file_the_line_and_what_was_expected) {
  const std::string header = "l_arcsec,m_arcsec,flux_jy\n";
  check_error("ra_deg,m_arcsec,flux_jy\n", "line 1", "ra_deg,dec_deg,flux_jy");
  check_error("l_arcsec,m_arcsec,flux\n", "line 1", "flux_jy");
  check_error("l_arcsec,m_arcsec,flux_jy,flux_jy\n", "line 1", "flux_jy");
  check_error("", "line 0", "expected a header");
  check_error(header + "1,2\n", "line 2", "expected 3");
  check_error(header + "\n1,2,3,4\n", "line 3", "expected 3");
  check_error(header + "1,2,bright\n", "line 2", "'bright', expected a finite number");
  check_error(header + "1,,3\n", "line 2", "expected a finite number");
  check_error(header + "1,2,3 Jy\n", "line 2", "expected a finite number");
  check_error(header + "nan,2,3\n", "line 2", "expected a finite number");
  check_error(header + "1,2,inf\n", "line 2", "expected a finite number");
  check_error(header + "1,2,1e999\n", "line 2", "expected a finite number");
  check_error(header + "206265,0,1\n", "line 2", "not on the sky");
  check_error("ra_deg,dec_deg,flux_jy\n60,91,1\n", "line 2", "-90 to 90");
  check_error("ra_deg,dec_deg,flux_jy\n240,-40,1\n", "line 2", "90 degrees");
}

BOOST_AUTO_TEST_CASE(a_file_that_cannot_be_read_is_an_error) {
  BOOST_CHECK_THROW(tools::read_component_list("/no/such/list.csv", phase_centre), std::runtime_error);
  BOOST_CHECK_THROW(tools::read_component_list(std::filesystem::temp_directory_path(), phase_centre), std::runtime_error);
}

BOOST_AUTO_TEST_CASE(the_test_card_has_34_sources_within_390_cells) {
  const double cell_rad = 1e-7;
  const auto card = tools::test_card(cell_rad);
  BOOST_TEST(card.size() == 34u);
  double total_jy = 0, farthest = 0;
  for (const Source& source : card) {
    total_jy += source.flux_jy;
    farthest = std::max({farthest, std::abs(source.position.l), std::abs(source.position.m)});
  }
  BOOST_TEST(total_jy == 52);  // 10 of 2 Jy, 20 of 1 Jy, 4 of 3 Jy
  BOOST_TEST(std::abs(farthest / cell_rad - 390) < 1e-9);
  // The third source tells east from west and north from south.
  BOOST_TEST(std::abs(card[2].position.l / cell_rad + 120) < 1e-9);
  BOOST_TEST(std::abs(card[2].position.m / cell_rad - 180) < 1e-9);
}

BOOST_AUTO_TEST_SUITE_END()
