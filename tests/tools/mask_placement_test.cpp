#include "tools/formats/mask_placement.h"

#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "ms_io/celestial_frames.h"
#include "tests/stated_fits.h"
#include "tests/tools/casa_copy.h"
#include "tests/tools/program.h"
#include "tools/formats/mask_file.h"

BOOST_AUTO_TEST_SUITE(mask_placement)

namespace {

using namespace misfit;
using namespace misfit::tools;
using namespace misfit::tools::testing;
using misfit::testing::stated;
using misfit::testing::StatedCards;
using misfit::testing::with;
using misfit::testing::write_stated_fits;
using Vector = std::array<double, 3>;

constexpr double degree = M_PI / 180;
const imager::ImageGeometry image{24, 20, 0.01 * degree, {187.7 * degree, 12.39 * degree, "FK5"}};

/// A mask as a test makes it: pixel (column, row), counted from 0, lies at x = Σ step · (pixel − centre) in the plane that
/// touches the sky at `reference`, in SIN or TAN. Its border allows nothing, so that what lies beside it is what lies on it.
struct Mask {
  const char* name;
  int width = 26, height = 23;
  double centre[2] = {13.2, 11.1};
  double step_deg[2][2] = {{-0.01, 0}, {0, 0.01}};
  bool tan = false;
  imager::SkyDirection reference = image.phase_centre;
  StatedCards cards = {};  ///< in place of those that follow from this

  imager::Image pixels() const {
    imager::Image mask(width, height);
    std::mt19937 random(7);
    for (int row = 1; row + 1 < height; ++row)
      for (int column = 1; column + 1 < width; ++column) mask.at(row, column) = random() % 2;
    return mask;
  }

  StatedCards header() const {
    const std::string projection = tan ? "TAN'" : "SIN'";
    const bool galactic = reference.frame == "GALACTIC";
    StatedCards all{{"CTYPE1", (galactic ? "'GLON-" : "'RA---") + projection},
                    {"CTYPE2", (galactic ? "'GLAT-" : "'DEC--") + projection},
                    {"CRPIX1", stated(centre[0] + 1)},
                    {"CRPIX2", stated(centre[1] + 1)},
                    {"CRVAL1", stated(reference.ra_rad / degree)},
                    {"CRVAL2", stated(reference.dec_rad / degree)},
                    {"CD1_1", stated(step_deg[0][0])},
                    {"CD1_2", stated(step_deg[0][1])},
                    {"CD2_1", stated(step_deg[1][0])},
                    {"CD2_2", stated(step_deg[1][1])}};
    if (!galactic) all["RADESYS"] = "'" + reference.frame + "'";
    if (!galactic) all["EQUINOX"] = reference.frame == "FK4" ? "1950." : "2000.";
    return with(all, cards);
  }

