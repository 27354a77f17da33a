#include "ms_io/casa_image.h"

#include <casacore/coordinates/Coordinates/DirectionCoordinate.h>
#include <casacore/images/Images/PagedImage.h>

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <map>

#include "imager/files/fits_image_reader.h"
#include "imager/files/fits_image_writer.h"
#include "ms_io/casa_coordinates_internal.h"
#include "tests/example_cube.h"
#include "tests/temporary_folder.h"

BOOST_AUTO_TEST_SUITE(casa_image)

namespace {

using namespace misfit;
using namespace misfit::imager;
using namespace misfit::testing;
namespace fs = std::filesystem;

void write_planes(ImageWriter& writer, const ImageHeader& header, const std::vector<PlaneIndex>& planes) {
  for (const PlaneIndex& at : planes) writer.write(at, example_plane(header, at), example_beam(at));
}

/// Another program's image, whose pixels count.
template <typename Pixel>
void write_foreign(const std::string& path, const casacore::CoordinateSystem& coordinates, const casacore::IPosition& shape) {
  casacore::PagedImage<Pixel> image(casacore::TiledShape(shape), coordinates, path);
  casacore::Array<Pixel> pixels(shape);
  for (std::size_t i = 0; i < pixels.size(); ++i) pixels.data()[i] = static_cast<float>(i);
  image.put(pixels);
}

std::map<std::string, std::string> contents_below(const std::string& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    std::ifstream file(entry.path(), std::ios::binary);
    files[entry.path()] = entry.is_regular_file() ? std::string(std::istreambuf_iterator<char>(file), {}) : "";
  }
  return files;
}

bool all_nan(const Image& image) {
  return std::all_of(image.pixel.begin(), image.pixel.end(), [](double pixel) { return std::isnan(pixel); });
}

std::ptrdiff_t entries(const TemporaryFolder& folder) {
  return std::distance(fs::directory_iterator(folder / ""), fs::directory_iterator());
}

void check_error_names(const std::string& path, const std::string& expected, const std::function<void()>& action) {
  BOOST_CHECK_EXCEPTION(action(), std::runtime_error, [&](const std::exception& error) {
    const std::string message = error.what();
    BOOST_TEST_INFO(message);
    BOOST_TEST(message.find(expected) != message.npos);
    return message.find(path) != message.npos && message.find('\n') == message.npos;
  });
}

}  // namespace

BOOST_AUTO_TEST_CASE(planes_written_in_any_order_come_back_with_their_beams) {
  const TemporaryFolder folder;
  const ImageHeader header = example_header(3, "IQ");
  const auto writer = ms_io::create_casa_image(header, folder / "a.image");
  write_planes(*writer, header, {{2, 0}, {0, 1}, {1, 1}, {0, 0}, {2, 1}, {1, 0}});
  writer->finish();
  const auto read = ms_io::open_casa_image(folder / "a.image");
  for (int channel = 0; channel < 3; ++channel)
    for (int stokes = 0; stokes < 2; ++stokes) {
      const PlaneIndex at{channel, stokes};
      BOOST_TEST((read->read(at).pixel == example_plane(header, at).pixel));
      const Beam beam = read->beam(at).value(), wanted = example_beam(at);
      const double rounding = 1e-15;  // to arcsec and back
      BOOST_TEST(std::abs(beam.major_rad / wanted.major_rad - 1) < rounding);
      BOOST_TEST(std::abs(beam.minor_rad / wanted.minor_rad - 1) < rounding);
      BOOST_TEST(std::abs(beam.position_angle_rad - wanted.position_angle_rad) < rounding);
    }
}

BOOST_AUTO_TEST_CASE(pixels_of_64_bits_come_back_bit_for_bit) {
  const TemporaryFolder folder;
  const ImageHeader header = example_header(1);
  Image image = example_plane(header, {0, 0});
  for (double& pixel : image.pixel) pixel *= 1 + 1e-12;
  const auto writer = ms_io::create_casa_image(header, folder / "a.image", PixelFormat::float64);
  writer->write({0, 0}, image, std::nullopt);
  writer->finish();
  BOOST_TEST((ms_io::open_casa_image(folder / "a.image")->read({0, 0}).pixel == image.pixel));
}

