#include "tools/formats/mask_file.h"

#include <sys/stat.h>

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <fstream>
#include <functional>

#include "imager/files/fits_image.h"
#include "tests/example_cube.h"
#include "tests/temporary_folder.h"
#include "tools/formats/image_file.h"
#include "tools/run/image_files.h"

BOOST_AUTO_TEST_SUITE(mask_file)

using namespace misfit;
using namespace misfit::tools;
using misfit::testing::example_header;
using misfit::testing::TemporaryFolder;

namespace {

constexpr double degree = M_PI / 180, arcsec = degree / 3600;
const imager::ImageGeometry geometry{60, 40, 2 * arcsec, {187.7 * degree, 12.39 * degree, "FK5"}};

imager::Image mask_of(const std::string& text, const imager::ImageGeometry& g = geometry) {
  const TemporaryFolder folder;
  const std::string path = folder / "regions.crtf";
  std::ofstream(path) << text;
  return read_mask(path, g);
}

/// The mask must be 1 where allowed(column, row) and 0 elsewhere.
void check_mask(const imager::Image& mask, const std::function<bool(int, int)>& allowed) {
  BOOST_REQUIRE(mask.width == geometry.width);
  BOOST_REQUIRE(mask.height == geometry.height);
  int wrong = 0;
  for (int r = 0; r < mask.height; ++r)
    for (int c = 0; c < mask.width; ++c) wrong += mask.at(r, c) != (allowed(c, r) ? 1 : 0);
  BOOST_TEST(wrong == 0);
}

bool refused(const std::string& text, const std::string& part) {
  try {
    mask_of(text);
  } catch (const std::runtime_error& error) {
    BOOST_TEST_INFO(error.what());
    return std::string(error.what()).find(part) != std::string::npos;
  }
  return false;
}

/// A direction `east` and `north` pixels from the phase centre, as CASA writes it.
std::string direction(double east, double north) {
  // The inverse of direction_cosines().
  const double l = east * geometry.cell_rad, m = north * geometry.cell_rad, n = std::sqrt(1 - l * l - m * m);
  const double ra0 = geometry.phase_centre.ra_rad, dec0 = geometry.phase_centre.dec_rad;
  const double dec = std::asin(m * std::cos(dec0) + n * std::sin(dec0));
  const double ra = ra0 + std::atan2(l, n * std::cos(dec0) - m * std::sin(dec0));
  char text[80];
  std::snprintf(text, sizeof text, "[%.9fdeg, %.9fdeg]", ra / degree, dec / degree);
  return text;
}

/// The pixel that is marked in a plane.
int mark(const imager::PlaneIndex& at) {
  return at.channel * 2 + at.stokes;
}

/// Masks with one pixel marked in each plane, as FITS and CASA images.
void write_marked(const imager::ImageHeader& header, const std::string& name) {
  const auto writer = open_image_files(name, header, imager::PixelFormat::float32, "both");
  for (int channel = 0; channel < header.spectral.channels; ++channel)
    for (int stokes = 0; stokes < static_cast<int>(header.stokes.size()); ++stokes) {
      imager::Image image(header.geometry.width, header.geometry.height);
      image.pixel[static_cast<std::size_t>(mark({channel, stokes}))] = 1;
      writer->write({channel, stokes}, image, std::nullopt);
    }
  writer->finish();
}

}  // namespace

BOOST_AUTO_TEST_CASE(boxes_in_pixels_hold_the_pixels_whose_centres_lie_within) {
  const auto box = [](int c, int r) { return c >= 10 && c <= 20 && r >= 5 && r <= 8; };
  check_mask(mask_of("#CRTFv0\nbox [[10pix, 5pix], [20pix, 8pix]]\n"), box);
  check_mask(mask_of("box[[20.4pix,4.6pix],[9.6pix,8.9pix]]"), box);
  check_mask(mask_of("centerbox [[15pix, 6.5pix], [10pix, 3pix]]"), box);
}

BOOST_AUTO_TEST_CASE(circles_in_pixels_hold_the_pixels_whose_centres_lie_within) {
  check_mask(mask_of("circle [[30pix, 20pix], 7pix]"), [](int c, int r) { return std::hypot(c - 30, r - 20) <= 7; });
}

