#include "imager/files/fits_image.h"

#include <bit>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>

#include "imager/files/fits_image_reader.h"
#include "tests/imager/fits_cards.h"
#include "tests/stated_fits.h"
#include "tests/temporary_folder.h"

BOOST_AUTO_TEST_SUITE(fits_image)

namespace {

using namespace misfit::imager;
using namespace misfit::imager::testing;
using misfit::testing::TemporaryFolder;
namespace fs = std::filesystem;

constexpr double degree = M_PI / 180;

SkyImage example(int width = 7, int height = 4) {
  SkyImage sky;
  sky.image = Image(width, height);
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (double& value : sky.image.pixel) value = normal(random);
  sky.geometry = {width, height, 0.2 / 3600 * degree, {187.7 * degree, -12.3 * degree, "FK5"}};
  sky.observation = {"EVLA", "me", "M87", "2026-01-31T12:00:00.0", sky.geometry.phase_centre, 1.5e9, 64e6, "TOPOCENT"};
  sky.has_beam = true;
  sky.beam = {3e-6, 2e-6, -0.4};
  return sky;
}

/// Of a file of 64-bit pixels, big-endian, after a header of one or more blocks of 2880 bytes.
std::vector<double> all_pixels(const std::string& fits) {
  const std::size_t end = fits.find(("END" + std::string(77, ' ')));
  const std::size_t begin = (end / 2880 + 1) * 2880;
  const auto count = static_cast<std::size_t>(number(fits, "NAXIS1") * number(fits, "NAXIS2") * number(fits, "NAXIS4"));
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i) {
    std::uint64_t bits = 0;
    for (std::size_t byte = 0; byte < 8; ++byte) bits = bits << 8 | static_cast<unsigned char>(fits.at(begin + 8 * i + byte));
    values.push_back(std::bit_cast<double>(bits));
  }
  return values;
}

/// Writes the example with one header card exchanged.
void write_altered(const std::string& path, const std::string& keyword, const std::string& new_card) {
  write_fits(example(), path, PixelFormat::float64);
  std::string fits = contents(path);
  fits.replace(fits.find(card(fits, keyword)), 80, (new_card + std::string(80, ' ')).substr(0, 80));
  std::ofstream(path, std::ios::binary) << fits;
}

void check_error_names(const std::string& path, const std::string& expected, const std::function<void()>& action) {
  BOOST_CHECK_EXCEPTION(action(), std::runtime_error, [&](const std::exception& error) {
    const std::string message = error.what();
    BOOST_TEST_INFO(message);
    BOOST_TEST(message.find(expected) != message.npos);
    return message.find(path) != message.npos;
  });
}

}  // namespace

BOOST_AUTO_TEST_CASE(pixels_of_64_bits_come_back_bit_for_bit) {
  const TemporaryFolder folder;
  SkyImage sky = example(300, 200);
  sky.image.at(0, 1) = std::numeric_limits<double>::denorm_min();
  sky.image.at(1, 2) = std::numeric_limits<double>::infinity();
  sky.image.at(2, 2) = std::numeric_limits<double>::max();
  write_fits(sky, folder / "a.fits", PixelFormat::float64);
  const SkyImage read = read_fits(folder / "a.fits");
  BOOST_TEST(read.image.width == 300);
  BOOST_TEST(read.image.height == 200);
  BOOST_TEST((read.image.pixel == sky.image.pixel));
}

BOOST_AUTO_TEST_CASE(pixels_of_32_bits_come_back_rounded_to_single_precision) {
  const TemporaryFolder folder;
  const SkyImage sky = example();
  write_fits(sky, folder / "a.fits", PixelFormat::float32);
  const SkyImage read = read_fits(folder / "a.fits");
  for (std::size_t i = 0; i < sky.image.pixel.size(); ++i)
    BOOST_TEST(read.image.pixel[i] == static_cast<double>(static_cast<float>(sky.image.pixel[i])));
}