BOOST_AUTO_TEST_CASE(the_header_comes_back) {
  const TemporaryFolder folder;
  for (const char* frame : {"FK5", "ICRS", "FK4"})
    for (const char* spectral_frame : {"LSRK", "TOPOCENT", "BARYCENT", ""}) {
      ImageHeader header = example_header(3, "RRLL");
      header.geometry.phase_centre.frame = frame;
      header.geometry.centre = {1e-4, -2.5e-6};
      header.spectral.frame = spectral_frame;
      header.unit = "Jy/pixel";
      ms_io::create_casa_image(header, folder / "a.image")->finish();
      const auto file = ms_io::open_casa_image(folder / "a.image");
      const ImageHeader& read = file->header();
      const double rounding = 1e-15;
      BOOST_TEST((read.geometry.width == 7 && read.geometry.height == 4));
      BOOST_TEST(std::abs(read.geometry.cell_rad / header.geometry.cell_rad - 1) < rounding);
      BOOST_TEST(std::abs(read.geometry.phase_centre.ra_rad / header.geometry.phase_centre.ra_rad - 1) < rounding);
      BOOST_TEST(std::abs(read.geometry.phase_centre.dec_rad / header.geometry.phase_centre.dec_rad - 1) < rounding);
      BOOST_TEST(std::abs(read.geometry.centre.l - header.geometry.centre.l) < 1e-14 * 1e-4);
      BOOST_TEST(std::abs(read.geometry.centre.m - header.geometry.centre.m) < 1e-14 * 1e-4);
      BOOST_TEST(read.geometry.phase_centre.frame == frame);
      BOOST_TEST(read.spectral.reference_hz == header.spectral.reference_hz);
      BOOST_TEST(read.spectral.increment_hz == header.spectral.increment_hz);
      BOOST_TEST(read.spectral.channels == 3);
      BOOST_TEST(read.spectral.frame == spectral_frame);
      BOOST_TEST(read.spectral.rest_frequency_hz == header.spectral.rest_frequency_hz);
      BOOST_TEST((read.stokes == header.stokes));
      BOOST_TEST(read.unit == "Jy/pixel");
      BOOST_TEST(read.observation.telescope == "EVLA");
      BOOST_TEST(read.observation.observer == "me");
      BOOST_TEST(read.observation.object == "M87");
      BOOST_TEST(read.observation.date_obs.find("2026-01-31T12:00:00") == 0);
    }
}

BOOST_AUTO_TEST_CASE(planes_evenly_spaced_in_wavelength_come_back) {
  const TemporaryFolder folder;
  for (const double increment_hz : {1e6, -4e6}) {
    ImageHeader header = example_header(9);
    header.spectral.in_wavelength = true;
    header.spectral.increment_hz = increment_hz;
    header.spectral.rest_frequency_hz = 1.42e9;
    ms_io::create_casa_image(header, folder / "a.image")->finish();
    create_fits_image(header, folder / "a.fits", PixelFormat::float32)->finish();
    const auto casa = ms_io::open_casa_image(folder / "a.image");
    const auto fits = open_fits_image(folder / "a.fits", Grids::any);
    for (const SpectralAxis& read : {casa->header().spectral, fits->header().spectral}) {
      BOOST_TEST(read.in_wavelength);
      for (int plane = 0; plane < 9; ++plane)  // a few roundings of frequencies of 1e9 Hz
        BOOST_TEST(std::abs(read.frequency_hz(plane) - header.spectral.frequency_hz(plane)) < 1e-5);
    }
  }
}

BOOST_AUTO_TEST_CASE(planes_never_written_are_nan_and_have_no_beam) {
  const TemporaryFolder folder;
  const ImageHeader header = example_header(4);
  const auto writer = ms_io::create_casa_image(header, folder / "a.image");
  write_planes(*writer, header, {{1, 0}});
  writer->finish();
  const auto read = ms_io::open_casa_image(folder / "a.image");
  for (const int channel : {0, 2, 3}) {
    BOOST_TEST(all_nan(read->read({channel, 0})));
    BOOST_TEST(!read->beam({channel, 0}).has_value());
  }
  BOOST_TEST((read->read({1, 0}).pixel == example_plane(header, {1, 0}).pixel));
  BOOST_TEST(read->beam({1, 0}).has_value());
}

BOOST_AUTO_TEST_CASE(pixels_without_value_are_masked_and_images_without_them_have_no_mask) {
  const TemporaryFolder folder;
  const ImageHeader header = example_header(3);
  for (const bool holes : {false, true}) {
    const auto writer = ms_io::create_casa_image(header, folder / "a.image");
    for (const int channel : {0, 1, 2}) {
      Image image = example_plane(header, {channel, 0});
      if (holes && channel == 1) image.at(2, 3) = std::numeric_limits<double>::quiet_NaN();
      writer->write({channel, 0}, image, std::nullopt);
    }
    writer->finish();
    BOOST_TEST(fs::exists(folder / "a.image/mask0") == holes);
    const auto read = ms_io::open_casa_image(folder / "a.image");
    for (const int channel : {0, 1, 2}) {
      const Image image = read->read({channel, 0});
      BOOST_TEST(std::isnan(image.at(2, 3)) == (holes && channel == 1));
      BOOST_TEST(std::isfinite(image.at(2, 4)));
    }
  }
}

