#include <casacore/coordinates/Coordinates/DirectionCoordinate.h>
#include <casacore/coordinates/Coordinates/LinearCoordinate.h>
#include <casacore/coordinates/Coordinates/SpectralCoordinate.h>
#include <casacore/images/Images/FITSImage.h>
#include <casacore/images/Images/PagedImage.h>

#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <memory>

#include "imager/files/fits_image_writer.h"
#include "ms_io/casa_coordinates_internal.h"
#include "ms_io/casa_image.h"
#include "tests/example_cube.h"
#include "tests/temporary_folder.h"

// The FITS file and the CASA image of one header, both as casacore reads them.

BOOST_AUTO_TEST_SUITE(image_coordinates)

namespace {

using namespace misfit;
using namespace misfit::imager;
using namespace misfit::testing;

constexpr double degree = M_PI / 180;

struct Place {
  const char* name;
  ImageGeometry geometry;
};

const std::vector<Place> places{
    {"even size", {8, 6, 1e-6, {3.2, -0.2, "FK5"}}},
    {"odd size", {7, 5, 1e-6, {3.2, -0.2, "ICRS"}}},
    {"wide", {101, 100, 5e-3, {6.2, 0.7, "FK5"}}},
    {"off the phase centre", {6, 9, 1e-5, {0.001, 1.2, "FK5"}, {0.1, -0.07}}},
    {"between pixels", {6, 9, 1e-5, {0.001, 1.2, "FK5"}, {0.4e-5, 0.7e-5}}},
    {"beside the north pole", {64, 65, 1e-4, {1.5, 90 * degree - 1e-3, "FK5"}}},
    {"at the north pole", {9, 8, 1e-4, {1.5, 90 * degree, "ICRS"}}},
    {"at the south pole", {9, 8, 1e-4, {4, -90 * degree, "FK5"}}},
    {"in B1950", {9, 8, 1e-4, {4, -0.5, "FK4"}}},
};

std::ostream& operator<<(std::ostream& to, const Place& place) {
  return to << place.name;
}

ImageHeader header_of(const Place& place) {
  ImageHeader header = example_header(5, "IQ");
  header.geometry = place.geometry;
  header.observation.phase_centre = place.geometry.phase_centre;
  return header;
}

/// The pixels in the corners, in the middle, and at the phase centre.
std::vector<std::array<double, 2>> pixels(const ImageGeometry& g) {
  const double right = g.width - 1, top = g.height - 1;
  return {{0, 0},
          {right, 0},
          {0, top},
          {right, top},
          {std::floor(right / 2), std::floor(top / 2)},
          {double(g.centre_column()), double(g.centre_row())}};
}

/// Radians, radians, casacore's Stokes code, Hz.
std::array<double, 4> world(const casacore::ImageInterface<float>& image, std::array<double, 2> pixel, const PlaneIndex& at) {
  casacore::CoordinateSystem coordinates = image.coordinates();
  casacore::Vector<casacore::String> units(4, "rad");
  const int stokes = coordinates.polarizationAxisNumber(), spectral = coordinates.spectralAxisNumber();
  units[static_cast<std::size_t>(stokes)] = "";
  units[static_cast<std::size_t>(spectral)] = "Hz";
  BOOST_REQUIRE(coordinates.setWorldAxisUnits(units));
  casacore::Vector<double> from(4), to(4);
  from[0] = pixel[0];
  from[1] = pixel[1];
  from[static_cast<std::size_t>(stokes)] = at.stokes;
  from[static_cast<std::size_t>(spectral)] = at.channel;
  BOOST_REQUIRE(coordinates.toWorld(to, from));
  return {to[0], to[1], to[static_cast<std::size_t>(stokes)], to[static_cast<std::size_t>(spectral)]};
}

/// The angle between two directions, degrees.
double apart_deg(const SkyDirection& a, double ra_rad, double dec_rad) {
  const double dec = dec_rad - a.dec_rad, ra = ra_rad - a.ra_rad;
  const double half = std::pow(std::sin(dec / 2), 2) + std::cos(a.dec_rad) * std::cos(dec_rad) * std::pow(std::sin(ra / 2), 2);
  return 2 * std::asin(std::sqrt(half)) / degree;
}

void check_coordinates(const casacore::ImageInterface<float>& image, const ImageHeader& header) {
  for (const auto& pixel : pixels(header.geometry))
    for (const PlaneIndex& at : {PlaneIndex{0, 0}, {4, 1}, {2, 0}}) {
      const auto has = world(image, pixel, at);
      const DirectionCosines cosines = header.geometry.at(static_cast<int>(pixel[1]), static_cast<int>(pixel[0]));
      const SkyDirection expected = sky_direction(cosines, header.geometry.phase_centre);
      BOOST_TEST(apart_deg(expected, has[0], has[1]) < 1e-9);
      BOOST_TEST(has[2] == static_cast<double>(header.stokes[static_cast<std::size_t>(at.stokes)]));
      BOOST_TEST(std::abs(has[3] / header.spectral.frequency_hz(at.channel) - 1) < 1e-9);
    }
  const auto type = image.coordinates().directionCoordinate().directionType();
  const std::string& frame = header.geometry.phase_centre.frame;
  BOOST_TEST(type == (frame == "ICRS"  ? casacore::MDirection::ICRS
                      : frame == "FK4" ? casacore::MDirection::B1950
                                       : casacore::MDirection::J2000));
  const casacore::SpectralCoordinate spectral = image.coordinates().spectralCoordinate();
  BOOST_TEST(spectral.frequencySystem() == casacore::MFrequency::LSRK);
  BOOST_TEST(std::abs(spectral.restFrequency() / header.spectral.rest_frequency_hz - 1) < 1e-14);  // FITS has 15 digits
}

void check_description(const casacore::ImageInterface<float>& image) {
  const casacore::ObsInfo info = image.coordinates().obsInfo();
  BOOST_TEST(info.telescope() == "EVLA");
  BOOST_TEST(info.observer() == "me");
  BOOST_TEST(std::abs(info.obsDate().get("d").getValue() - 61071.5) < 1e-9);
  BOOST_TEST(image.imageInfo().objectName() == "M87");
  BOOST_TEST(image.units().getName() == "Jy/beam");
}

}  // namespace