BOOST_AUTO_TEST_CASE(directions_fall_where_the_image_has_them) {
  const auto circle = [](int c, int r) { return std::hypot(c - 20, r - 25) <= 4.5; };  // 10 to the east, 5 to the north
  check_mask(mask_of("circle [" + direction(10, 5) + ", 9arcsec]"), circle);
  check_mask(mask_of("circle [" + direction(10, 5) + ", 4.5pix]"), circle);
  const auto box = [](int c, int r) { return c >= 18 && c <= 32 && r >= 17 && r <= 30; };
  check_mask(mask_of("box [" + direction(12.4, -3.4) + ", " + direction(-2.4, 10.4) + "]"), box);
}

BOOST_AUTO_TEST_CASE(directions_may_be_written_in_every_way_that_casa_knows) {
  const auto circle = [](int c, int r) { return std::hypot(c - 30, r - 20) <= 3; };
  for (const char* ra : {"12h30m48s", "12:30:48.0", "187.7deg", "3.27598300rad"})
    for (const char* dec : {"12d23m24s", "+12d23m24.0s", "12.23.24.0", "+12.23.24", "12.39deg"})
      check_mask(mask_of(std::string("circle [[") + ra + ", " + dec + "], 6.2arcsec]"), circle);
}

BOOST_AUTO_TEST_CASE(southern_declinations_count_southwards) {
  imager::ImageGeometry south = geometry;
  south.phase_centre.dec_rad = -(0 + 30.0 / 60) * degree;
  const imager::Image mask = mask_of("circle [[187.7deg, -0d30m00s], 3pix]", south);
  BOOST_TEST(mask.at(20, 30) == 1);
  BOOST_TEST(mask_of("circle [[187.7deg, -0.30.00.0], 3pix]", south).at(20, 30) == 1);
}

BOOST_AUTO_TEST_CASE(regions_add_up_and_those_with_a_minus_sign_are_taken_away) {
  const auto within = [](int c, int r) {
    const bool first = std::hypot(c - 30, r - 20) <= 7 && !(c >= 29 && c <= 31 && r >= 19 && r <= 21);
    return first || (c <= 3 && r <= 3);
  };
  check_mask(mask_of("#CRTFv0\n# a comment\n\nglobal coord=J2000, color=red\ncircle [[30pix, 20pix], 7pix], linewidth=2\n"
                     "-box [[29pix, 19pix], [31pix, 21pix]]\n+box [[0pix, 0pix], [3pix, 3pix]], coord=J2000, corr=[I]\n"
                     "ann text [[3pix, 4pix], 'a source']\n"),
             within);
}

BOOST_AUTO_TEST_CASE(lines_may_end_as_on_any_system) {
  const auto within = [](int c, int r) { return (c == 3 && r == 4) || (c == 5 && r == 6); };
  for (const std::string end : {"\n", "\r\n", "\r"})
    check_mask(mask_of("#CRTF" + end + "box [[3pix, 4pix], [3pix, 4pix]]" + end + "box [[5pix, 6pix], [5pix, 6pix]]" + end),
               within);
}

BOOST_AUTO_TEST_CASE(regions_are_cut_at_the_edges_of_the_image) {
  check_mask(mask_of("box [[-1e9pix, 30pix], [1e9pix, 1e9pix]]"), [](int, int r) { return r >= 30; });
  check_mask(mask_of("circle [[500pix, 20pix], 7pix]"), [](int, int) { return false; });
}

BOOST_AUTO_TEST_CASE(what_cannot_be_read_is_refused_by_its_line) {
  BOOST_TEST(refused("#CRTF\npoly [[1pix, 2pix], [3pix, 4pix]]", "line 2: found 'poly"));
  BOOST_TEST(refused("circle [[1pix, 2pix]]", "line 1: found 'circle"));
  BOOST_TEST(refused("circle [[1pix, 2pix], 3]", "'3', expected a length"));
  BOOST_TEST(refused("circle [[1pix, 2pix], 0pix]", "expected a length above 0"));
  BOOST_TEST(refused("circle [[1pix, 2deg], 3pix]", "both in pixels or both on the sky"));
  BOOST_TEST(refused("circle [[1pix, nanpix], 3pix]", "'nanpix'"));
  BOOST_TEST(refused("circle [[12h60m0s, 2deg], 3pix]", "'12h60m0s'"));
  for (const char* ra :
       {"4:0.001", "4.5h", "12:30.5", "4h", "12h30m49.4", "12m30h49s", "12:30:", "12:-30:1", "h", ":", "1.5.2"})
    BOOST_TEST(refused(std::string("circle [[") + ra + ", 2deg], 3pix]", std::string("'") + ra + "'"));
  for (const char* dec : {"40d0.01s", "40d", "40d10m", "40.0s", "1.2.", "..", "40:10:11", "-d1m1s"})
    BOOST_TEST(refused(std::string("circle [[2deg, ") + dec + "], 3pix]", std::string("'") + dec + "'"));
  BOOST_TEST(refused("circle [[1pix, 2pix], 3pix] garbage", "'garbage', expected a keyword"));
  BOOST_TEST(refused(std::string("circle\0", 7), "neither a FITS image, a CASA image nor region text"));
  BOOST_TEST(refused("\ncircle\x1b [[1pix, 2pix], 3pix]", "line 2: it has the control character 0x1b"));
  BOOST_TEST(refused("circle [[12h30m0s, 12d-3m0s], 3pix]", "'12d-3m0s'"));
  BOOST_TEST(refused("circle [[1deg, 91deg], 3pix]", "-90 to 90 degrees"));
  BOOST_CHECK_THROW(read_mask("/no/such/mask", geometry), std::runtime_error);
  BOOST_CHECK_THROW(read_mask("/", geometry), std::runtime_error);
}