BOOST_AUTO_TEST_CASE(planes_of_several_tiles_come_back) {
  const TemporaryFolder folder;
  ImageHeader header = example_header(2);
  header.geometry.width = 700;
  header.geometry.height = 1100;
  const auto writer = ms_io::create_casa_image(header, folder / "a.image");
  Image image = example_plane(header, {1, 0});
  for (const int row : {0, 511, 512, 1099}) image.at(row, row / 2) = std::numeric_limits<double>::quiet_NaN();
  writer->write({1, 0}, image, std::nullopt);
  writer->finish();
  const Image read = ms_io::open_casa_image(folder / "a.image")->read({1, 0});
  int wrong = 0;
  for (std::size_t i = 0; i < image.pixel.size(); ++i)
    wrong += image.pixel[i] != read.pixel[i] && !(std::isnan(image.pixel[i]) && std::isnan(read.pixel[i]));
  BOOST_TEST(wrong == 0);
}

BOOST_AUTO_TEST_CASE(reading_changes_nothing_in_the_folder) {
  const TemporaryFolder folder;
  const ImageHeader header = example_header(2);
  const auto writer = ms_io::create_casa_image(header, folder / "a.image");
  write_planes(*writer, header, {{1, 0}});
  writer->finish();
  const auto before = contents_below(folder / "a.image");
  ms_io::open_casa_image(folder / "a.image")->read({0, 0});
  BOOST_TEST(ms_io::is_own_casa_image(folder / "a.image"));
  BOOST_TEST((contents_below(folder / "a.image") == before));
}

BOOST_AUTO_TEST_CASE(images_of_two_axes_or_of_another_order_are_read) {
  const TemporaryFolder folder;
  const casacore::CoordinateSystem whole = ms_io::casa_coordinates(example_header(3, "IQ"));
  casacore::CoordinateSystem flat, turned;
  flat.addCoordinate(whole.directionCoordinate());
  write_foreign<float>(folder / "flat", flat, casacore::IPosition(2, 7, 4));
  for (const int coordinate : {0, 2, 1}) turned.addCoordinate(whole.coordinate(static_cast<casacore::uInt>(coordinate)));
  write_foreign<float>(folder / "turned", turned, casacore::IPosition(4, 7, 4, 3, 2));
  const auto one = ms_io::open_casa_image(folder / "flat"), other = ms_io::open_casa_image(folder / "turned");
  BOOST_TEST(one->header().spectral.channels == 1);
  BOOST_TEST((one->header().stokes == std::vector<Stokes>{Stokes::I}));
  BOOST_TEST(one->read({0, 0}).at(3, 2) == 3 * 7 + 2);
  BOOST_TEST(other->header().spectral.channels == 3);
  BOOST_TEST(other->read({2, 1}).at(3, 2) == ((1 * 3 + 2) * 4 + 3) * 7 + 2);
  BOOST_TEST(!ms_io::is_own_casa_image(folder / "flat"));
}

BOOST_AUTO_TEST_CASE(images_that_misfit_could_not_place_are_refused) {
  const TemporaryFolder folder;
  const casacore::DirectionCoordinate sine = ms_io::casa_coordinates(example_header(1)).directionCoordinate();
  const auto refused = [&](const casacore::Projection& projection, double cell_rad, double angle_rad,
                           const std::string& expected) {
    casacore::Matrix<double> turn(2, 2);
    turn(0, 0) = turn(1, 1) = std::cos(angle_rad);
    turn(0, 1) = std::sin(angle_rad);
    turn(1, 0) = -turn(0, 1);
    casacore::CoordinateSystem coordinates;
    coordinates.addCoordinate(
        casacore::DirectionCoordinate(casacore::MDirection::J2000, projection, 1, 0.5, -cell_rad, cell_rad, turn, 3, 2));
    const std::string path = folder / std::to_string(entries(folder));
    write_foreign<float>(path, coordinates, casacore::IPosition(2, 7, 4));
    check_error_names(path, expected, [&] { ms_io::open_casa_image(path); });
  };
  refused(casacore::Projection(casacore::Projection::TAN), 1e-2, 0, "projection is TAN; expected SIN");
  refused(sine.projection(), 1e-6, 0.01, "turned by");
  refused(casacore::Projection(casacore::Projection::CAR), 1e-6, 0, "projection is CAR; expected SIN, TAN");
  casacore::CoordinateSystem coordinates;
  coordinates.addCoordinate(sine);
  write_foreign<casacore::Complex>(folder / "complex", coordinates, casacore::IPosition(2, 7, 4));
  check_error_names(folder / "complex", "no real numbers", [&] { ms_io::open_casa_image(folder / "complex"); });
}

