#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include "imager/files/fits_image.h"
#include "imager/files/fits_image_reader.h"
#include "imager/files/fits_image_writer.h"
#include "tests/example_cube.h"
#include "tests/imager/fits_cards.h"
#include "tests/temporary_folder.h"

BOOST_AUTO_TEST_SUITE(fits_cube)

namespace {

using namespace misfit::imager;
using namespace misfit::imager::testing;
using namespace misfit::testing;
namespace fs = std::filesystem;

void write_planes(ImageWriter& writer, const ImageHeader& header, const std::vector<PlaneIndex>& planes) {
  for (const PlaneIndex& at : planes) writer.write(at, example_plane(header, at), example_beam(at));
}

bool all_nan(const Image& image) {
  return std::all_of(image.pixel.begin(), image.pixel.end(), [](double pixel) { return std::isnan(pixel); });
}

bool empty(const TemporaryFolder& folder) {
  return fs::is_empty(folder / "");
}

}  // namespace

BOOST_AUTO_TEST_CASE(planes_written_in_any_order_lie_where_the_header_has_them) {
  const TemporaryFolder folder;
  const ImageHeader header = example_header(3, "IQ");
  const auto writer = create_fits_image(header, folder / "a.fits", PixelFormat::float32);
  write_planes(*writer, header, {{2, 0}, {0, 1}, {1, 1}, {0, 0}, {2, 1}, {1, 0}});
  writer->finish();
  const auto read = open_fits_image(folder / "a.fits");
  BOOST_TEST(read->header().spectral.channels == 3);
  BOOST_TEST((read->header().stokes == header.stokes));
  for (int channel = 0; channel < 3; ++channel)
    for (int stokes = 0; stokes < 2; ++stokes)
      BOOST_TEST((read->read({channel, stokes}).pixel == example_plane(header, {channel, stokes}).pixel));
}

BOOST_AUTO_TEST_CASE(planes_never_written_are_nan_and_have_no_beam) {
  const TemporaryFolder folder;
  const ImageHeader header = example_header(4);
  const auto writer = create_fits_image(header, folder / "a.fits", PixelFormat::float32);
  write_planes(*writer, header, {{1, 0}});
  writer->finish();
  const auto read = open_fits_image(folder / "a.fits");
  for (const int channel : {0, 2, 3}) {
    BOOST_TEST(all_nan(read->read({channel, 0})));
    BOOST_TEST(!read->beam({channel, 0}).has_value());
  }
  BOOST_TEST((read->read({1, 0}).pixel == example_plane(header, {1, 0}).pixel));
  BOOST_TEST(read->beam({1, 0}).has_value());
}

BOOST_AUTO_TEST_CASE(beams_of_planes_come_back_to_the_single_precision_of_their_table) {
  const TemporaryFolder folder;
  const ImageHeader header = example_header(3, "IQ");
  const auto writer = create_fits_image(header, folder / "a.fits", PixelFormat::float32);
  write_planes(*writer, header, {{0, 0}, {1, 0}, {2, 0}, {0, 1}, {2, 1}});
  writer->finish();
  const std::string fits = contents(folder / "a.fits");
  BOOST_TEST(card(fits, "BMAJ").empty());
  BOOST_TEST(card(fits, "CASAMBM").find(" T ") != std::string::npos);
  BOOST_TEST(number(fits, "NCHAN") == 3);
  BOOST_TEST(number(fits, "NPOL") == 2);
  const auto read = open_fits_image(folder / "a.fits");
  for (const PlaneIndex& at : {PlaneIndex{0, 0}, {1, 0}, {2, 0}, {0, 1}, {2, 1}}) {
    const Beam beam = read->beam(at).value(), wanted = example_beam(at);
    const double rounding = 1.2e-7;  // of a float, twice
    BOOST_TEST(std::abs(beam.major_rad / wanted.major_rad - 1) < rounding);
    BOOST_TEST(std::abs(beam.minor_rad / wanted.minor_rad - 1) < rounding);
    BOOST_TEST(std::abs(beam.position_angle_rad - wanted.position_angle_rad) < rounding);
  }
  BOOST_TEST(!read->beam({1, 1}).has_value());
}

