#include "tools/formats/component_list.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>
#include <sstream>

#include "ms_io/celestial_frames.h"
#include "tests/temporary_folder.h"

BOOST_AUTO_TEST_SUITE(component_list)

namespace {

using namespace misfit;
using misfit::imager::Source;
using misfit::testing::TemporaryFolder;

constexpr double degree = M_PI / 180;
constexpr double arcsec = degree / 3600;
const imager::SkyDirection phase_centre{60 * degree, 40 * degree, "FK5"};

std::vector<Source> read(const std::string& text) {
  const TemporaryFolder folder;
  std::ofstream(folder / "list.csv", std::ios::binary) << text;
  return tools::read_component_list(folder / "list.csv", phase_centre);
}

std::string content(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path, std::ios::binary).rdbuf();
  return text.str();
}

/// The message is one line with the file's name and all of `parts`.
void check_error(const std::string& text, const std::vector<std::string>& parts) {
  BOOST_TEST_CONTEXT(text) {
    BOOST_CHECK_EXCEPTION(read(text), std::runtime_error, [&](const std::exception& error) {
      const std::string message = error.what();
      BOOST_TEST_INFO(message);
      for (const std::string& part : parts) {
        BOOST_TEST_INFO(part);
        BOOST_TEST(message.find(part) != message.npos);
      }
      BOOST_TEST(message.find("expected") != message.npos);
      return message.find("list.csv, line ") != message.npos && message.find_first_of("\r\n\t") == message.npos;
    });
  }
}

double distance(imager::DirectionCosines a, imager::DirectionCosines b) {
  return std::hypot(a.l - b.l, a.m - b.m);
}

}  // namespace