BOOST_AUTO_TEST_CASE(coordinates_without_an_axis_of_pixels_say_of_all_pixels_what_they_are_of) {
  const TemporaryFolder folder;
  const ImageHeader header = example_header(3, "IQUV");
  for (const int channel : {0, 2})
    for (const int stokes : {0, 1, 3}) {
      casacore::CoordinateSystem coordinates = ms_io::casa_coordinates(header);
      BOOST_REQUIRE(coordinates.removePixelAxis(3, channel));
      BOOST_REQUIRE(coordinates.removePixelAxis(2, stokes));
      const std::string path = folder / std::to_string(10 * channel + stokes);
      write_foreign<float>(path, coordinates, casacore::IPosition(2, 7, 4));
      const auto image = ms_io::open_casa_image(path);
      BOOST_TEST((image->header().stokes == std::vector{header.stokes[static_cast<std::size_t>(stokes)]}));
      BOOST_TEST(image->header().spectral.channels == 1);
      BOOST_TEST(std::abs(image->header().spectral.reference_hz - header.spectral.frequency_hz(channel)) < 1e-3);
      BOOST_TEST(image->header().observation.frequency_hz == image->header().spectral.reference_hz);
      BOOST_TEST(image->read({0, 0}).at(3, 2) == 3 * 7 + 2);
    }
}

BOOST_AUTO_TEST_CASE(frames_that_images_have_not_are_refused_by_name) {
  const TemporaryFolder folder;
  for (const char* frame : {"AZEL", "HADEC", "APP", "JTRUE", "JMEAN", "ITRF", "TOPO", "MARS", "ECLIPTIC", "nonsense"}) {
    const std::string path = folder / frame;
    casacore::CoordinateSystem flat;
    flat.addCoordinate(ms_io::casa_coordinates(example_header(1)).directionCoordinate());
    write_foreign<float>(path, flat, casacore::IPosition(2, 7, 4));
    {
      casacore::Table table(path, casacore::Table::Update);
      table.rwKeywordSet().rwSubRecord("coords").rwSubRecord("direction0").define("system", frame);
    }
    for (const Grids grids : {Grids::upright, Grids::any})
      check_error_names(path, "its directions are in " + std::string(frame) + "; expected J2000, ICRS, B1950 or GALACTIC",
                        [&] { ms_io::open_casa_image(path, grids); });
  }
}

BOOST_AUTO_TEST_CASE(tables_that_an_image_says_are_its_own_lie_in_it) {
  const TemporaryFolder folder;
  const ImageHeader header = example_header(1);
  const auto made = [&](const std::string& name) {
    const auto writer = ms_io::create_casa_image(header, folder / name);
    Image plane = example_plane(header, {0, 0});
    plane.pixel.front() = std::numeric_limits<double>::quiet_NaN();  // so it has a mask
    writer->write({0, 0}, plane, std::nullopt);
    writer->finish();
    return folder / name;
  };
  const std::string other = made("other.im");
  const auto masks_of = [](casacore::Table& table) -> casacore::TableRecord& {
    return table.rwKeywordSet().rwSubRecord("masks").rwSubRecord("mask0");
  };
  const auto refused = [&](const std::string& name, const std::string& why, const auto& change) {
    const std::string path = made(name);
    ms_io::open_casa_image(path);
    {
      casacore::Table table(path, casacore::Table::Update);
      change(table);
    }
    check_error_names(path, why, [&] { ms_io::open_casa_image(path); });
  };
  refused("mask.im", "its mask is the table " + other + "/mask0",
          [&](casacore::Table& table) { masks_of(table).defineTable("mask", casacore::Table(other + "/mask0")); });
  refused("log.im", "its logtable is the table " + other + "/logtable",
          [&](casacore::Table& table) { table.rwKeywordSet().defineTable("logtable", casacore::Table(other + "/logtable")); });
  refused("kind.im", "its mask0 is a LCLELMask", [&](casacore::Table& table) { masks_of(table).define("name", "LCLELMask"); });
  fs::rename(folder / "other.im", folder / "moved.im");
  ms_io::open_casa_image(folder / "moved.im");
}

