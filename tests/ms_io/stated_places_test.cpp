#include <casacore/coordinates/Coordinates/DirectionCoordinate.h>
#include <casacore/images/Images/FITSImage.h>
#include <casacore/images/Images/PagedImage.h>

#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <string>
#include <vector>

#include "imager/files/fits_image_reader.h"
#include "imager/files/sky_grid.h"
#include "ms_io/casa_image.h"
#include "tests/stated_fits.h"
#include "tests/temporary_folder.h"

// Where FITS headers and CASA images state that their pixels lie, as casacore has it, by wcslib.

BOOST_AUTO_TEST_SUITE(stated_places)

namespace {

using namespace misfit;
using namespace misfit::imager;
using namespace misfit::testing;

constexpr int width = 41, height = 30;

const StatedCards plain{{"CTYPE1", "'RA---SIN'"}, {"CTYPE2", "'DEC--SIN'"}, {"CRPIX1", "21"},       {"CRPIX2", "16"},
                        {"CRVAL1", "187.7"},      {"CRVAL2", "12.39"},      {"CDELT1", "-5E-4"},    {"CDELT2", "5E-4"},
                        {"RADESYS", "'FK5'"},     {"EQUINOX", "2000.0"},    {"BUNIT", "'Jy/pixel'"}};

struct Statement {
  const char* name;
  StatedCards cards;
};

std::ostream& operator<<(std::ostream& to, const Statement& statement) {
  return to << statement.name;
}

StatedCards projected(const std::string& name) {
  return {{"CTYPE1", "'RA---" + name + "'"}, {"CTYPE2", "'DEC--" + name + "'"}, {"CDELT1", "-0.5"}, {"CDELT2", "0.5"}};
}

StatedCards in_unit(const std::string& name, double per_degree) {
  return {{"CUNIT1", "'" + name + "'"},           {"CUNIT2", "'" + name + "'"},
          {"CRVAL1", stated(187.7 * per_degree)}, {"CRVAL2", stated(12.39 * per_degree)},
          {"CDELT1", stated(-5e-4 * per_degree)}, {"CDELT2", stated(5e-4 * per_degree)}};
}

const std::vector<Statement> statements{
    {"plain", {}},
    {"another reference pixel", {{"CRPIX1", "-31.25"}, {"CRPIX2", "1000.5"}}},
    {"TAN", projected("TAN")},
    {"STG", projected("STG")},
    {"ARC", projected("ARC")},
    {"ZEA", projected("ZEA")},
    {"NCP", projected("NCP")},
    {"NCP in the south", with(projected("NCP"), {{"CRVAL2", "-35"}})},
    {"slanted SIN", with(projected("SIN"), {{"PV2_1", "0.2"}, {"PV2_2", "-0.6"}})},
    {"slanted SIN about another pole", with(projected("SIN"), {{"PV2_1", "0.2"}, {"PV2_2", "-0.6"}, {"LONPOLE", "120"}})},
    {"CROTA2", {{"CROTA2", "30"}}},
    {"PC", {{"PC1_1", "0.8"}, {"PC1_2", "-0.6"}, {"PC2_1", "0.6"}, {"PC2_2", "0.8"}}},
    {"PC of old", {{"PC001001", "0.8"}, {"PC001002", "-0.6"}, {"PC002001", "0.6"}, {"PC002002", "0.8"}}},
    {"CD", {{"CD1_1", "-4E-4"}, {"CD1_2", "1E-4"}, {"CD2_1", "2E-4"}, {"CD2_2", "5E-4"}, {"CDELT1", ""}, {"CDELT2", ""}}},
    {"LONPOLE", {{"LONPOLE", "77"}}},
    {"LONPOLE of a TAN", with(projected("TAN"), {{"LONPOLE", "-140"}, {"LATPOLE", "40"}})},
    {"at the north pole", {{"CRVAL2", "90"}}},
    {"at the north pole with LONPOLE", {{"CRVAL2", "90"}, {"LONPOLE", "180"}}},
    {"at the south pole", {{"CRVAL2", "-90"}}},
    {"GALACTIC", {{"CTYPE1", "'GLON-SIN'"}, {"CTYPE2", "'GLAT-SIN'"}, {"RADESYS", ""}, {"EQUINOX", ""}}},
    {"ICRS", {{"RADESYS", "'ICRS'"}, {"EQUINOX", ""}}},
    {"ICRS unless told", {{"RADESYS", ""}, {"EQUINOX", ""}}},
    {"FK4", {{"RADESYS", "'FK4'"}, {"EQUINOX", "1950"}}},
    {"FK4 by EQUINOX", {{"RADESYS", ""}, {"EQUINOX", "1950"}}},
    {"FK4 by EPOCH", {{"RADESYS", ""}, {"EQUINOX", ""}, {"EPOCH", "1950"}}},
    {"FK5 by EQUINOX", {{"RADESYS", ""}}},
    {"rad", in_unit("rad", M_PI / 180)},
    {"arcmin", in_unit("arcmin", 60)},
    {"arcsec", in_unit("arcsec", 3600)},
    {"mirrored", {{"CDELT1", "5E-4"}}},
    {"south up", {{"CDELT2", "-5E-4"}}},
    {"oblong pixels", {{"CDELT2", "2E-4"}}},
};

casacore::Vector<double> place_by_casacore(casacore::DirectionCoordinate coordinate, const SkyDirection& at) {
  coordinate.setWorldAxisUnits(casacore::Vector<casacore::String>(2, "rad"));
  casacore::Vector<double> pixel(2), world(2);
  world[0] = at.ra_rad;
  world[1] = at.dec_rad;
  BOOST_REQUIRE(coordinate.toPixel(pixel, world));
  return pixel;
}

const char* frame_by_casacore(const casacore::DirectionCoordinate& coordinate) {
  switch (coordinate.directionType()) {
    case casacore::MDirection::ICRS:
      return "ICRS";
    case casacore::MDirection::J2000:
      return "FK5";
    case casacore::MDirection::B1950:
      return "FK4";
    case casacore::MDirection::GALACTIC:
      return "GALACTIC";
    default:
      return "";
  }
}

/// Directions about the reference lie in the same pixels of the grid and of the coordinate.
void check_places(const SkyGrid& grid, const casacore::DirectionCoordinate& coordinate) {
  BOOST_TEST(grid.reference.frame == frame_by_casacore(coordinate));
  BOOST_TEST((grid.width == width && grid.height == height));
  const ImageGeometry about{21, 20, grid.column_step_rad(), grid.reference};
  const GridMap map(about, grid);
  double farthest = 0;
  for (int row = 0; row < about.height; ++row)
    for (int column = 0; column < about.width; ++column) {
      const PixelPlace place = map(row, column);
      const auto should = place_by_casacore(coordinate, sky_direction(about.at(row, column), about.phase_centre));
      farthest = std::max(farthest, std::hypot(place.column - should[0], place.row - should[1]));
    }
  // wcslib computes in degrees to 1e-13 or so, which is 2e-10 of a pixel.
  BOOST_TEST(farthest < 1e-7);
}

}  // namespace

BOOST_DATA_TEST_CASE(pixels_lie_where_casacore_has_them, boost::unit_test::data::make(statements), statement) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.fits", casa = folder / "a.image";
  write_stated_fits(path, Image(width, height), with(plain, statement.cards));
  const casacore::FITSImage by_casacore(path);
  const casacore::DirectionCoordinate coordinate = by_casacore.coordinates().directionCoordinate();
  const auto fits = open_fits_image(path, Grids::any);
  BOOST_REQUIRE(fits->grid().has_value());
  check_places(*fits->grid(), coordinate);
  { casacore::PagedImage<float>(casacore::TiledShape(by_casacore.shape()), by_casacore.coordinates(), casa).set(0); }
  const auto image = ms_io::open_casa_image(casa, Grids::any);
  BOOST_REQUIRE(image->grid().has_value());
  check_places(*image->grid(), coordinate);
}

BOOST_AUTO_TEST_SUITE_END()