BOOST_AUTO_TEST_CASE(a_fits_image_allows_what_is_neither_0_nor_nan) {
  const TemporaryFolder folder;
  imager::SkyImage sky;
  sky.geometry = geometry;
  sky.image = imager::Image(geometry.width, geometry.height);
  sky.image.at(3, 4) = 1;
  sky.image.at(5, 6) = -0.25;
  sky.image.at(7, 8) = std::nan("");
  imager::write_fits(sky, folder / "mask.fits", imager::PixelFormat::float32);
  check_mask(read_mask(folder / "mask.fits", geometry), [](int c, int r) { return (r == 3 && c == 4) || (r == 5 && c == 6); });
}

BOOST_AUTO_TEST_CASE(each_plane_of_a_cube_is_the_mask_of_its_channel_and_stokes_parameter) {
  const TemporaryFolder folder;
  const imager::ImageHeader cube = example_header(3, "IQ");
  write_marked(cube, folder / "mask");
  imager::ImageHeader image = cube;
  image.stokes = {imager::Stokes::Q};
  for (const char* name : {"mask.fits", "mask"}) {
    const MaskFile file(folder / name, image);
    BOOST_TEST(!file.one_for_all_channels());
    BOOST_TEST(!file.one_for_all_stokes());
    for (int channel = 0; channel < 3; ++channel) {
      const imager::Image mask = file.mask({channel, 0});
      for (std::size_t i = 0; i < mask.pixel.size(); ++i)
        BOOST_TEST(mask.pixel[i] == (static_cast<int>(i) == mark(imager::PlaneIndex{channel, 1}) ? 1 : 0));
    }
  }
}

BOOST_AUTO_TEST_CASE(a_mask_of_one_plane_or_of_regions_serves_every_plane) {
  const TemporaryFolder folder;
  const imager::ImageHeader cube = example_header(3, "IQ");
  write_marked(example_header(1), folder / "mask");
  std::ofstream(folder / "mask.crtf") << "#CRTF\nbox [[0pix, 0pix], [0pix, 0pix]]\n";
  for (const char* name : {"mask.fits", "mask", "mask.crtf"}) {
    const MaskFile file(folder / name, cube);
    BOOST_TEST(file.one_for_all_channels());
    BOOST_TEST(file.one_for_all_stokes());
    const imager::Image mask = file.mask({2, 1});
    BOOST_TEST(mask.pixel[0] == 1);
    BOOST_TEST(std::count(mask.pixel.begin(), mask.pixel.end(), 1.0) == 1);
  }
}

