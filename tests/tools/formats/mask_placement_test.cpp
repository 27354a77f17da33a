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
      for (int column = 1; column + 1 < width; ++column) mask.at(row, column) = static_cast<double>(random() % 2);
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

namespace {

const Mask same{"the image's pixels", image.width, image.height, {12, 10}};

/// What the user is told of a mask, as a FITS and as a CASA image, or what refuses it, must be nothing, or a sentence
/// with `part` in it and without `other`.
void check_told(const Mask& mask, const std::string& part, const std::string& other = "\n") {
  const TemporaryFolder folder;
  write_stated_fits(folder / "mask.fits", mask.pixels(), mask.header());
  copy_to_casa(folder / "mask.fits", folder / "mask.image");
  imager::ImageHeader header;
  header.geometry = image;
  for (const char* name : {"mask.fits", "mask.image"}) {
    std::string told;
    try {
      const std::vector<std::string> doubts = MaskFile(folder / name, header).doubts();
      told = doubts.empty() ? "" : doubts.front();
    } catch (const std::runtime_error& error) {
      told = error.what();
    }
    BOOST_TEST((part.empty() ? told.empty() : told.find(part) != std::string::npos && told.find(other) == std::string::npos),
               name << " of " << mask.name << ": " << told);
  }
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_mask_of_the_images_pixels_is_laid_in_silence_and_others_with_a_word) {
  check_told(same, "");
  for (const auto& [right, up] : {std::pair(10, 0), {-3, 4}, {0, 1}}) {
    Mask moved = same;
    moved.centre[0] += right;
    moved.centre[1] += up;
    check_told(moved, "begins at column " + std::to_string(-right) + ", row " + std::to_string(-up) + " of the image");
  }
  Mask cut = same;
  cut.width -= 2;
  check_told(cut, "22 × 20 pixels begins at column 0, row 0 of the image, where its coordinates have it: pixels beside it");
  Mask larger = same;
  larger.width += 9;
  larger.height += 8;
  larger.centre[0] += 5;
  larger.centre[1] += 3;
  check_told(larger, "33 × 28 pixels begins at column -5, row -3 of the image, where its coordinates have it", "beside it");
  for (const Mask& mask : masks)
    if (mask.name == std::string("TAN about another reference"))
      check_told(mask, "has other pixels than the image, 36arcsec × 36arcsec, TAN about");
  Mask aside = same;
  aside.centre[0] += 0.3;
  check_told(aside, "each pixel of the image takes the nearest of the mask");
}

BOOST_AUTO_TEST_CASE(a_mask_that_covers_none_of_the_image_is_refused) {
  for (const double right : {24.0, -24.0, 1000.0, 1e12}) {
    Mask beside = same;
    beside.centre[0] += right;
    check_told(beside, "covers none of the image");
  }
  Mask turned{"turned", 26, 23, {1000, 11.1}, {{-0.0084, 0.0054}, {0.0054, 0.0084}}};
  check_told(turned, "covers none of the image");
  Mask behind = same;
  behind.reference = {image.phase_centre.ra_rad - M_PI, -image.phase_centre.dec_rad, "FK5"};
  check_told(behind, "lies elsewhere on the sky, and covers none of the image");
}

BOOST_AUTO_TEST_CASE(a_mask_that_says_nothing_of_the_sky_is_laid_pixel_by_pixel_with_a_word) {
  const TemporaryFolder folder;
  imager::ImageHeader header;
  header.geometry = image;
  for (const StatedCards& cards : {StatedCards{},
                                   {{"CRPIX1", "0."}, {"CRVAL1", "0."}, {"CDELT1", "1."}},
                                   {{"CTYPE1", "'LINEAR'"}, {"CTYPE2", "'LINEAR'"}}}) {
    write_stated_fits(folder / "mask.fits", same.pixels(), cards);
    copy_to_casa(folder / "mask.fits", folder / "mask.image");
    for (const char* name : {"mask.fits", "mask.image"}) {
      BOOST_TEST_INFO(name);
      const MaskFile file(folder / name, header);
      BOOST_REQUIRE(file.doubts().size() == 1U);
      BOOST_TEST(file.doubts().front().find("does not say where it lies on the sky: it is laid on the image pixel by pixel") !=
                 std::string::npos);
      BOOST_TEST((file.mask({0, 0}).pixel == same.pixels().pixel));
    }
    std::filesystem::remove_all(folder / "mask.image");
  }
  header.geometry.width += 1;
  BOOST_CHECK_EXCEPTION(MaskFile(folder / "mask.fits", header), std::runtime_error, [](const std::exception& error) {
    return std::string(error.what())
               .find("24 × 20 pixels does not say where it lies on the sky: expected the image's 25 × 20") != std::string::npos;
  });
  write_stated_fits(folder / "mask.fits", same.pixels(), {{"CDELT1", "-0.01"}, {"CDELT2", "0.01"}});
  BOOST_CHECK_EXCEPTION(MaskFile(folder / "mask.fits", header), std::runtime_error, [](const std::exception& error) {
    return std::string(error.what()).find("its CDELT1 is -0.01, but there is no CTYPE1") != std::string::npos;
  });
}

BOOST_AUTO_TEST_CASE(a_mask_that_moves_along_lies_about_the_field_wherever_that_was) {
  const TemporaryFolder folder;
  const std::string path = folder / "mask.fits";
  imager::ImageHeader still, moving;
  still.geometry = moving.geometry = image;
  moving.observation.moving_at = "2026-01-31T12:00:00.0";
  for (const double elsewhere : {0.0, 1e-3, 2.0})
    for (const int right : {0, 5}) {
      Mask mask = same;
      mask.reference.ra_rad += elsewhere;
      mask.reference.dec_rad -= 0.1 * elsewhere;
      mask.centre[0] += right;
      mask.cards = {{"TRACKFLD", "'2026-01-30T07:00:00.0'"}};
      write_stated_fits(path, mask.pixels(), mask.header());
      const MaskFile file(path, moving);
      BOOST_TEST(file.doubts().size() == (right == 0 ? 0U : 1U));
      const imager::Image is = file.mask({0, 0});
      for (int row = 0; row < image.height; ++row)
        for (int column = 0; column + right < image.width; ++column)
          BOOST_REQUIRE(is.at(row, column) == mask.pixels().at(row, column + right));
      BOOST_CHECK_EXCEPTION(MaskFile(path, still), std::runtime_error, [](const std::exception& error) {
        return std::string(error.what()).find("moves along with its field (TRACKFLD is 2026-01-30T07:00:00.0), expected one") !=
               std::string::npos;
      });
    }
  write_stated_fits(path, same.pixels(), same.header());
  BOOST_TEST(MaskFile(path, still).doubts().empty());
  BOOST_REQUIRE(MaskFile(path, moving).doubts().size() == 1U);
  BOOST_TEST(MaskFile(path, moving).doubts().front().find("mask.fits does not say that it moves along with its field") !=
             std::string::npos);
}

BOOST_AUTO_TEST_CASE(a_mask_of_another_stokes_parameter_or_band_is_told_of) {
  const TemporaryFolder folder;
  imager::ImageHeader header;
  header.geometry = image;
  header.observation.frequency_hz = 1.4e9;
  header.observation.bandwidth_hz = 1e8;
  const auto doubts = [&](const StatedCards& cards, const std::string& stokes) {
    write_stated_fits(folder / "mask.fits", same.pixels(), with(same.header(), cards));
    std::filesystem::remove_all(folder / "mask.image");
    copy_to_casa(folder / "mask.fits", folder / "mask.image");
    header.stokes = imager::parse_stokes(stokes);
    const auto fits = MaskFile(folder / "mask.fits", header).doubts(), casa = MaskFile(folder / "mask.image", header).doubts();
    BOOST_TEST(fits.size() == casa.size());
    return fits.empty() ? "" : fits.front();
  };
  const auto of_stokes = [](int code) {
    return StatedCards{{"CTYPE3", "'STOKES'"}, {"CRPIX3", "1."}, {"CRVAL3", stated(code)}, {"CDELT3", "1."}};
  };
  BOOST_TEST(doubts(of_stokes(2), "I").find("mask.fits is of Q, and is laid on I") != std::string::npos);
  BOOST_TEST(doubts(of_stokes(4), "QU").find("mask.fits is of V, and is laid on QU") != std::string::npos);
  BOOST_TEST(doubts(of_stokes(2), "Q") == "");
  for (const char* stokes : {"I", "Q", "IQUV", "XX"}) BOOST_TEST(doubts(of_stokes(1), stokes) == "");
  const auto of_band = [](double hz) {
    return StatedCards{{"CTYPE3", "'FREQ'"}, {"CRPIX3", "1."}, {"CRVAL3", stated(hz)}, {"CDELT3", "1.E7"}};
  };
  for (const double hz : {1.36e9, 1.4e9, 1.45e9}) BOOST_TEST(doubts(of_band(hz), "I") == "");
  BOOST_TEST(doubts(of_band(5e9), "I").find("mask.fits is of 5 GHz, and the image of 1.4 GHz: it is laid as it is") !=
             std::string::npos);
}

BOOST_AUTO_TEST_CASE(components_are_found_where_the_masks_coordinates_have_it) {
  const TemporaryFolder folder;
  succeed(small_image(snapshot(), folder / "dirty"));
  imager::SkyImage mask = imager::read_fits(folder / "dirty.residual.fits");
  const auto peak = std::max_element(mask.image.pixel.begin(), mask.image.pixel.end()) - mask.image.pixel.begin();
  const int row = static_cast<int>(peak / 64), column = static_cast<int>(peak % 64);
  const auto cleaned = [&](int right, int up, const std::string& name) {
    mask.image = imager::Image(64, 64);
    for (int r = std::max(0, row + up - 4); r < std::min(64, row + up + 4); ++r)
      for (int c = std::max(0, column + right - 3); c < std::min(64, column + right + 3); ++c) mask.image.at(r, c) = 1;
    mask.geometry.centre = {right * mask.geometry.cell_rad, -up * mask.geometry.cell_rad};
    imager::write_fits(mask, folder / "mask.fits", imager::PixelFormat::float32);
    std::filesystem::remove_all(folder / "mask.image");
    copy_to_casa(folder / "mask.fits", folder / "mask.image");
    succeed(small_image(snapshot(), folder / "a") + Arguments{"--niter", "20", "--mask", folder / name});
    return pixels_of(folder / "a", "model").pixel;
  };
  const auto usual = cleaned(0, 0, "mask.fits");
  BOOST_TEST(report_of(folder / "a")["warnings"].empty());
  BOOST_TEST(usual[static_cast<std::size_t>(peak)] > 0);
  for (const auto& [right, up] : {std::pair(10, 0), {-7, 5}})
    for (const char* name : {"mask.fits", "mask.image"}) {
      BOOST_TEST((cleaned(right, up, name) == usual), name << " moved by " << right << ", " << up);
      BOOST_TEST(report_of(folder / "a")["warnings"].dump().find("begins at column " + std::to_string(-right)) !=
                 std::string::npos);
    }
}

BOOST_AUTO_TEST_SUITE_END()