BOOST_AUTO_TEST_CASE(pixels_without_value_are_ieee_nan_in_the_file_and_when_read) {
  const TemporaryFolder folder;
  for (const PixelFormat format : {PixelFormat::float32, PixelFormat::float64}) {
    SkyImage sky = example();
    sky.image.at(2, 3) = std::numeric_limits<double>::quiet_NaN();
    write_fits(sky, folder / "a.fits", format);
    const SkyImage read = read_fits(folder / "a.fits");
    BOOST_TEST(std::isnan(read.image.at(2, 3)));
    BOOST_TEST(std::isfinite(read.image.at(2, 4)));
    const std::string fits = contents(folder / "a.fits");
    const std::size_t bytes = format == PixelFormat::float32 ? 4 : 8;
    const std::size_t at = fits.size() - 2880 + (2 * 7 + 3) * bytes;
    BOOST_TEST((fits[at] & 0x7f) == 0x7f);  // big-endian: the exponent of NaN is all ones
    BOOST_TEST((fits[at + 1] & 0xc0) == 0xc0);
  }
}

BOOST_AUTO_TEST_CASE(what_the_header_states_comes_back) {
  const TemporaryFolder folder;
  const SkyImage sky = example();
  write_fits(sky, folder / "a.fits", PixelFormat::float32);
  const SkyImage read = read_fits(folder / "a.fits");
  const double rounding = 1e-14;  // 15 digits are written
  BOOST_TEST(read.geometry.width == 7);
  BOOST_TEST(read.geometry.height == 4);
  BOOST_TEST(std::abs(read.geometry.cell_rad / sky.geometry.cell_rad - 1) < rounding);
  BOOST_TEST(std::abs(read.geometry.phase_centre.ra_rad / sky.geometry.phase_centre.ra_rad - 1) < rounding);
  BOOST_TEST(std::abs(read.geometry.phase_centre.dec_rad / sky.geometry.phase_centre.dec_rad - 1) < rounding);
  BOOST_TEST(read.observation.phase_centre.frame == "FK5");
  BOOST_TEST(read.observation.frequency_hz == 1.5e9);
  BOOST_TEST(read.observation.bandwidth_hz == 64e6);
  BOOST_TEST(read.observation.telescope == "EVLA");
  BOOST_TEST(read.observation.object == "M87");
  BOOST_TEST(read.observation.date_obs == "2026-01-31T12:00:00.0");
  BOOST_TEST(read.observation.spectral_frame == "TOPOCENT");
  BOOST_TEST(read.unit == "Jy/beam");
  BOOST_TEST(read.has_beam);
  BOOST_TEST(std::abs(read.beam.major_rad / sky.beam.major_rad - 1) < rounding);
  BOOST_TEST(std::abs(read.beam.minor_rad / sky.beam.minor_rad - 1) < rounding);
  BOOST_TEST(std::abs(read.beam.position_angle_rad / sky.beam.position_angle_rad - 1) < rounding);
}

BOOST_AUTO_TEST_CASE(every_frame_comes_back) {
  const TemporaryFolder folder;
  for (const char* frame : {"ICRS", "FK5", "FK4"}) {
    SkyImage sky = example();
    sky.geometry.phase_centre.frame = frame;
    write_fits(sky, folder / "a.fits", PixelFormat::float32);
    BOOST_TEST(read_fits(folder / "a.fits").geometry.phase_centre.frame == frame);
  }
}

BOOST_AUTO_TEST_CASE(the_header_places_pixels_where_the_geometry_has_them) {
  const TemporaryFolder folder;
  SkyImage sky = example();
  std::string fits;
  for (const DirectionCosines& centre : {DirectionCosines{1e-4, -2.5e-6}, DirectionCosines{-0.2, 0.3}, DirectionCosines{}}) {
    sky.geometry.centre = centre;
    write_fits(sky, folder / "a.fits", PixelFormat::float32);
    fits = contents(folder / "a.fits");
    const double rounding = 2e-14 * (std::hypot(centre.l, centre.m) + 7 * sky.geometry.cell_rad);
    for (int column = 0; column < 7; ++column) {
      const double x_deg = (column + 1 - number(fits, "CRPIX1")) * number(fits, "CDELT1");
      BOOST_TEST(std::abs(x_deg * degree - sky.geometry.l(column)) < rounding);
    }
    for (int row = 0; row < 4; ++row) {
      const double y_deg = (row + 1 - number(fits, "CRPIX2")) * number(fits, "CDELT2");
      BOOST_TEST(std::abs(y_deg * degree - sky.geometry.m(row)) < rounding);
    }
  }
  BOOST_TEST(number(fits, "CRPIX1") == 4);
  BOOST_TEST(number(fits, "CRPIX2") == 3);
  BOOST_TEST(number(fits, "NAXIS") == 4);
  BOOST_TEST(number(fits, "CRVAL1") == 187.7);
  BOOST_TEST(number(fits, "CRVAL2") == -12.3);
  BOOST_TEST(number(fits, "RESTFRQ") == 1.5e9);
  BOOST_TEST(number(fits, "EQUINOX") == 2000);
  for (const auto& [key, value] : {std::pair("CTYPE1", "'RA---SIN'"),
                                   {"CTYPE2", "'DEC--SIN'"},
                                   {"CTYPE3", "'FREQ"},
                                   {"CTYPE4", "'STOKES"},
                                   {"RADESYS", "'FK5"},
                                   {"BUNIT", "'Jy/beam"},
                                   {"BTYPE", "'Intensity"},
                                   {"ORIGIN", "'misfit"},
                                   {"TIMESYS", "'UTC"}})
    BOOST_TEST(card(fits, key).find(value) != std::string::npos);
}