BOOST_AUTO_TEST_CASE(regions_of_a_correlation_are_of_its_planes_alone) {
  const TemporaryFolder folder;
  std::ofstream(folder / "mask.crtf") << "box [[2pix, 0pix], [2pix, 0pix]], corr=[Q]\nsymbol [[2pix, 1pix], .]\n";
  const MaskFile file(folder / "mask.crtf", example_header(1, "IQ"));
  BOOST_TEST(!file.one_for_all_stokes());
  BOOST_TEST(file.mask({0, 0}).at(0, 2) == 0);
  BOOST_TEST(file.mask({0, 1}).at(0, 2) == 1);
  BOOST_REQUIRE(file.doubts().size() == 1U);
  BOOST_TEST(file.doubts().front().find("mask.crtf, line 2: a symbol holds no pixel") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(regions_of_a_range_are_of_its_planes_alone) {
  const TemporaryFolder folder;
  const std::string path = folder / "mask.crtf";
  std::ofstream(path) << "#CRTF\nglobal range=[1chan, 2chan]\nbox [[0pix, 0pix], [1pix, 0pix]]\n"
                         "-box [[1pix, 0pix], [1pix, 0pix]], range=[2chan, 9chan]\n"
                         "circle [[3pix, 0pix], 0.5pix], label='a, range=[0chan, 0chan]', range=[3chan, 3chan]\n";
  const MaskFile file(path, example_header(5));
  BOOST_TEST(!file.one_for_all_channels());
  const std::vector<std::vector<int>> allowed{{}, {0, 1}, {0}, {3}, {}};  // of row 0
  for (int channel = 0; channel < 5; ++channel) {
    const imager::Image mask = file.mask({channel, 0});
    std::vector<int> found;
    for (int i = 0; i < static_cast<int>(mask.pixel.size()); ++i)
      if (mask.pixel[static_cast<std::size_t>(i)] != 0) found.push_back(i);
    BOOST_TEST(found == allowed[static_cast<std::size_t>(channel)], boost::test_tools::per_element());
  }
  std::ofstream(path) << "box [[0pix, 0pix], [1pix, 0pix]], range=[0chan, 4chan]";
  BOOST_TEST(MaskFile(path, example_header(5)).one_for_all_channels());
}

BOOST_AUTO_TEST_CASE(a_range_that_misses_the_only_plane_is_refused) {
  BOOST_TEST(refused("circle [[1pix, 2pix], 3pix], range=[3chan, 7chan]",
                     "line 1: found 'range=[3chan, 7chan]', expected one that reaches"));
  BOOST_TEST(mask_of("circle [[1pix, 2pix], 3pix], range=[0chan, 7chan]").at(2, 1) == 1);
}

BOOST_AUTO_TEST_CASE(a_mask_of_other_planes_is_refused) {
  const TemporaryFolder folder;
  const imager::ImageHeader cube = example_header(3, "IQ");
  write_marked(cube, folder / "mask");
  const auto refused_for = [&](const imager::ImageHeader& image, const std::string& part) {
    for (const char* name : {"mask.fits", "mask"})
      BOOST_CHECK_EXCEPTION(MaskFile(folder / name, image), std::runtime_error, [&](const std::exception& error) {
        BOOST_TEST_INFO(error.what());
        return std::string(error.what()).find(part) != std::string::npos;
      });
  };
  imager::ImageHeader other = cube;
  other.spectral.channels = 4;
  refused_for(other, "expected one plane, or the image's 4 planes");
  other = cube;
  other.spectral.reference_hz += 0.2 * other.spectral.increment_hz;
  refused_for(other, "expected one plane, or the image's 3 planes");
  other = cube;
  other.stokes = {imager::Stokes::I, imager::Stokes::V};
  refused_for(other, "none of V");
  other = cube;
  other.geometry.phase_centre.ra_rad += 1e-4;
  refused_for(other, "lies elsewhere");
}

BOOST_AUTO_TEST_CASE(a_file_that_is_an_image_by_its_name_or_its_bytes_is_no_region_text) {
  const TemporaryFolder folder;
  const auto refused_as = [&](const std::string& name, const std::string& bytes, const std::string& part) {
    std::ofstream(folder / name, std::ios::binary) << bytes;
    BOOST_CHECK_EXCEPTION(read_mask(folder / name, geometry), std::runtime_error, [&](const std::exception& error) {
      BOOST_TEST_INFO(error.what());
      return std::string(error.what()).find("cannot read " + (folder / name) + ": " + part) == 0;
    });
  };
  for (const char* name : {"mask.fits", "mask.fit"}) refused_as(name, "", "it is no FITS file");
  refused_as("mask.gz", "\x1f\x8b\x08 and more", "it is no FITS file, but one compressed by gzip: uncompress it first");
  refused_as("mask.fits.bz2", "BZh91AY&SY", "it is no FITS file, but one compressed by bzip2: uncompress it first");
}

BOOST_AUTO_TEST_CASE(a_pipe_is_no_mask_and_no_model) {
  const TemporaryFolder folder;
  const std::string pipe = folder / "pipe";
  BOOST_REQUIRE(mkfifo(pipe.c_str(), 0600) == 0);
  const auto refused_as = [](const std::string& what) {
    return [what](const std::exception& error) { return error.what() == "cannot read " + what + ": it is no regular file"; };
  };
  BOOST_CHECK_EXCEPTION(read_mask(pipe, geometry), std::runtime_error, refused_as("mask " + pipe));
  BOOST_CHECK_EXCEPTION(open_image_file(pipe), std::runtime_error, refused_as(pipe));
}

BOOST_AUTO_TEST_SUITE_END()