BOOST_AUTO_TEST_CASE(one_beam_of_all_planes_stands_in_the_header_and_none_has_no_card) {
  const TemporaryFolder folder;
  const ImageHeader header = example_header(2);
  const std::optional<Beam> beam = example_beam({0, 0});
  for (const auto& stated : {beam, std::optional<Beam>()}) {
    const auto writer = create_fits_image(header, folder / "a.fits", PixelFormat::float32);
    for (const int channel : {0, 1}) writer->write({channel, 0}, example_plane(header, {channel, 0}), stated);
    writer->finish();
    const std::string fits = contents(folder / "a.fits");
    BOOST_TEST(card(fits, "BMAJ").empty() != stated.has_value());
    BOOST_TEST(card(fits, "CASAMBM").empty());
    BOOST_TEST(open_fits_image(folder / "a.fits")->beam({1, 0}).has_value() == stated.has_value());
  }
}

BOOST_AUTO_TEST_CASE(the_spectral_axis_comes_back) {
  const TemporaryFolder folder;
  const ImageHeader header = example_header(5);
  const auto writer = create_fits_image(header, folder / "a.fits", PixelFormat::float32);
  writer->finish();
  const auto file = open_fits_image(folder / "a.fits");
  const SpectralAxis& read = file->header().spectral;
  BOOST_TEST(read.channels == 5);
  BOOST_TEST(read.reference_hz == header.spectral.reference_hz);
  BOOST_TEST(read.increment_hz == header.spectral.increment_hz);
  BOOST_TEST(read.frame == "LSRK");
  BOOST_TEST(read.rest_frequency_hz == header.spectral.rest_frequency_hz);
  BOOST_TEST(file->header().observation.frequency_hz == header.spectral.frequency_hz(2));
  BOOST_TEST(file->header().observation.bandwidth_hz == 5 * 15625.5);
}

BOOST_AUTO_TEST_CASE(the_header_says_what_viewers_look_for) {
  const TemporaryFolder folder;
  const ImageHeader header = example_header(5);
  create_fits_image(header, folder / "a.fits", PixelFormat::float32)->finish();
  const std::string fits = contents(folder / "a.fits");
  BOOST_TEST(number(fits, "RESTFRQ") == 1.420405751786e9);
  BOOST_TEST(number(fits, "VELREF") == 257);
  // v = c (1 − ν/ν₀), with 15 digits written
  BOOST_TEST(std::abs(number(fits, "ALTRVAL") - 299792458.0 * (1 - 1.42e9 / 1.420405751786e9)) < 1e-6);
  BOOST_TEST(number(fits, "MJD-OBS") == 61071.5);
  BOOST_TEST(number(fits, "ERRASKED") == 2.5e-7);
  for (const auto& [key, value] : {std::pair("SPECSYS", "'LSRK"),
                                   {"SSYSOBS", "'TOPOCENT"},
                                   {"TELESCOP", "'EVLA"},
                                   {"OBSERVER", "'me"},
                                   {"OBJECT", "'M87"},
                                   {"DATE-OBS", "'2026-01-31T12:00:00.0"}})
    BOOST_TEST(card(fits, key).find(value) != std::string::npos);
}

namespace {

/// Puts `value` in the card of a keyword, or a card in place of another where it has none.
void change(std::string& fits, const std::string& keyword, const std::string& value, const std::string& in_place_of = "") {
  const std::string text = (keyword + "        ").substr(0, 8) + "= " + value;
  fits.replace(fits.find(card(fits, in_place_of.empty() ? keyword : in_place_of)), 80,
               (text + std::string(80, ' ')).substr(0, 80));
}

}  // namespace