BOOST_AUTO_TEST_CASE(an_image_off_the_phase_centre_comes_back_where_it_was) {
  const TemporaryFolder folder;
  SkyImage sky = example();
  const double cell = sky.geometry.cell_rad;
  for (const double aspect : {1.0, 1.00001})
    for (const auto& [l, m] : {std::pair(2 * cell, -3 * cell), {0.4 * cell, 0.7 * cell}, {-0.31, 0.22}, {0.5, 0.0}}) {
      sky.geometry.centre = {l, m};
      sky.geometry.pixel_aspect = aspect;
      write_fits(sky, folder / "a.fits", PixelFormat::float32);
      const ImageGeometry read = read_fits(folder / "a.fits").geometry;
      // 15 digits of CRPIX and CDELT are written: each is right to 5e-15.
      BOOST_TEST(std::abs(read.centre.l - l) < 2e-14 * (std::abs(l) + 7 * cell));
      BOOST_TEST(std::abs(read.centre.m - m) < 2e-14 * (std::abs(m) + 7 * cell));
      BOOST_TEST(std::abs(read.pixel_aspect / aspect - 1) < 2e-14);
      BOOST_TEST(std::abs(read.phase_centre.ra_rad / sky.geometry.phase_centre.ra_rad - 1) < 1e-14);
      BOOST_TEST(std::abs(read.phase_centre.dec_rad / sky.geometry.phase_centre.dec_rad - 1) < 1e-14);
    }
}

BOOST_AUTO_TEST_CASE(an_image_on_the_phase_centre_comes_back_exactly_there) {
  const TemporaryFolder folder;
  write_fits(example(), folder / "a.fits", PixelFormat::float32);
  const DirectionCosines centre = read_fits(folder / "a.fits").geometry.centre;
  BOOST_TEST(centre.l == 0);
  BOOST_TEST(centre.m == 0);
}