BOOST_DATA_TEST_CASE(both_formats_place_pixels_and_planes_where_the_header_does, boost::unit_test::data::make(places), place) {
  const TemporaryFolder folder;
  const ImageHeader header = header_of(place);
  create_fits_image(header, folder / "a.fits", PixelFormat::float32)->finish();
  ms_io::create_casa_image(header, folder / "a.image")->finish();
  const casacore::FITSImage fits(folder / "a.fits");
  const casacore::PagedImage<float> casa(folder / "a.image");
  check_coordinates(fits, header);
  check_coordinates(casa, header);
  check_description(fits);
  check_description(casa);
}

BOOST_AUTO_TEST_CASE(both_formats_hold_the_same_pixels_masks_and_beams) {
  const TemporaryFolder folder;
  const ImageHeader header = example_header(4, "IQ");
  const std::unique_ptr<ImageWriter> writers[]{create_fits_image(header, folder / "a.fits", PixelFormat::float32),
                                               ms_io::create_casa_image(header, folder / "a.image")};
  for (const auto& writer : writers) {
    for (const PlaneIndex& at : {PlaneIndex{3, 0}, {1, 0}, {1, 1}, {0, 1}}) {
      Image image = example_plane(header, at);
      image.at(at.channel, 2) = std::nan("");
      writer->write(at, image, example_beam(at));
    }
    writer->finish();
  }
  const casacore::FITSImage fits(folder / "a.fits");
  const casacore::PagedImage<float> casa(folder / "a.image");
  for (int channel = 0; channel < 4; ++channel)
    for (int stokes = 0; stokes < 2; ++stokes) {
      for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 7; ++column) {
          const casacore::IPosition in_fits(4, column, row, channel, stokes), in_casa(4, column, row, stokes, channel);
          const float a = fits.getAt(in_fits), b = casa.getAt(in_casa);
          BOOST_TEST((a == b || (std::isnan(a) && std::isnan(b))));
          const casacore::IPosition one(4, 1);
          BOOST_TEST(casa.getMaskSlice(in_casa, one).data()[0] == !std::isnan(b));
        }
      const casacore::GaussianBeam a = fits.imageInfo().restoringBeam(channel, stokes),
                                   b = casa.imageInfo().restoringBeam(channel, stokes);
      const double rounding = 1.2e-7;  // FITS holds them in single precision
      BOOST_TEST(std::abs(a.getMajor("arcsec") / b.getMajor("arcsec") - 1) < rounding);
      BOOST_TEST(std::abs(a.getMinor("arcsec") / b.getMinor("arcsec") - 1) < rounding);
      BOOST_TEST(std::abs(a.getPA("rad", true) - b.getPA("rad", true)) < rounding);
    }
}