BOOST_AUTO_TEST_CASE(beams_that_are_not_the_images_hinder_only_those_who_ask) {
  const TemporaryFolder folder;
  const auto written = [&](int channels) {
    const ImageHeader header = example_header(channels);
    const auto writer = create_fits_image(header, folder / "a.fits", PixelFormat::float32);
    for (int channel = 0; channel < channels; ++channel)
      writer->write({channel, 0}, example_plane(header, {channel, 0}),
                    channels == 1 ? std::nullopt : std::optional(example_beam({channel, 0})));
    writer->finish();
    return contents(folder / "a.fits");
  };
  const std::string cube = written(2), plane = written(1);
  std::string cut = plane + cube.substr(cube.find("XTENSION")), half = plane;
  change(half, "BMAJ", "0.01", "OBSERVER");
  std::string other = cut;
  other.replace(other.find("'CHAN"), 5, "'NONE");
  for (const std::string& fits : {cut, half, other}) {
    std::ofstream(folder / "b.fits", std::ios::binary) << fits;
    const auto file = open_fits_image(folder / "b.fits");
    BOOST_TEST((file->read({0, 0}).pixel == example_plane(example_header(1), {0, 0}).pixel));
    BOOST_TEST(read_channel(*file, 0).size() == 1U);
    BOOST_CHECK_EXCEPTION(file->beam({0, 0}), std::runtime_error, [&](const std::exception& error) {
      return std::string(error.what()).find("cannot read " + (folder / "b.fits")) == 0;
    });
    BOOST_CHECK_THROW(read_fits(folder / "b.fits"), std::runtime_error);
  }
}

BOOST_AUTO_TEST_CASE(velocities_along_the_spectral_axis_are_frequencies) {
  const TemporaryFolder folder;
  const ImageHeader header = example_header(5);
  create_fits_image(header, folder / "a.fits", PixelFormat::float32)->finish();
  std::string fits = contents(folder / "a.fits");
  change(fits, "CTYPE3", "'VRAD    '");
  change(fits, "CUNIT3", "'km/s    '");
  change(fits, "CRPIX3", "3.0");
  change(fits, "CRVAL3", "100.0");
  change(fits, "CDELT3", "-2.5");
  std::ofstream(folder / "a.fits", std::ios::binary) << fits;
  const SpectralAxis read = open_fits_image(folder / "a.fits")->header().spectral;
  for (int plane = 0; plane < 5; ++plane) {
    const double velocity_m_s = 1e3 * (100 - 2.5 * (plane - 2));
    const double expected_hz = header.spectral.rest_frequency_hz * (1 - velocity_m_s / 299792458.0);
    BOOST_TEST(std::abs(read.frequency_hz(plane) / expected_hz - 1) < 1e-15 * 4);
  }
}

BOOST_AUTO_TEST_CASE(steps_of_planes_are_stated_by_matrices_too) {
  const TemporaryFolder folder;
  const ImageHeader header = example_header(5);
  create_fits_image(header, folder / "a.fits", PixelFormat::float32)->finish();
  const std::string fits = contents(folder / "a.fits");
  const std::vector<std::pair<std::string, double>> statements{{"PC3_3", 3}, {"PC003003", 3}};
  for (const auto& [keyword, times] : statements) {
    std::string other = fits;
    change(other, keyword, std::to_string(times), "OBSERVER");
    std::ofstream(folder / "a.fits", std::ios::binary) << other;
    BOOST_TEST(open_fits_image(folder / "a.fits")->header().spectral.increment_hz == times * header.spectral.increment_hz);
  }
  std::string other = fits;
  for (const auto& [keyword, in_place_of] : {std::pair("1", "OBSERVER"), {"2", "OBJECT"}})
    change(other, "CD" + std::string(keyword) + "_" + keyword, card(fits, "CDELT" + std::string(keyword)).substr(10),
           in_place_of);
  change(other, "CD3_3", "-4.5E4", "TELESCOP");
  for (const bool stated : {true, false}) {
    if (!stated) change(other, "TELESCOP", "'EVLA'", "CD3_3");  // then CDELT3 holds
    std::ofstream(folder / "a.fits", std::ios::binary) << other;
    BOOST_TEST(open_fits_image(folder / "a.fits")->header().spectral.increment_hz ==
               (stated ? -4.5e4 : header.spectral.increment_hz));
  }
}