BOOST_AUTO_TEST_CASE(cards_and_long_history_are_written) {
  const TemporaryFolder folder;
  SkyImage sky = example();
  sky.cards = {{"MFERRRMS", 2.5e-7, "expected error"}};
  sky.history = {"misfit image " + std::string(200, 'x'), "done"};
  write_fits(sky, folder / "a.fits", PixelFormat::float32);
  const std::string fits = contents(folder / "a.fits");
  BOOST_TEST(number(fits, "MFERRRMS") == 2.5e-7);
  BOOST_TEST(card(fits, "MFERRRMS").find("/ expected error") != std::string::npos);
  std::string history;
  for (std::size_t i = 0; i + 80 <= fits.size(); i += 80)
    if (fits.compare(i, 8, "HISTORY ") == 0) history += fits.substr(i + 8, 72);
  BOOST_TEST(history.find(sky.history[0]) == 0);
  BOOST_TEST(history.find("done") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(letters_that_no_header_may_have_become_question_marks) {
  const TemporaryFolder folder;
  SkyImage sky = example();
  sky.observation.observer = "M\xc3\xbcller \x9c\x1b[2J\n'";
  sky.history = {"misfit image --vis b\xc3\xa4r.ms\t"};
  write_fits(sky, folder / "a.fits", PixelFormat::float32);
  const std::string fits = contents(folder / "a.fits");
  BOOST_TEST(card(fits, "OBSERVER").substr(0, 32) == "OBSERVER= 'M?ller ??[2J?'''     ");
  BOOST_TEST(card(fits, "HISTORY").substr(0, 40) == "HISTORY misfit image --vis b?r.ms?      ");
}

BOOST_AUTO_TEST_CASE(an_image_without_beam_has_none) {
  const TemporaryFolder folder;
  SkyImage sky = example();
  sky.has_beam = false;
  write_fits(sky, folder / "a.fits", PixelFormat::float32);
  BOOST_TEST(card(contents(folder / "a.fits"), "BMAJ").empty());
  BOOST_TEST(!read_fits(folder / "a.fits").has_beam);
}

BOOST_AUTO_TEST_CASE(names_that_cfitsio_would_parse_are_plain_names) {
  const TemporaryFolder folder;
  const auto before = fs::current_path();
  fs::current_path(folder / "");
  for (const char* name : {"a[1:2,3].fits", "b(c).fits", "d+1", "!e.fits", "~f.fits", "mem:g.fits", " h i.fits"}) {
    BOOST_TEST_INFO(name);
    write_fits(example(), name, PixelFormat::float32);
    BOOST_TEST(fs::exists(name));
    BOOST_CHECK_NO_THROW(read_fits(name));
  }
  fs::current_path(before);
}

BOOST_AUTO_TEST_CASE(writing_replaces_and_leaves_nothing_else_behind) {
  const TemporaryFolder folder;
  write_fits(example(7, 4), folder / "a.fits", PixelFormat::float32);
  write_fits(example(5, 6), folder / "a.fits", PixelFormat::float32);
  BOOST_TEST(read_fits(folder / "a.fits").image.width == 5);
  BOOST_TEST(std::distance(fs::directory_iterator(folder / ""), fs::directory_iterator()) == 1);
}

BOOST_AUTO_TEST_CASE(a_place_that_cannot_be_written_is_an_error_that_names_it) {
  const TemporaryFolder folder;
  const std::string missing = folder / "no/such/folder.fits", taken = folder / "taken";
  check_error_names(missing, "write", [&] { write_fits(example(), missing, PixelFormat::float32); });
  fs::create_directories(taken + "/full");
  check_error_names(taken, "write", [&] { write_fits(example(), taken, PixelFormat::float32); });
  BOOST_TEST(std::distance(fs::directory_iterator(folder / ""), fs::directory_iterator()) == 1);
}

BOOST_AUTO_TEST_CASE(a_card_that_cannot_be_written_leaves_no_file) {
  const TemporaryFolder folder;
  SkyImage sky = example();
  sky.cards = {{"BAD", std::numeric_limits<double>::quiet_NaN(), ""}};
  check_error_names(folder / "a.fits", "", [&] { write_fits(sky, folder / "a.fits", PixelFormat::float32); });
  BOOST_TEST(fs::is_empty(folder / ""));
}

BOOST_AUTO_TEST_CASE(a_file_that_is_missing_cut_short_or_no_image_is_an_error_that_names_it) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.fits";
  check_error_names(path, "read", [&] { read_fits(path); });
  write_fits(example(100, 100), path, PixelFormat::float64);
  fs::resize_file(path, fs::file_size(path) / 2);
  check_error_names(path, "read", [&] { read_fits(path); });
  std::ofstream(path) << "not FITS at all";
  check_error_names(path, "read", [&] { read_fits(path); });
  write_altered(path, "NAXIS1", "NAXIS1  =           2000000000");
  check_error_names(path, "read", [&] { read_fits(path); });
}

BOOST_AUTO_TEST_CASE(geometry_that_is_not_known_is_an_error_that_says_why) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.fits";
  const auto refused = [&](const std::string& keyword, const std::string& new_card, const std::string& expected) {
    write_altered(path, keyword, new_card);
    check_error_names(path, expected, [&] { read_fits(path); });
  };
  refused("CDELT1", "CDELT1  = -5.6E-05", "square");
  refused("CDELT1", "CDELT1  = 5.55555555555556E-05", "mirrored");
  refused("CDELT2", "COMMENT", "CDELT2");
  refused("CRPIX1", "COMMENT", "CRPIX1");
  refused("CTYPE1", "CTYPE1  = 'RA---TAN'", "RA---TAN");
  refused("BTYPE", "CROTA2  = 12.0", "turned by -12 degrees");
  refused("CRVAL2", "CRVAL2  = 90.5", "its CRVAL2 is 90.5 degrees; expected at most 90");
  refused("CRVAL1", "CRVAL1  = -1E300", "CRVAL1");
}