BOOST_AUTO_TEST_CASE(direction_cosines_are_given_in_arcseconds) {
  const auto sources = read("l_arcsec,m_arcsec,flux_jy\n3600,-7200,1.5\n0,0,-2e-3\n");
  BOOST_REQUIRE(sources.size() == 2u);
  BOOST_TEST(std::abs(sources[0].position.l / degree - 1) < 1e-15);
  BOOST_TEST(std::abs(sources[0].position.m / degree + 2) < 1e-15);
  BOOST_TEST(sources[0].flux_jy == 1.5);
  BOOST_TEST(sources[0].fwhm_rad == 0);
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

BOOST_AUTO_TEST_CASE(directions_are_in_the_frame_that_the_list_states) {
  for (const auto& [name, radesys] : {std::pair{"J2000", "FK5"}, {"ICRS", "ICRS"}, {"B1950", "FK4"}, {"FK4", "FK4"}}) {
    const std::string list = std::string("ra_deg,dec_deg,flux_jy,frame\n60,40,1,") + name + "\n";
    const auto there = ms_io::in_frame({60 * degree, 40 * degree, radesys}, phase_centre.frame);
    const auto expected = imager::direction_cosines(there, phase_centre);
    BOOST_TEST(distance(read(list).at(0).position, expected) < 1e-15);
  }
  check_error("ra_deg,dec_deg,flux_jy,frame\n60,40,1,APP\n", {"line 2", "frame is 'APP', expected J2000, ICRS or B1950"});
  check_error("l_arcsec,m_arcsec,flux_jy,frame\n1,2,3,ICRS\n", {"line 1", "column 'frame' stands without ra_deg and dec_deg"});
}

BOOST_AUTO_TEST_CASE(a_scale_is_the_full_width_at_half_maximum_whatever_the_coordinates) {
  for (const std::string columns : {"ra_deg,dec_deg", "l_arcsec,m_arcsec"}) {
    const auto sources = read(columns + ",flux_jy,scale_arcsec\n60,40,1,2.5\n60,40,1,0\n");
    BOOST_REQUIRE(sources.size() == 2u);
    BOOST_TEST(std::abs(sources[0].fwhm_rad / arcsec - 2.5) < 1e-14);
    BOOST_TEST(sources[1].fwhm_rad == 0);
  }
}

BOOST_AUTO_TEST_CASE(spectra_are_given_by_an_index_and_the_frequency_of_the_flux) {
  const auto sources = read("l_arcsec,m_arcsec,flux_jy,spectral_index,reference_frequency_hz\n1,2,3,-0.7,1.4e9\n1,2,3,0,1e9\n");
  BOOST_TEST((sources.at(0).spectral_index == -0.7 && sources.at(0).reference_hz == 1.4e9));
  BOOST_TEST(sources.at(1).spectral_index == 0);
  BOOST_TEST(read("l_arcsec,m_arcsec,flux_jy\n1,2,3\n").at(0).spectral_index == 0);
  check_error("l_arcsec,m_arcsec,flux_jy,spectral_index\n1,2,3,-0.7\n", {"no column 'reference_frequency_hz'"});
  check_error("l_arcsec,m_arcsec,flux_jy,reference_frequency_hz\n1,2,3,1e9\n", {"no column 'spectral_index'"});
  check_error("l_arcsec,m_arcsec,flux_jy,spectral_index,reference_frequency_hz\n1,2,3,-0.7,0\n",
              {"line 2", "reference_frequency_hz is '0'"});
}

BOOST_AUTO_TEST_CASE(columns_may_come_in_any_order_among_comments_blanks_carriage_returns_and_behind_a_byte_order_mark) {
  const auto sources = read(
      "\xef\xbb\xbf# made by hand\r\n\r\n flux_jy , scale_arcsec,m_arcsec,\tl_arcsec\r\n# one\r\n +2 , 1, 10,20 \r\n   \r\n");
  BOOST_REQUIRE(sources.size() == 1u);
  BOOST_TEST(sources[0].flux_jy == 2);
  BOOST_TEST(std::abs(sources[0].fwhm_rad / arcsec - 1) < 1e-15);
  BOOST_TEST(std::abs(sources[0].position.l / sources[0].position.m - 2) < 1e-15);
  BOOST_TEST(read("\xef\xbb\xbfl_arcsec,m_arcsec,flux_jy\r\n1,2,3").size() == 1u);
  BOOST_TEST(read("l_arcsec,m_arcsec,flux_jy").empty());
}

BOOST_AUTO_TEST_CASE(a_line_of_columns_that_cannot_be_understood_is_quoted) {
  check_error("ra_deg,m_arcsec,flux_jy\n", {"line 1", "no column 'dec_deg'", "ra_deg,dec_deg,flux_jy"});
  check_error("l_arcsec,flux_jy\n", {"line 1", "no column 'm_arcsec'"});
  check_error("ra_deg,dec_deg,scale_arcsec\n", {"line 1", "no column 'flux_jy'"});
  check_error("l_arcsec,m_arcsec,flux\n", {"line 1", "unknown column 'flux'", "flux_jy"});
  check_error("l_arcsec,m_arcsec,flux_jy,scale_arcmin\n", {"line 1", "unknown column 'scale_arcmin'", "scale_arcsec"});
  check_error("l_arcsec,m_arcsec,flux_jy,flux_jy\n", {"line 1", "column 'flux_jy' appears twice"});
  check_error("l_arcsec,m_arcsec,flux_jy,\n", {"line 1", "unknown column ''"});
  check_error("ra_deg,dec_deg,flux_jy,l_arcsec,m_arcsec\n", {"line 1", "positions are given twice"});
  check_error("\n# comment\nl_arcsec;m_arcsec;flux_jy\n", {"line 3", "separated by ';'", "l_arcsec,m_arcsec,flux_jy"});
  check_error("60,40,1\n", {"line 1", "unknown column '60'"});
  check_error("", {"line 1", "ends before", "flux_jy"});
  check_error("# nothing\n\n", {"line 2", "ends before"});
  check_error(std::string("\xff\xfel\0_\0", 6), {"line 1", "UTF-16"});
  check_error(std::string("\x7f"
                          "ELF\x01\x02\t\r\0",
                          9) +
                  std::string(1000, 'x') + "\n",
              {"line 1", "ELF??", "…'"});
}

BOOST_AUTO_TEST_CASE(a_value_that_cannot_be_is_quoted_with_its_line) {
  const std::string header = "l_arcsec,m_arcsec,flux_jy,scale_arcsec\r\n";
  check_error(header + "1,2,3\n", {"line 2", "3 values, expected 4"});
  check_error(header + "\n1,2,3,4,5\n", {"line 3", "5 values, expected 4"});
  check_error(header + "1,2,bright,0\n", {"line 2", "flux_jy is 'bright', expected a finite number"});
  check_error(header + "1,,3,0\n", {"line 2", "m_arcsec is '', expected a finite number"});
  check_error(header + "1,2,3 Jy,0\n", {"line 2", "'3 Jy'"});
  check_error(header + "nan,2,3,0\n", {"line 2", "l_arcsec is 'nan'"});
  check_error(header + "1,2,inf,0\n", {"line 2", "flux_jy is 'inf'"});
  check_error(header + "1,2,1e999,0\n", {"line 2", "'1e999', expected a finite number"});
  check_error(header + "1;2;3;4\n", {"line 2", "1 values, expected 4"});
  check_error(header + "1,2,3,4\n1,2,3,-1\n", {"line 3", "scale_arcsec is '-1'", "0 (a point) or more"});
  check_error(header + "1,2,3,nan\n", {"line 2", "scale_arcsec is 'nan'"});
  check_error(header + "1,2,3,inf\n", {"line 2", "scale_arcsec is 'inf'"});
  check_error(header + "206265,0,1,0\n", {"line 2", "l_arcsec '206265', m_arcsec '0'", "beyond the horizon"});
  check_error("ra_deg,dec_deg,flux_jy\n60,91,1\n", {"line 2", "dec_deg is '91', expected -90 to 90"});
  check_error("ra_deg,dec_deg,flux_jy\n361,9,1\n", {"line 2", "ra_deg is '361', expected -360 to 360"});
  check_error("ra_deg,dec_deg,flux_jy\n240,-40,1\n", {"line 2", "ra_deg '240', dec_deg '-40'", "within 90 degrees"});
}

BOOST_AUTO_TEST_CASE(a_file_that_cannot_be_read_is_an_error) {
  BOOST_CHECK_THROW(tools::read_component_list("/no/such/list.csv", phase_centre), std::runtime_error);
  BOOST_CHECK_THROW(tools::read_component_list(std::filesystem::temp_directory_path(), phase_centre), std::runtime_error);
}

BOOST_AUTO_TEST_CASE(what_is_written_is_read_again_near_poles_and_the_origin_of_right_ascension_too) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const TemporaryFolder folder;
  for (const double dec_deg : {-90.0, -89.9999, -30.0, 0.0, 60.0, 89.99999, 90.0})
    for (const double ra_deg : {0.0, 1e-7, 123.4, 359.99999999, -20.0}) {
      const imager::SkyDirection centre{ra_deg * degree, dec_deg * degree, "ICRS"};
      std::vector<Source> sources{{{0, 0}, 1.0 / 3}, {{-1e-20, 0}, -0.0}, {{0.9, -0.4}, 1e-300, 1e-9}};
      for (int i = 0; i < 100; ++i) {
        const double radius = std::pow(10, -9 * std::abs(uniform(random))), angle = M_PI * uniform(random);
        sources.push_back({{0.99 * radius * std::cos(angle), 0.99 * radius * std::sin(angle)},
                           uniform(random),
                           std::max(0.0, 1e-4 * uniform(random))});
      }
      tools::write_component_list(folder / "list.csv", sources, centre);
      const std::vector<Source> back = tools::read_component_list(folder / "list.csv", centre);
      BOOST_REQUIRE(back.size() == sources.size());
      for (std::size_t s = 0; s < back.size(); ++s) {
        // Degrees up to 360 in double precision are 1e-15 rad apart.
        BOOST_TEST(distance(back[s].position, sources[s].position) < 1e-14);
        BOOST_TEST(back[s].flux_jy == sources[s].flux_jy);
        BOOST_TEST(std::abs(back[s].fwhm_rad - sources[s].fwhm_rad) <= 4e-16 * sources[s].fwhm_rad);
      }
    }
}