  /// Where a pixel lies, in its own frame.
  imager::SkyDirection direction(int row, int column) const {
    const double right = (column - centre[0]) * degree, up = (row - centre[1]) * degree;
    double l = step_deg[0][0] * right + step_deg[0][1] * up, m = step_deg[1][0] * right + step_deg[1][1] * up;
    const double shrink = tan ? 1 / std::sqrt(1 + l * l + m * m) : 1;
    return imager::sky_direction({l * shrink, m * shrink}, reference);
  }
};

std::ostream& operator<<(std::ostream& to, const Mask& mask) {
  return to << mask.name;
}

imager::SkyDirection seen_in(const std::string& frame) {
  return ms_io::in_frame(image.phase_centre, frame);
}

const StatedCards by_cdelt{{"CD1_1", ""}, {"CD1_2", ""}, {"CD2_1", ""}, {"CD2_2", ""}, {"CDELT1", "-0.01"}, {"CDELT2", "0.01"}};

const std::vector<Mask> masks{
    {"shifted", 26, 23, {17.0, 5.0}},
    {"shifted by parts of pixels", 26, 23, {13.2, 11.1}},
    {"smaller", 9, 8, {3.0, 4.0}},
    {"larger", 61, 52, {30.0, 26.0}},
    {"half the cell", 52, 46, {26.1, 23.2}, {{-0.005, 0}, {0, 0.005}}},
    {"three times the cell", 12, 10, {6.3, 5.4}, {{-0.03, 0}, {0, 0.03}}},
    {"oblong pixels", 26, 46, {13.2, 23.1}, {{-0.01, 0}, {0, 0.005}}},
    {"mirrored", 26, 23, {13.2, 11.1}, {{0.01, 0}, {0, 0.01}}},
    {"turned by 90 degrees",
     26,
     27,
     {13.2, 13.1},
     {{0, 0.01}, {0.01, 0}},
     false,
     image.phase_centre,
     with(by_cdelt, {{"PC1_1", "0"}, {"PC1_2", "-1"}, {"PC2_1", "1"}, {"PC2_2", "0"}})},
    {"turned by 33 degrees", 34, 33, {17.2, 16.1}, {{-0.0084, 0.0054}, {0.0054, 0.0084}}},
    {"TAN", 26, 23, {13.2, 11.1}, {{-0.01, 0}, {0, 0.01}}, true},
    {"another reference", 26, 23, {42.3, 42.2}, {{-0.01, 0}, {0, 0.01}}, false, {187.4 * degree, 12.7 * degree, "FK5"}},
    {"TAN about another reference",
     26,
     23,
     {513.3, 97.2},
     {{-0.01, 0}, {0, 0.01}},
     true,
     {182.6 * degree, 13.3 * degree, "FK5"}},
    {"ICRS", 26, 23, {13.2, 11.1}, {{-0.01, 0}, {0, 0.01}}, false, seen_in("ICRS")},
    {"FK4", 26, 23, {13.2, 11.1}, {{-0.01, 0}, {0, 0.01}}, false, seen_in("FK4")},
    {"GALACTIC", 34, 33, {17.2, 16.1}, {{-0.01, 0}, {0, 0.01}}, true, seen_in("GALACTIC")},
    {"by CROTA",
     34,
     33,
     {17.23, 16.13},
     {{-0.008, -0.006}, {-0.006, 0.008}},
     false,
     image.phase_centre,
     with(by_cdelt, {{"CROTA2", stated(std::atan2(0.6, 0.8) / degree)}})},
    {"by LONPOLE",
     34,
     33,
     {17.23, 16.13},
     {{-0.008, 0.006}, {0.006, 0.008}},
     false,
     image.phase_centre,
     {{"CD1_1", "-0.01"},
      {"CD1_2", "0"},
      {"CD2_1", "0"},
      {"CD2_2", "0.01"},
      {"LONPOLE", stated(180 + std::atan2(0.6, 0.8) / degree)}}},
    {"in rad",
     26,
     23,
     {13.2, 11.1},
     {{-0.01, 0}, {0, 0.01}},
     false,
     image.phase_centre,
     {{"CUNIT1", "'rad'"},
      {"CUNIT2", "'rad'"},
      {"CRVAL1", stated(187.7 * degree)},
      {"CRVAL2", stated(12.39 * degree)},
      {"CD1_1", stated(-0.01 * degree)},
      {"CD2_2", stated(0.01 * degree)}}},
};

Vector vector_of(const imager::SkyDirection& at) {
  return {std::cos(at.dec_rad) * std::cos(at.ra_rad), std::cos(at.dec_rad) * std::sin(at.ra_rad), std::sin(at.dec_rad)};
}

/// The definition, pixel by pixel: what the mask says in its pixel that is nearest on the sky. Turned pixels that are not
/// square would have others nearest than those that hold the direction, and are not tried.
imager::Image nearest_by_search(const Mask& mask) {
  const imager::Image pixels = mask.pixels();
  std::vector<Vector> places;
  for (int row = 0; row < mask.height; ++row)
    for (int column = 0; column < mask.width; ++column)
      places.push_back(vector_of(ms_io::in_frame(mask.direction(row, column), image.phase_centre.frame)));
  imager::Image found(image.width, image.height);
  for (int row = 0; row < image.height; ++row)
    for (int column = 0; column < image.width; ++column) {
      const Vector here = vector_of(imager::sky_direction(image.at(row, column), image.phase_centre));
      double least = std::numeric_limits<double>::infinity();
      for (std::size_t i = 0; i < places.size(); ++i) {
        const double distance = std::hypot(places[i][0] - here[0], places[i][1] - here[1], places[i][2] - here[2]);
        if (distance < least) found.at(row, column) = pixels.pixel[i];
        least = std::min(least, distance);
      }
    }
  return found;
}

}  // namespace

BOOST_DATA_TEST_CASE(a_mask_allows_the_directions_that_it_allows_on_its_own_pixels, boost::unit_test::data::make(masks), mask) {
  const TemporaryFolder folder;
  write_stated_fits(folder / "mask.fits", mask.pixels(), mask.header());
  copy_to_casa(folder / "mask.fits", folder / "mask.image");
  const imager::Image should = nearest_by_search(mask);
  BOOST_TEST(std::count(should.pixel.begin(), should.pixel.end(), 1.0) > 10);
  for (const char* name : {"mask.fits", "mask.image"}) {
    const imager::Image is = read_mask(folder / name, image);
    int wrong = 0;
    for (std::size_t i = 0; i < is.pixel.size(); ++i) wrong += is.pixel[i] != should.pixel[i];
    BOOST_TEST(wrong == 0, name);
  }
}

BOOST_AUTO_TEST_SUITE_END()