BOOST_AUTO_TEST_CASE(headers_are_looked_at_before_memory_is_taken) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.fits";
  const auto refused = [&](const std::string& keyword, const std::string& new_card, const std::string& expected) {
    write_altered(path, keyword, new_card);
    check_error_names(path, expected, [&] { read_fits(path); });
  };
  refused("NAXIS3", "NAXIS3  =  4000000000000000000", "more data than the file has");
  refused("NAXIS1", "NAXIS1  =                   -1", "NAXIS1 is -1");
  refused("NAXIS1", "NAXIS   =                    1", "no NAXIS1 where one is due");
  write_fits(example(), path, PixelFormat::float64);
  std::string fits = contents(path);
  std::ofstream(path, std::ios::binary) << fits.replace(0, 9, "\x1f\x8b\x08 IMPLE");
  check_error_names(path, "it is no FITS file, but one compressed by gzip: uncompress it first, with gunzip",
                    [&] { read_fits(path); });
}

BOOST_AUTO_TEST_CASE(values_that_are_no_numbers_or_contradict_each_other_are_named) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.fits";
  const auto refused = [&](const std::string& keyword, const std::string& new_card, const std::string& expected) {
    write_altered(path, keyword, new_card);
    check_error_names(path, expected, [&] { read_fits(path); });
  };
  for (const char* key : {"CRPIX1  ", "CRVAL2  ", "CDELT1  ", "RESTFRQ ", "EQUINOX "})
    for (const char* value : {"abc", "1.5x", "J1999", "0x10"}) {
      const std::string name = std::string(key).substr(0, std::string(key).find(' '));
      refused(name, std::string(key) + "= '" + value + "'", "its " + name + " is '" + value + "'; expected a number");
    }
  refused("CRPIX1", "CRPIX1  = T", "its CRPIX1 is 'T'; expected a number");
  refused("BTYPE", "CRPIX1  = 20.", "its header has CRPIX1 twice, as");
  refused("BTYPE", "CTYPE4  = 'FREQ'", "its header has CTYPE4 twice, as");
  refused("BTYPE", "RADESYS = 'ICRS'", "its header has RADESYS twice, as ICRS and as FK5; expected one of them");
}

BOOST_AUTO_TEST_CASE(numbers_may_be_written_and_written_again_in_any_way_of_fits) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.fits";
  for (const auto& [keyword, new_card] : {std::pair("CRPIX1", "CRPIX1  = +0.4D1"),
                                          {"CRPIX1", "CRPIX1  = '4.0'"},
                                          {"CRPIX1", "CRPIX1  = 4"},
                                          {"BTYPE", "CRPIX1  = 4.0"},
                                          {"BTYPE", "RADESYS = 'FK5'"},
                                          {"EQUINOX", "EQUINOX = 'J2000'"},
                                          {"EQUINOX", "EQUINOX = 'J2000.0'"},
                                          {"EQUINOX", "EQUINOX = '2000.0'"}}) {
    write_altered(path, keyword, new_card);
    BOOST_TEST(read_fits(path).geometry.centre.l == 0, new_card);
    BOOST_TEST(read_fits(path).geometry.phase_centre.frame == "FK5", new_card);
  }
}

BOOST_AUTO_TEST_CASE(axes_beyond_those_of_pixels_say_of_all_pixels_what_they_are_of) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.fits";
  for (const Stokes stokes : {Stokes::I, Stokes::Q, Stokes::V, Stokes::XX})
    for (const double reference_pixel : {1.0, 0.0, 3.0})
      for (const bool stokes_first : {true, false}) {
        const std::string s = stokes_first ? "3" : "4", f = stokes_first ? "4" : "3";
        using misfit::testing::stated;
        misfit::testing::write_stated_fits(path, Image(7, 4),
                                           {{"CTYPE1", "'RA---SIN'"},
                                            {"CTYPE2", "'DEC--SIN'"},
                                            {"CRPIX1", "4."},
                                            {"CRPIX2", "3."},
                                            {"CRVAL1", "187."},
                                            {"CRVAL2", "12."},
                                            {"CDELT1", "-0.01"},
                                            {"CDELT2", "0.01"},
                                            {"CTYPE" + s, "'STOKES'"},
                                            {"CRPIX" + s, "1."},
                                            {"CRVAL" + s, stated(fits_stokes_code(stokes))},
                                            {"CTYPE" + f, "'FREQ'"},
                                            {"CRPIX" + f, stated(reference_pixel)},
                                            {"CRVAL" + f, "5.0E9"},
                                            {"CDELT" + f, "4.0E6"}});
        const auto file = open_fits_image(path);
        BOOST_TEST((file->header().stokes == std::vector{stokes}));
        BOOST_TEST(file->header().spectral.channels == 1);
        BOOST_TEST(file->header().spectral.reference_hz == 5e9 + (1 - reference_pixel) * 4e6);
        BOOST_TEST(file->read({0, 0}).width == 7);
      }
}