BOOST_AUTO_TEST_CASE(a_casa_image_tells_its_history_and_numbers) {
  const TemporaryFolder folder;
  const ImageHeader header = example_header(1);
  ms_io::create_casa_image(header, folder / "a.image")->finish();
  const casacore::PagedImage<float> casa(folder / "a.image");
  std::vector<std::string> lines;
  for (auto line = casa.logger().begin(); line != casa.logger().end(); ++line) lines.push_back(line->message());
  BOOST_TEST(lines == header.history, boost::test_tools::per_element());
  BOOST_TEST(casa.miscInfo().asDouble("ERRASKED") == 2.5e-7);
}

BOOST_AUTO_TEST_CASE(planes_have_the_frequencies_that_casacore_finds_for_them) {
  const ImageHeader header = example_header(5);
  for (const double times : {1.0, 2.5, -0.5}) {
    const TemporaryFolder folder;
    casacore::SpectralCoordinate stretched(casacore::MFrequency::LSRK, header.spectral.reference_hz,
                                           header.spectral.increment_hz, 1.25, header.spectral.rest_frequency_hz);
    BOOST_REQUIRE(stretched.setLinearTransform(casacore::Matrix<double>(1, 1, times)));
    casacore::CoordinateSystem coordinates = ms_io::casa_coordinates(header);
    coordinates.replaceCoordinate(stretched, static_cast<casacore::uInt>(coordinates.spectralCoordinateNumber()));
    {
      casacore::PagedImage<float>(casacore::TiledShape(casacore::IPosition(4, 7, 4, 1, 5)), coordinates, folder / "a.image")
          .set(0);
    }
    const SpectralAxis axis = ms_io::open_casa_image(folder / "a.image")->header().spectral;
    for (int plane = 0; plane < 5; ++plane) {
      double hz = 0;
      BOOST_REQUIRE(stretched.toWorld(hz, static_cast<double>(plane)));
      BOOST_TEST(std::abs(axis.frequency_hz(plane) - hz) < 1e-6);
    }
  }
}

BOOST_AUTO_TEST_CASE(axes_of_a_casa_image_that_name_something_else_are_refused) {
  const ImageHeader header = example_header(1);
  for (const auto& [name, taken] : {std::pair("Nonsense", false), {"Velocity", false}, {"", true}, {"Linear", true}}) {
    const TemporaryFolder folder;
    casacore::CoordinateSystem coordinates = ms_io::casa_coordinates(header);
    coordinates.addCoordinate(
        casacore::LinearCoordinate(casacore::Vector<casacore::String>(1, name), casacore::Vector<casacore::String>(1, ""),
                                   casacore::Vector<double>(1, 0.0), casacore::Vector<double>(1, 1.0),
                                   casacore::Matrix<double>(1, 1, 1.0), casacore::Vector<double>(1, 0.0)));
    {
      casacore::PagedImage<float>(casacore::TiledShape(casacore::IPosition(5, 7, 4, 1, 1, 1)), coordinates, folder / "a.image")
          .set(0);
    }
    std::string error;
    try {
      ms_io::open_casa_image(folder / "a.image");
    } catch (const std::runtime_error& caught) {
      error = caught.what();
    }
    BOOST_TEST((error.find("its axis 5 of type '" + std::string(name) + "' has length 1") != std::string::npos) == !taken,
               error);
    BOOST_TEST(error.empty() == taken, error);
  }
}

BOOST_AUTO_TEST_SUITE_END()
