#include "tools/drawing/pictures.h"

#include <unistd.h>

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>

BOOST_AUTO_TEST_SUITE(pictures)

using misfit::imager::Image;
using misfit::imager::SkyImage;
using misfit::tools::draw_pictures;
using misfit::tools::Shades;
using misfit::tools::Sketch;

namespace {

namespace fs = std::filesystem;

/// A folder whose name is hard to quote, removed at the end.
struct Folder {
  fs::path path = fs::temp_directory_path() / ("misfit \"pictures' $x " + std::to_string(getpid()));
  Folder() { fs::create_directories(path); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder() { fs::remove_all(path); }
  std::string file(const std::string& name) const { return (path / name).string(); }
};

SkyImage sky_image(int width, int height) {
  SkyImage sky;
  sky.image = Image(width, height);
  sky.geometry = {width, height, 2.4e-7, {3.276, -0.2, "ICRS"}};
  return sky;
}

std::string bytes_of(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::ostringstream bytes;
  bytes << file.rdbuf();
  return bytes.str();
}

bool is_png(const std::string& path) {
  return bytes_of(path).starts_with("\x89PNG\r\n\x1a\n");
}

struct Mean {
  double x = 0;
  double y = 0;
  double count = 0;
  void add(double more_x, double more_y) {
    x += more_x;
    y += more_y;
    ++count;
  }
};

/// Where the screen pixels lie, on average, whose colours are #fcffa4 (the brightest), #000004 (the darkest), white, that of
/// beams, #222222, and greenish, as gnuplot itself reads the PNG file.
struct Colours {
  Mean bright;
  Mean dark;
  Mean white;
  Mean ink;
  Mean green;
};
Colours colours_of(const Folder& folder, const std::string& name) {
  std::ofstream(folder.path / "measure") << "set table 'pixels'\n"
                                         << "plot '" << name << "' binary filetype=png using 1:2:3:4:5 with rgbimage\n";
  const fs::path before = fs::current_path();
  fs::current_path(folder.path);
  const int status = std::system("gnuplot -d measure 2> said");
  fs::current_path(before);
  BOOST_TEST_REQUIRE(status == 0);

  Colours colours;
  std::ifstream pixels(folder.path / "pixels");
  for (std::string line; std::getline(pixels, line);) {
    std::istringstream words(line);
    double x = 0, y = 0;
    int red = 0, green = 0, blue = 0;
    if (!(words >> x >> y >> red >> green >> blue)) continue;
    if (red == 0 && blue == 4) colours.dark.add(x, y);
    if (red == 252 && blue == 164) colours.bright.add(x, y);
    if (green > red + 40 && green > blue + 20) colours.green.add(x, y);
    if (red == 34 && green == 34 && blue == 34) colours.ink.add(x, y);
    if (red == 255 && green == 255 && blue == 255) colours.white.add(x, y);
  }
  return colours;
}

/// How far the brightest screen pixels lie on average from the darkest, to the right and up.
struct Offset {
  double right = 0;
  double up = 0;
};
Offset bright_from_dark(const Folder& folder, const std::string& name) {
  const auto [bright, dark, white, ink, green] = colours_of(folder, name);
  BOOST_TEST_REQUIRE(dark.count > 0);
  BOOST_TEST_REQUIRE(bright.count > 0);
  return {bright.x / bright.count - dark.x / dark.count, bright.y / bright.count - dark.y / dark.count};
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_drawing_that_is_not_finished_leaves_nothing) {
  const Folder folder;
  const SkyImage sky = sky_image(10, 10);
  {
    misfit::tools::PictureDrawing drawing;
    drawing.add({{&sky, "one", folder.file("one.png")}});
  }
  BOOST_TEST(fs::is_empty(folder.path));
}

BOOST_AUTO_TEST_CASE(every_image_is_drawn_and_nothing_else_is_left) {
  SkyImage zero = sky_image(30, 20);
  SkyImage blank = sky_image(20, 64);
  for (double& pixel : blank.image.pixel) pixel = std::numeric_limits<double>::quiet_NaN();
  SkyImage large = sky_image(1500, 1200);
  large.image.at(600, 700) = 1;
  large.image.at(10, 10) = std::numeric_limits<double>::infinity();
  large.has_beam = true;
  large.beam = {2e-6, 1e-6, 0.5};

  const Folder folder;
  BOOST_TEST(draw_pictures({}) == "");
  BOOST_TEST(draw_pictures({{&zero, "it's {zero}_0 \\ `ls` @x", folder.file("it's zero.png")},
                            {&blank, "two\nlines", folder.file("blank.png")},
                            {&large, "large", folder.file("large.png")}}) == "");
  for (const char* name : {"it's zero.png", "blank.png", "large.png"}) BOOST_TEST(is_png(folder.file(name)), name);
  BOOST_TEST(std::distance(fs::directory_iterator(folder.path), fs::directory_iterator()) == 3);
}

BOOST_AUTO_TEST_CASE(east_is_left_and_north_is_up, *boost::unit_test::label("others")) {
  const Folder folder;
  for (const int column : {2, 8}) {
    for (const int row : {1, 7}) {
      SkyImage sky = sky_image(10, 10);
      sky.image.at(row, column) = 1;
      BOOST_TEST_REQUIRE(draw_pictures({{&sky, "one source", folder.file("one.png")}}) == "");
      const Offset offset = bright_from_dark(folder, "one.png");
      // An image pixel is 64 screen pixels wide; the ends of the colour bar, of the same colours, move the averages by less
      // than half of that.
      BOOST_TEST(std::abs(offset.right - (column - 4.5) * 64) < 32);
      BOOST_TEST(std::abs(offset.up - (row - 4.5) * 64) < 32);
    }
  }
}

BOOST_AUTO_TEST_CASE(pixels_without_value_have_the_colour_of_the_background, *boost::unit_test::label("others")) {
  const Folder folder;
  SkyImage sky = sky_image(10, 10);
  sky.image.at(2, 7) = 1;
  BOOST_TEST_REQUIRE(draw_pictures({{&sky, "whole", folder.file("whole.png")}}) == "");
  for (int row = 0; row < 10; ++row)
    for (int column = 0; column < 5; ++column) sky.image.at(row, column) = std::numeric_limits<double>::quiet_NaN();
  BOOST_TEST_REQUIRE(draw_pictures({{&sky, "half", folder.file("half.png")}}) == "");
  const Colours whole = colours_of(folder, "whole.png"), half = colours_of(folder, "half.png");
  // Half of 640 × 640 screen pixels, but for those under tics and frame.
  const double expected = 640 * 320;
  BOOST_TEST(std::abs(whole.dark.count - half.dark.count - expected) < 0.02 * expected);
  BOOST_TEST(std::abs(half.white.count - whole.white.count - expected) < 0.02 * expected);
}

BOOST_AUTO_TEST_CASE(a_sketch_draws_what_its_image_would) {
  SkyImage sky = sky_image(900, 700);
  for (std::size_t k = 0; k < sky.image.pixel.size(); ++k) sky.image.pixel[k] = std::sin(static_cast<double>(k * k));
  sky.image.at(300, 500) = 40;
  SkyImage gone = sky;
  gone.image = {};
  const Folder folder;
  for (const Shades shades : {Shades::brightness, Shades::about_zero}) {
    const Sketch kept = sketch(sky.image, shades, misfit::tools::picture_side);
    BOOST_TEST(draw_pictures(
                   {{&sky, "one", folder.file("a.png"), shades},
                    {.image = &gone, .title = "one", .path = folder.file("b.png"), .shades = shades, .sketch = &kept}}) == "");
    BOOST_TEST(bytes_of(folder.file("a.png")) == bytes_of(folder.file("b.png")));
  }
}

BOOST_AUTO_TEST_CASE(a_mask_is_outlined_where_it_lies, *boost::unit_test::label("others")) {
  SkyImage sky = sky_image(10, 10);
  sky.image.at(5, 5) = 1;
  Image mask(10, 10);
  for (const int row : {6, 7})
    for (const int column : {1, 2, 3, 4}) mask.at(row, column) = 1;
  const Folder folder;
  BOOST_TEST_REQUIRE(draw_pictures({{&sky, "one", folder.file("none.png")}}) == "");
  BOOST_TEST(colours_of(folder, "none.png").green.count == 0);
  BOOST_TEST_REQUIRE(draw_pictures({{.image = &sky, .title = "one", .path = folder.file("one.png"), .mask = &mask}}) == "");
  const Colours colours = colours_of(folder, "one.png");
  const auto [source, outline] = std::pair{colours.bright, colours.green};
  // An image pixel is 64 screen pixels wide; the colour bar is as bright as the source at its end, and lines are two wide.
  BOOST_TEST(outline.count > 12 * 64);
  BOOST_TEST(outline.count < 3 * 12 * 64);
  BOOST_TEST(std::abs(outline.x / outline.count - source.x / source.count + 2.5 * 64) < 32);
  BOOST_TEST(std::abs(outline.y / outline.count - source.y / source.count - 1.5 * 64) < 32);
}

BOOST_AUTO_TEST_CASE(a_mask_of_nothing_or_of_everything_has_no_outline, *boost::unit_test::label("others")) {
  SkyImage sky = sky_image(10, 10);
  sky.image.at(5, 5) = 1;
  const Folder folder;
  for (const double value : {0.0, 1.0}) {
    Image mask(10, 10);
    for (double& pixel : mask.pixel) pixel = value;
    BOOST_TEST(draw_pictures({{.image = &sky, .title = "one", .path = folder.file("one.png"), .mask = &mask}}) == "");
    BOOST_TEST(colours_of(folder, "one.png").green.count == 0);
  }
}

BOOST_AUTO_TEST_CASE(a_beam_is_drawn_to_scale_unless_it_takes_half_of_a_side, *boost::unit_test::label("others")) {
  SkyImage sky = sky_image(64, 64);
  const Folder folder;
  const auto ink = [&](double beam_pixels) {
    sky.has_beam = true;
    sky.beam = {2 * beam_pixels * sky.geometry.cell_rad, beam_pixels * sky.geometry.cell_rad, 0.5};
    BOOST_TEST_REQUIRE(draw_pictures({{&sky, "one", folder.file("one.png")}}) == "");
    return colours_of(folder, "one.png").ink.count;
  };
  // An image pixel is 10 screen pixels wide; letters and tics, in the same colour, change little, and outlines cover a pixel
  // more.
  const double none = ink(60), small = ink(4), large = ink(8);
  const auto area = [](double beam_pixels) { return M_PI / 2 * 100 * beam_pixels * beam_pixels; };
  BOOST_TEST(std::abs(small - none - area(4)) < 0.1 * area(4));
  BOOST_TEST(std::abs(large - none - area(8)) < 0.1 * area(8));
}

BOOST_AUTO_TEST_CASE(without_gnuplot_the_reason_is_returned) {
  const SkyImage sky = sky_image(10, 10);
  const Folder folder;
  const std::string path = std::getenv("PATH");
  setenv("PATH", folder.path.c_str(), 1);
  const std::string said = draw_pictures({{&sky, "one", folder.file("one.png")}});
  setenv("PATH", path.c_str(), 1);
  BOOST_TEST(said == "Pictures are left out: gnuplot is not installed.");
  BOOST_TEST(fs::is_empty(folder.path));
}

BOOST_AUTO_TEST_CASE(a_picture_that_cannot_be_written_is_named) {
  const SkyImage sky = sky_image(10, 10);
  BOOST_CHECK_EXCEPTION(
      draw_pictures({{&sky, "one", "/no such folder/one.png"}}), std::runtime_error,
      [](const std::runtime_error& e) { return std::string(e.what()).find("/no such folder/one.png") != std::string::npos; });
}

BOOST_AUTO_TEST_CASE(without_a_place_to_work_the_reason_is_returned) {
  const SkyImage sky = sky_image(10, 10);
  const Folder folder;
  const char* const before = std::getenv("TMPDIR");
  const std::string kept = before == nullptr ? "" : before;
  setenv("TMPDIR", "/no such folder", 1);
  const std::string said = draw_pictures({{&sky, "one", folder.file("one.png")}});
  if (before == nullptr)
    unsetenv("TMPDIR");
  else
    setenv("TMPDIR", kept.c_str(), 1);
  BOOST_TEST(said == "Pictures are left out: there is no folder for temporary files; expected one in TMPDIR.");
  BOOST_TEST(fs::is_empty(folder.path));
}

BOOST_AUTO_TEST_SUITE_END()