BOOST_AUTO_TEST_CASE(a_stack_of_planes_is_no_image) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.fits";
  write_altered(path, "NAXIS3", "NAXIS3  =                    2");
  check_error_names(path, "2 frequencies; expected one", [&] { read_fits(path); });
}

BOOST_AUTO_TEST_CASE(integers_with_a_scale_and_blanks_are_read) {
  const TemporaryFolder folder;
  std::string fits;
  for (const char* text : {"SIMPLE  =                    T", "BITPIX  =                   16", "NAXIS   =                    2",
                           "NAXIS1  =                    2", "NAXIS2  =                    1", "BSCALE  =                  0.5",
                           "BZERO   =                   1.0", "BLANK   =                   -1",
                           "CRPIX1  =                  2.0", "CRPIX2  =                  1.0", "CDELT1  =                 -0.1",
                           "CDELT2  =                  0.1", "CTYPE1  = 'RA---SIN'", "CTYPE2  = 'DEC--SIN'",
                           "CRVAL1  =                   10", "CRVAL2  =                   20", "END"})
    fits += (text + std::string(80, ' ')).substr(0, 80);
  fits.resize(2880, ' ');
  fits += std::string("\x00\x06\xff\xff", 4);
  fits.resize(2 * 2880, '\0');
  std::ofstream(folder / "a.fits", std::ios::binary) << fits;
  const SkyImage read = read_fits(folder / "a.fits");
  BOOST_TEST(read.image.at(0, 0) == 4);
  BOOST_TEST(std::isnan(read.image.at(0, 1)));
  BOOST_TEST(read.geometry.phase_centre.frame == "ICRS");
}

BOOST_AUTO_TEST_CASE(planes_lie_along_the_stokes_axis_with_codes_that_say_which_they_are) {
  const TemporaryFolder folder;
  for (const std::string list : {"I", "IQUV", "IV", "RRLL", "YX"}) {
    std::vector<SkyImage> planes;
    for (const Stokes stokes : parse_stokes(list)) {
      planes.push_back(example());
      planes.back().stokes = stokes;
      for (double& pixel : planes.back().image.pixel) pixel += 10.0 * static_cast<double>(planes.size());
    }
    write_fits(planes, folder / "a.fits", PixelFormat::float64);
    const std::string fits = contents(folder / "a.fits");
    const std::vector<double> values = all_pixels(fits);
    const std::size_t each = planes.front().image.pixel.size();
    BOOST_TEST_REQUIRE(values.size() == each * planes.size());
    const double first = number(fits, "CRVAL4"), step = number(fits, "CDELT4");
    for (std::size_t p = 0; p < planes.size(); ++p) {
      BOOST_TEST(first + static_cast<double>(p) * step == fits_stokes_code(planes[p].stokes));
      for (std::size_t i = 0; i < each; ++i) BOOST_TEST(values[p * each + i] == planes[p].image.pixel[i]);
    }
  }
}

BOOST_AUTO_TEST_CASE(planes_that_do_not_fit_together_are_not_written) {
  const TemporaryFolder folder;
  std::vector<SkyImage> planes(3, example());
  BOOST_CHECK_THROW(write_fits(std::vector<SkyImage>(), folder / "a.fits", PixelFormat::float32), std::invalid_argument);
  BOOST_CHECK_THROW(write_fits(planes, folder / "a.fits", PixelFormat::float32), std::invalid_argument);  // I three times
  planes[1].stokes = Stokes::Q;
  planes[2].stokes = Stokes::V;
  BOOST_CHECK_THROW(write_fits(planes, folder / "a.fits", PixelFormat::float32), std::invalid_argument);
  planes[2] = example(3, 3);
  planes[2].stokes = Stokes::U;
  BOOST_CHECK_THROW(write_fits(planes, folder / "a.fits", PixelFormat::float32), std::invalid_argument);
  BOOST_TEST(fs::is_empty(folder / ""));
}

BOOST_AUTO_TEST_SUITE_END()
