// Region text in place of a mask's path.
#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include "tests/example_cube.h"
#include "tests/temporary_folder.h"
#include "tools/formats/mask_file.h"

BOOST_AUTO_TEST_SUITE(mask_text)

using namespace misfit;
using namespace misfit::tools;
using misfit::testing::example_header;
using misfit::testing::TemporaryFolder;

namespace {

constexpr double degree = M_PI / 180;
const imager::ImageGeometry geometry{60, 40, 2 * degree / 3600, {187.7 * degree, 12.39 * degree, "FK5"}};

imager::Image mask_in_a_file(const std::string& text) {
  const TemporaryFolder folder;
  std::ofstream(folder / "regions") << text;
  return read_mask(folder / "regions", geometry);
}

}  // namespace

BOOST_AUTO_TEST_CASE(region_text_in_place_of_a_file_is_what_it_is_in_one) {
  for (const char* text : {"circle[[30pix, 20pix], 7pix]", " -rotbox [[30pix, 20pix], [9pix, 7pix], 30deg]", "circle(31,21,7)",
                           "image; circle 31 21 7", "ICRS;ellipse(187.7, 12.39, 9\", 5\", 30)", "+BOX(31, 21, 9, 5)",
                           "global color=red; image; circle(31,21,7)", "image;circle(31,21,7);-circle(31,21,3)",
                           "poly [[1pix, 2pix], [9pix, 3pix], [5pix, 30pix]], color=red, label='a, b'"}) {
    const imager::Image mask = read_mask(text, geometry), in_file = mask_in_a_file(text);
    BOOST_TEST(mask.pixel == in_file.pixel, text);
    BOOST_TEST(std::count(mask.pixel.begin(), mask.pixel.end(), 1.0) > 0, text);
  }
  imager::ImageHeader header = example_header(1, "IQ");
  const MaskFile of_planes("box [[2pix, 0pix], [2pix, 0pix]], corr=[Q]", header);
  BOOST_TEST(of_planes.mask({0, 0}).at(0, 2) == 0);
  BOOST_TEST(of_planes.mask({0, 1}).at(0, 2) == 1);
}

BOOST_AUTO_TEST_CASE(a_file_goes_before_region_text_of_its_name) {
  const TemporaryFolder folder;
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(folder / "");
  std::ofstream("circle[[30pix, 20pix], 7pix]") << "box [[1pix, 1pix], [2pix, 2pix]]";
  BOOST_TEST(read_mask("circle[[30pix, 20pix], 7pix]", geometry).at(20, 30) == 0);
  BOOST_TEST(read_mask("circle[[30pix, 20pix], 8pix]", geometry).at(20, 30) == 1);
  std::filesystem::current_path(before);
}

BOOST_AUTO_TEST_CASE(masks_that_are_neither_files_nor_regions_are_refused_with_what_is_expected) {
  const auto refusal_of = [](const std::string& mask) -> std::string {
    try {
      read_mask(mask, geometry);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  };
  for (const std::string name :
       {"no/such/mask", "circle.crtf", "circle", "image (1).fits", "box/mask", "cirkle [[1pix, 2pix], 3pix]"})
    BOOST_TEST(refusal_of(name) ==
               "cannot read mask " + name +
                   ": No such file or directory; expected a FITS or CASA image, a region file, or region text "
                   "such as circle [[100pix, 80pix], 20pix]");
  BOOST_TEST(refusal_of(std::string(300, 'x')).find("File name too long; expected") != std::string::npos);
  BOOST_TEST(refusal_of("circle [[1pix, 2pix]]").find("--mask, line 1: found 'circle [[1pix, 2pix]]', expected circle") == 0U);
  BOOST_TEST(refusal_of("circle [[1pix, 2pix], 3pix]\nbox [[1pix, 2pix], [3pix, 4pix]]").find("has several lines") !=
             std::string::npos);
}

BOOST_AUTO_TEST_SUITE_END()