BOOST_AUTO_TEST_CASE(the_first_line_written_names_the_columns_and_right_ascensions_lie_within_a_turn) {
  const TemporaryFolder folder;
  tools::write_component_list(folder / "list.csv", {{{0, 0}, 1.5, 2 * arcsec}, {{-1e-20, 0}, 0.1}}, {0, 0, "FK5"});
  const std::string columns = "ra_deg,dec_deg,flux_jy,scale_arcsec,frame\n";
  BOOST_TEST(content(folder / "list.csv") == columns + "0,0,1.5,2,J2000\n0,0,0.1,0,J2000\n");
  BOOST_TEST(tools::listed_frame(folder / "list.csv") == "FK5");
  std::ofstream(folder / "list.csv", std::ios::app) << "0,0,1,0,ICRS\n";
  BOOST_CHECK_THROW(tools::listed_frame(folder / "list.csv"), std::runtime_error);
  tools::write_component_list(folder / "list.csv", {}, phase_centre);
  BOOST_TEST(content(folder / "list.csv") == columns);
}

BOOST_AUTO_TEST_CASE(what_is_no_source_is_not_written_and_the_list_that_was_there_stays) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const TemporaryFolder folder;
  const std::string path = folder / "list.csv";
  tools::write_component_list(path, {{{0.1, 0.2}, 1}}, phase_centre);
  const std::string before = content(path);
  for (const Source& source : {Source{{0.8, 0.7}, 1}, Source{{nan, 0}, 1}, Source{{0, 0}, nan}, Source{{0, 0}, 1, -1e-9},
                               Source{{0, 0}, 1, nan}, Source{{0, 0}, 1 / 0.0}})
    BOOST_CHECK_EXCEPTION(tools::write_component_list(path, {{{0, 0}, 1}, source}, phase_centre), std::runtime_error,
                          [&](const std::exception& error) {
                            const std::string message = error.what();
                            return message.find(path + ", line 3: ") == 0 && message.find("expected") != message.npos;
                          });
  BOOST_TEST(content(path) == before);
  BOOST_CHECK_THROW(tools::write_component_list(folder / "none" + "/list.csv", {}, phase_centre), std::runtime_error);
}

BOOST_AUTO_TEST_SUITE_END()