BOOST_AUTO_TEST_CASE(axes_of_planes_that_are_not_known_are_refused_by_name) {
  const TemporaryFolder folder;
  create_fits_image(example_header(5), folder / "a.fits", PixelFormat::float32)->finish();
  const std::string fits = contents(folder / "a.fits");
  const auto refused = [&](const std::string& keyword, const std::string& value, const std::string& in_place_of,
                           const std::string& part) {
    std::string other = fits;
    change(other, keyword, value, in_place_of);
    std::ofstream(folder / "a.fits", std::ios::binary) << other;
    for (const Grids grids : {Grids::upright, Grids::any})
      BOOST_CHECK_EXCEPTION(open_fits_image(folder / "a.fits", grids), std::runtime_error, [&](const std::exception& error) {
        BOOST_TEST_INFO(error.what());
        return std::string(error.what()).find(part) != std::string::npos;
      });
  };
  for (const char* type : {"VELO-XYZ", "FREQ-LOG", "FREQ-W2F", "AWAV", ""})
    refused("CTYPE3", "'" + std::string(type) + "'", "", "of type '" + std::string(type) + "' has length 5");
  refused("CUNIT3", "'eV'", "", "the unit eV; expected Hz, kHz");
  refused("PC3_1", "0.5", "OBSERVER", "its PC3_1 is 0.5");
  refused("PC1_4", "0.5", "OBSERVER", "its PC1_4 is 0.5");
  refused("CD2_3", "0.5", "OBSERVER", "its CD2_3 is 0.5");
  refused("PC003002", "0.5", "OBSERVER", "its PC3_2 is 0.5");
  refused("CROTA3", "5", "OBSERVER", "its CROTA3 is 5");
  refused("COMMENT", "'none'", "CRPIX3", "CRPIX3");
  refused("COMMENT", "'none'", "CRVAL3", "CRVAL3");
}

BOOST_AUTO_TEST_CASE(a_writer_that_goes_before_it_is_finished_leaves_nothing_and_keeps_what_was_there) {
  const TemporaryFolder folder;
  const ImageHeader header = example_header(2);
  { const auto writer = create_fits_image(header, folder / "a.fits", PixelFormat::float32); }
  BOOST_TEST(empty(folder));
  std::ofstream(folder / "a.fits") << "of before";
  {
    const auto writer = create_fits_image(header, folder / "a.fits", PixelFormat::float32);
    write_planes(*writer, header, {{1, 0}});
  }
  BOOST_TEST(contents(folder / "a.fits") == "of before");
  BOOST_TEST(std::distance(fs::directory_iterator(folder / ""), fs::directory_iterator()) == 1);
}

BOOST_AUTO_TEST_CASE(planes_that_the_header_does_not_have_are_refused) {
  const TemporaryFolder folder;
  const ImageHeader header = example_header(2);
  const auto writer = create_fits_image(header, folder / "a.fits", PixelFormat::float32);
  for (const PlaneIndex& at : {PlaneIndex{2, 0}, {-1, 0}, {0, 1}, {0, -1}})
    BOOST_CHECK_THROW(writer->write(at, example_plane(header, at), std::nullopt), std::invalid_argument);
  BOOST_CHECK_THROW(writer->write({0, 0}, Image(4, 7), std::nullopt), std::invalid_argument);
  write_planes(*writer, header, {{0, 0}});
  BOOST_CHECK_THROW(write_planes(*writer, header, {{0, 0}}), std::invalid_argument);
  ImageHeader bare = header;
  bare.stokes.clear();
  BOOST_CHECK_THROW(create_fits_image(bare, folder / "b.fits", PixelFormat::float32), std::invalid_argument);
  bare = header;
  bare.spectral.channels = 0;
  BOOST_CHECK_THROW(create_fits_image(bare, folder / "b.fits", PixelFormat::float32), std::invalid_argument);
}

BOOST_AUTO_TEST_CASE(a_history_of_several_blocks_written_after_the_pixels_leaves_them_as_they_are) {
  const TemporaryFolder folder;
  ImageHeader header = example_header(2);
  for (int line = 0; line < 60; ++line) header.history.push_back(std::string(75, 'y'));  // 36 cards make a block
  const auto writer = create_fits_image(header, folder / "a.fits", PixelFormat::float32);
  write_planes(*writer, header, {{0, 0}, {1, 0}});
  writer->finish();
  const auto read = open_fits_image(folder / "a.fits");
  for (const int channel : {0, 1}) BOOST_TEST((read->read({channel, 0}).pixel == example_plane(header, {channel, 0}).pixel));
}

BOOST_AUTO_TEST_SUITE_END()