BOOST_AUTO_TEST_CASE(an_image_replaces_another_and_leaves_nothing_else) {
  const TemporaryFolder folder;
  ms_io::create_casa_image(example_header(1), folder / "a.image")->finish();
  ms_io::create_casa_image(example_header(2), folder / "a.image/")->finish();
  BOOST_TEST(ms_io::open_casa_image(folder / "a.image")->header().spectral.channels == 2);
  BOOST_TEST(entries(folder) == 1);
}

BOOST_AUTO_TEST_CASE(a_writer_that_goes_before_it_is_finished_leaves_nothing_and_keeps_what_was_there) {
  const TemporaryFolder folder;
  const ImageHeader header = example_header(2);
  {
    const auto writer = ms_io::create_casa_image(header, folder / "a.image");
    write_planes(*writer, header, {{1, 0}});
  }
  BOOST_TEST(entries(folder) == 0);
  ms_io::create_casa_image(header, folder / "a.image")->finish();
  {
    const auto writer = ms_io::create_casa_image(header, folder / "a.image");
    BOOST_CHECK_THROW(writer->write({0, 0}, Image(1, 1), std::nullopt), std::invalid_argument);
  }
  BOOST_TEST(entries(folder) == 1);
  BOOST_TEST(all_nan(ms_io::open_casa_image(folder / "a.image")->read({1, 0})));
}

BOOST_AUTO_TEST_CASE(what_a_killed_run_left_is_replaced_and_what_others_left_is_not) {
  const TemporaryFolder folder;
  const ImageHeader header = example_header(1);
  for (const char* left : {"a.image.part", "a.image.old"}) {
    ms_io::create_casa_image(header, folder / left)->finish();
    fs::remove(folder / (left + std::string("/table.dat")));
  }
  ms_io::create_casa_image(header, folder / "a.image")->finish();
  BOOST_TEST(entries(folder) == 1);
  fs::create_directory(folder / "a.image.part");
  std::ofstream(folder / "a.image.part/precious") << "yes";
  check_error_names(folder / "a.image", "in the way", [&] { ms_io::create_casa_image(header, folder / "a.image"); });
  BOOST_TEST(fs::exists(folder / "a.image.part/precious"));
  BOOST_TEST(ms_io::is_casa_image(folder / "a.image"));
}

BOOST_AUTO_TEST_CASE(what_is_no_casacore_image_is_refused_and_left_alone) {
  const TemporaryFolder folder;
  fs::create_directory(folder / "a.image");
  std::ofstream(folder / "a.image/precious") << "yes";
  std::ofstream(folder / "b.image") << "a file";
  for (const std::string& path : {folder / "a.image", folder / "b.image"}) {
    check_error_names(path, "no casacore image", [&] { ms_io::create_casa_image(example_header(1), path); });
    check_error_names(path, "no casacore image", [&] { ms_io::open_casa_image(path); });
  }
  BOOST_TEST(fs::exists(folder / "a.image/precious"));
  BOOST_TEST(entries(folder) == 2);
  check_error_names(folder / "no/such", "write", [&] { ms_io::create_casa_image(example_header(1), folder / "no/such"); });
  {
    const auto writer = ms_io::create_casa_image(example_header(1), folder / "c.image");
    fs::create_directory(folder / "c.image");  // while the image is made
    check_error_names(folder / "c.image", "no casacore image", [&] { writer->finish(); });
  }
  BOOST_TEST(fs::is_empty(folder / "c.image"));
  BOOST_TEST(entries(folder) == 3);
}

/// casacore has a cache of open tables by their names.
BOOST_AUTO_TEST_CASE(a_path_leads_to_the_image_that_lies_there_while_one_before_is_open) {
  const TemporaryFolder folder;
  const imager::ImageHeader header = example_header(1);
  imager::Image image = example_plane(header, {0, 0});
  const auto write = [&] {
    const auto writer = ms_io::create_casa_image(header, folder / "a.image");
    writer->write({0, 0}, image, std::nullopt);
    writer->finish();
  };
  write();
  const auto before = ms_io::open_casa_image(folder / "a.image");
  const double was = before->read({0, 0}).pixel[3];
  image.pixel[3] = 2;
  write();
  BOOST_TEST(ms_io::open_casa_image(folder / "a.image")->read({0, 0}).pixel[3] == 2);
  BOOST_TEST(before->read({0, 0}).pixel[3] == was);
}

BOOST_AUTO_TEST_SUITE_END()
