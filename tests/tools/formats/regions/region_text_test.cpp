// One region written in two ways is one mask.
#include "tools/formats/regions/region_text.h"

#include <cmath>
#include <cstdio>
#include <functional>
#include <string>

#include "ms_io/celestial_frames.h"
#include "tests/tools/region_masks.h"

BOOST_AUTO_TEST_SUITE(region_text)

using namespace misfit;
using namespace misfit::tools::testing;

namespace {

/// The mask must hold the pixels where allowed(column, row).
void check_mask(const std::string& text, const std::function<bool(int, int)>& allowed) {
  BOOST_TEST_CONTEXT(text) {
    const imager::Image mask = mask_of(text);
    int wrong = 0;
    for (int r = 0; r < mask.height; ++r)
      for (int c = 0; c < mask.width; ++c) wrong += mask.at(r, c) != (allowed(c, r) ? 1 : 0);
    BOOST_TEST(wrong == 0);
  }
}

template <typename... Values>
std::string text(const char* form, Values... values) {
  char line[400];
  std::snprintf(line, sizeof line, form, values...);
  return line;
}

/// Where pixel (column, row) lies in a frame.
imager::SkyDirection place_of(double column, double row, const imager::ImageHeader& header, const std::string& frame) {
  const imager::ImageGeometry& g = header.geometry;
  const imager::DirectionCosines at{-(column - g.centre_column()) * g.cell_rad, (row - g.centre_row()) * g.cell_rad};
  return ms_io::in_frame(imager::sky_direction(at, g.phase_centre), frame);
}

std::string crtf_place(double column, double row, const imager::ImageHeader& header, const std::string& frame) {
  const imager::SkyDirection at = place_of(column, row, header, frame);
  return text("[%.13fdeg, %.13fdeg]", at.ra_rad / degree, at.dec_rad / degree);
}

std::string ds9_place(double column, double row, const imager::ImageHeader& header, const std::string& frame) {
  const imager::SkyDirection at = place_of(column, row, header, frame);
  return text("%.13f, %.13f", at.ra_rad / degree, at.dec_rad / degree);
}

/// How far the north of `frame` is turned at the phase centre, anticlockwise, from the image's: minus the position angle in
/// `frame` of the image frame's pole (Smart 1977, Textbook on Spherical Astronomy, chapter 1).
double north_of(const std::string& frame, const imager::ImageHeader& header) {
  const imager::SkyDirection centre = ms_io::in_frame(header.geometry.phase_centre, frame);
  const imager::SkyDirection pole = ms_io::in_frame({0, M_PI / 2, header.geometry.phase_centre.frame}, frame);
  const double east = pole.ra_rad - centre.ra_rad;
  return -std::atan2(
      std::cos(pole.dec_rad) * std::sin(east),
      std::sin(pole.dec_rad) * std::cos(centre.dec_rad) - std::cos(pole.dec_rad) * std::sin(centre.dec_rad) * std::cos(east));
}

struct Frame {
  const char* name;
  const char* crtf;
  const char* ds9;  ///< empty where DS9 has it not
  bool of_images = true;
};
constexpr Frame frames[] = {{"FK5", "J2000", "fk5"},
                            {"ICRS", "ICRS", "icrs"},
                            {"FK4", "B1950", "fk4"},
                            {"GALACTIC", "GALACTIC", "galactic"},
                            {"ECLIPTIC", "ECLIPTIC", "ecliptic", false},
                            {"SUPERGAL", "SUPERGAL", "", false},
                            {"B1950_VLA", "B1950_VLA", "", false}};

/// Calls `check` with each frame of images and each of regions.
void for_frames(const std::function<void(const imager::ImageHeader&, const Frame&)>& check) {
  for (const Frame& image : frames)
    for (const Frame& region : frames)
      if (image.of_images) check(header_in(image.name), region);
}

}  // namespace

BOOST_AUTO_TEST_CASE(turned_shapes_hold_the_pixels_whose_centres_lie_within) {
  // No border passes within 1e-3 of a pixel's centre: sizes and centres are such fractions.
  for (const double turn : {0.0, 17.3, 45.1, 90.0, 133.7, -30.2, 271.9})
    for (const double column : {20.13, 31.37}) {
      const double row = 0.7 * column + 1.211, cosine = std::cos(turn * degree), sine = std::sin(turn * degree);
      const auto x = [&](int c, int r) { return (c - column) * cosine + (r - row) * sine; };
      const auto y = [&](int c, int r) { return -(c - column) * sine + (r - row) * cosine; };
      check_mask(text("rotbox [[%gpix, %gpix], [14.27pix, 6.83pix], %gdeg]", column, row, turn),
                 [&](int c, int r) { return std::abs(x(c, r)) <= 7.135 && std::abs(y(c, r)) <= 3.415; });
      // Its first half axis lies along columns, north, at 0.
      check_mask(text("ellipse [[%gpix, %gpix], [9.41pix, 4.13pix], %gdeg]", column, row, turn),
                 [&](int c, int r) { return std::hypot(x(c, r) / 4.13, y(c, r) / 9.41) <= 1; });
      check_mask(text("annulus [[%gpix, %gpix], [3.3pix, 7.7pix]]", column, row), [&](int c, int r) {
        const double radius = std::hypot(c - column, r - row);
        return radius <= 7.7 && radius > 3.3;
      });
    }
}

BOOST_AUTO_TEST_CASE(pandas_hold_what_of_an_annulus_lies_in_their_sector) {
  for (const double from : {0.0, 33.7, 200.3, -70.2})
    for (const double span : {20.1, 90.0, 180.0, 291.3, 360.0})
      for (const double turn : {0.0, 27.4}) {
        const double column = 30.13, row = 20.37;
        const auto within = [&](int c, int r, double turned) {
          const double past = std::atan2(r - row, c - column) / degree - from - turned;
          return past - 360 * std::floor(past / 360) <= span;
        };
        const auto x = [&](int c, int r) {
          return (c - column) * std::cos(turn * degree) + (r - row) * std::sin(turn * degree);
        };
        const auto y = [&](int c, int r) {
          return (r - row) * std::cos(turn * degree) - (c - column) * std::sin(turn * degree);
        };
        for (const char* panda : {"panda", "cpanda"})
          check_mask(text("image; %s(%g,%g,%g,%g,3,4.3,11.7,2)", panda, column + 1, row + 1, from, from + span),
                     [&](int c, int r) {
                       const double radius = std::hypot(c - column, r - row);
                       return radius <= 11.7 && radius > 4.3 && within(c, r, 0);
                     });
        check_mask(text("image; epanda(%g,%g,%g,%g,1,4.3,2.2,14.7,7.6,1,%g)", column + 1, row + 1, from, from + span, turn),
                   [&](int c, int r) {
                     return std::hypot(x(c, r) / 14.7, y(c, r) / 7.6) <= 1 && std::hypot(x(c, r) / 4.3, y(c, r) / 2.2) > 1 &&
                            within(c, r, turn);
                   });
        check_mask(text("image; bpanda(%g,%g,%g,%g,1,0,0,24.7,15.6,4,%g)", column + 1, row + 1, from, from + span, turn),
                   [&](int c, int r) { return std::abs(x(c, r)) <= 12.35 && std::abs(y(c, r)) <= 7.8 && within(c, r, turn); });
      }
}

BOOST_AUTO_TEST_CASE(the_sectors_of_a_panda_make_its_annulus) {
  const std::string annulus = "image; annulus(31,21,3,9)";
  check_same(annulus, "image; panda(31,21,0,360,4,3,9,2)");
  check_same(annulus, "image; panda(31,21,45,45,4,3,9,2)");
  check_same(annulus, "image; panda(31,21,-30,90,1,3,9,1); panda(31,21,90,330,1,3,9,1)");  // borders belong to both
  check_same("image; ellipse(31,21,3,2,9,6,30)",
             "image\nepanda(31,21,0,200,2,3,2,9,6,2,30) || # epanda=(0 100 200)(3 2 9 6)(30)"
             " color=red\nepanda(31,21,200,360,1,3,2,9,6,1,30) # epanda=ignore");
  // Places on the sky count from the west of the frame, as pixels do where north is up.
  check_same("image; panda(31,24,20,130,1,3.1,9.2,1)", "fk5; panda(187.7,12.39,20,130,1,6.2\",18.4\",1)");
}

BOOST_AUTO_TEST_CASE(borders_belong_to_a_shape_however_it_is_written) {
  check_mask("box [[10pix, 5pix], [20pix, 8pix]]", [](int c, int r) { return c >= 10 && c <= 20 && r >= 5 && r <= 8; });
  for (const int quarter : {0, 1, 2, 3, 4, 5, -1, -7}) {
    const bool across = quarter % 2 != 0;
    check_same(text("rotbox [[30pix, 20pix], [12pix, 6pix], %ddeg]", 90 * quarter),
               text("centerbox [[30pix, 20pix], [%dpix, %dpix]]", across ? 6 : 12, across ? 12 : 6));
    check_same(text("ellipse [[30pix, 20pix], [13pix, 5pix], %ddeg]", 90 * quarter),
               text("ellipse [[30pix, 20pix], [%dpix, %dpix], 0deg]", across ? 5 : 13, across ? 13 : 5));
  }
  check_same("rotbox [[30pix, 20pix], [1.41421356237pix, 1.41421356237pix], 45deg]", "circle [[30pix, 20pix], 1pix]");
  check_same("box [[3pix, 4pix], [3pix, 9pix]]", "centerbox [[3pix, 6.5pix], [1pix, 5pix]]");  // a single column
  check_same("poly [[3pix, 4pix], [9pix, 10pix], [3pix, 4pix]]", "rotbox [[6pix, 7pix], [8.4852813742pix, .01pix], 45deg]");
}

BOOST_AUTO_TEST_CASE(one_region_written_in_two_ways_is_one_mask) {
  for (const double x : {12.0, 30.5, 58.25})
    for (const double y : {3.0, 20.75})
      for (const double size : {1.0, 4.5, 11.0}) {
        check_same(text("box [[%gpix, %gpix], [%gpix, %gpix]]", x, y, x + size, y + 2 * size),
                   text("poly [[%gpix, %gpix], [%gpix, %gpix], [%gpix, %gpix], [%gpix, %gpix]]", x + size, y, x, y, x,
                        y + 2 * size, x + size, y + 2 * size));
        check_same(text("box [[%gpix, %gpix], [%gpix, %gpix]]", x, y + 2 * size, x + size, y),
                   text("centerbox [[%gpix, %gpix], [%gpix, %gpix]]", x + size / 2, y + size, size, 2 * size));
        check_same(text("circle [[%gpix, %gpix], %gpix]", x, y, size),
                   text("ellipse [[%gpix, %gpix], [%gpix, %gpix], 33deg]", x, y, size, size));
        check_same(text("annulus [[%gpix, %gpix], [%gpix, %gpix]]", x, y, size, 2 * size),
                   text("circle [[%gpix, %gpix], %gpix]\n-circle [[%gpix, %gpix], %gpix]", x, y, 2 * size, x, y, size));
      }
  check_same("annulus [[30pix, 20pix], [0pix, 7pix]]", "circle [[30pix, 20pix], 7pix]");
}

BOOST_AUTO_TEST_CASE(parts_of_a_polygon_that_overlap_belong_to_it) {
  // Twice round the middle, as a star is drawn, and the corners in the other order.
  const std::string star = "[30pix, 40pix], [40pix, 8pix], [13pix, 28pix], [47pix, 28pix], [20pix, 8pix]";
  BOOST_TEST(mask_of("poly [" + star + "]").at(22, 30) == 1);
  check_same("poly [" + star + "]", "poly [[20pix, 8pix], [47pix, 28pix], [13pix, 28pix], [40pix, 8pix], [30pix, 40pix]]");
}

BOOST_AUTO_TEST_CASE(pixels_of_ds9_count_from_1_and_those_of_casa_from_0) {
  for (const char* frame : {"image", "physical", "IMAGE", ""})
    for (const double x : {14.0, 30.5})
      for (const double turn : {0.0, 30.0, 90.0, 200.0}) {
        const std::string system = std::string(frame) + (*frame != '\0' ? "\n" : "");
        check_same(system + text("box(%g,%g,12,5,%g)", x + 1, x, turn),
                   text("rotbox [[%gpix, %gpix], [12pix, 5pix], %gdeg]", x, x - 1, turn));
        // The first radius lies along rows in DS9, along columns in CASA.
        check_same(system + text("ellipse %g %g 9 4 %g", x + 1, x, turn),
                   text("ellipse [[%gpix, %gpix], [4pix, 9pix], %gdeg]", x, x - 1, turn));
        check_same(system + text("circle(%gi %gp 7i)", x + 1, x), text("circle [[%gpix, %gpix], 7pix]", x, x - 1));
        check_same(system + text("annulus(%g,%g,3,5,8)", x + 1, x), text("annulus [[%gpix, %gpix], [3pix, 8pix]]", x, x - 1));
        check_same(system + text("polygon(%g,%g,%g,%g,25,40)", x + 1, x, x + 9, x),
                   text("poly [[%gpix, %gpix], [%gpix, %gpix], [24pix, 39pix]]", x, x - 1, x + 8, x - 1));
      }
}

BOOST_AUTO_TEST_CASE(places_and_sizes_on_the_sky_are_those_in_pixels_whatever_the_frames) {
  for_frames([](const imager::ImageHeader& header, const Frame& region) {
    const auto crtf = [&](double c, double r) { return crtf_place(c, r, header, region.name); };
    const auto ds9 = [&](double c, double r) { return ds9_place(c, r, header, region.name); };
    const std::string coord = std::string(" coord=") + region.crtf, system = std::string(region.ds9) + "; ";
    check_same("circle [[40.1pix, 12.3pix], 7.1pix]", "circle [" + crtf(40.1, 12.3) + ", 14.2arcsec]" + coord, header);
    check_same("annulus [[20.1pix, 30.3pix], [2.1pix, 7.3pix]]",
               "annulus [" + crtf(20.1, 30.3) + ", [4.2arcsec, 7.3pix]]" + coord, header);
    check_same("poly [[5.1pix, 6.2pix], [50.3pix, 11.4pix], [22.7pix, 44.9pix]]",
               "poly [" + crtf(5.1, 6.2) + ", " + crtf(50.3, 11.4) + ", " + crtf(22.7, 44.9) + "]" + coord, header);
    if (*region.ds9 == '\0') return;
    check_same("circle [[40.1pix, 12.3pix], 7.1pix]", system + "circle(" + ds9(40.1, 12.3) + ", 14.2\")", header);
    check_same("poly [[5.1pix, 6.2pix], [50.3pix, 11.4pix], [22.7pix, 44.9pix]]",
               system + "polygon(" + ds9(5.1, 6.2) + ", " + ds9(50.3, 11.4) + ", " + ds9(22.7, 44.9) + ")", header);
  });
}

BOOST_AUTO_TEST_CASE(angles_count_from_the_north_of_the_frame_that_names_the_place) {
  for_frames([](const imager::ImageHeader& header, const Frame& region) {
    const std::string there = crtf_place(30, 23, header, region.name), coord = std::string(", coord=") + region.crtf;
    const std::string ds9_there = std::string(region.ds9) + "\n", at = ds9_place(30, 23, header, region.name);
    for (const double turn : {0.0, 28.0, -71.0}) {
      const double turned = turn + north_of(region.name, header) / degree;
      const std::string box = text("rotbox [[30pix, 23pix], [24.3pix, 7.1pix], %.9fdeg]", turned);
      check_same(box, "rotbox [" + there + text(", [48.6arcsec, 14.2arcsec], %.9fdeg]", turn) + coord, header);
      if (*region.ds9 != '\0') check_same(box, ds9_there + "box(" + at + text(", 48.6\", 14.2\", %.9f)", turn), header);
      const std::string ellipse = text("ellipse [[30pix, 23pix], [14.3pix, 5.1pix], %.9fdeg]", turned);
      check_same(ellipse, "ellipse [" + there + text(", [28.6arcsec, 10.2arcsec], %.9fdeg]", turn) + coord, header);
      if (*region.ds9 != '\0') check_same(ellipse, ds9_there + "ellipse(" + at + text(", 10.2\", 28.6\", %.9f)", turn), header);
    }
    check_same(text("rotbox [[30pix, 23pix], [24.3pix, 7.1pix], %.9fdeg]", north_of(region.name, header) / degree),
               "centerbox [" + there + ", [48.6arcsec, 14.2arcsec]]" + coord, header);
  });
}

BOOST_AUTO_TEST_CASE(north_is_that_of_the_centre_of_the_shape) {
  // 1.7° from the phase centre at declination 80° the meridian is turned by 10°. A box of half an arcminute has straight sides
  // there: its meridians draw together by 1e-3 of its width.
  imager::ImageHeader header = header_in();
  header.geometry.phase_centre.dec_rad = 80 * degree;
  for (const double ra : {177.7, 197.7}) {
    const imager::DirectionCosines at =
        imager::direction_cosines({ra * degree, 80 * degree, "FK5"}, header.geometry.phase_centre);
    header.geometry.centre = {at.l, at.m};
    const double half_ra = 15.1 / 3600 / std::cos(80 * degree), half_dec = 6.3 / 3600;
    const std::string box =
        text("box [[%.9fdeg, %.9fdeg], [%.9fdeg, %.9fdeg]]", ra - half_ra, 80 - half_dec, ra + half_ra, 80 + half_dec);
    check_same(box, text("centerbox [[%.9fdeg, 80deg], [30.2arcsec, 12.6arcsec]]", ra), header);
    check_same(box, text("fk5;box(%.9f,80,30.2\",12.6\",0)", ra), header);
    check_same(box, text("rotbox [[30pix, 23pix], [15.1pix, 6.3pix], %.9fdeg]", (187.7 - ra) * std::sin(80 * degree)), header);
  }
}

BOOST_AUTO_TEST_CASE(j2000_and_icrs_are_told_apart) {
  // 187.7°, 12.39° of J2000 lies 13.288 mas to the west of those numbers in ICRS and 17.381 mas to the south, by the frame bias
  // of Hilton & Hohenkerk (2004, A&A 413, 765): ξ0 = −16.617, η0 = −6.8192, dα0 = −14.6 mas.
  imager::ImageHeader header = header_in("ICRS");
  header.geometry.cell_rad = 1e-3 * arcsec;
  const std::string there = "circle [[187.7deg, 12.39deg], 3.3pix], coord=";
  check_same(there + "J2000", "circle [[43.288pix, 5.619pix], 3.3pix]", header);
  check_same(there + "FK5", "fk5\ncircle(187.7, 12.39, 0.0033\")", header);
  check_same(there + "ICRS", "circle [[30pix, 23pix], 3.3pix]", header);
  check_same("circle [[187.7deg, 12.39deg], 3.3pix]", "circle [[30pix, 23pix], 3.3pix]", header);  // the image's own
}

BOOST_AUTO_TEST_CASE(other_frames_are_those_of_other_software) {
  // Astropy 5.2, from 187.7°, 12.39° in FK5. Its Galactic coordinates and B1950 differ from casacore's by what the E-terms of
  // aberration do, up to half an arcsecond: 0.025 pixels here, and no pixel's centre is as near to the border.
  imager::ImageHeader header = header_in();
  header.geometry.cell_rad = 20 * arcsec;
  const std::string here = "circle [[30pix, 23pix], 7.14pix]";
  check_same(here, "circle [[283.7583216726deg, 74.4883501866deg], 7.14pix], coord=GALACTIC", header);
  check_same(here, "galactic;circle(283:45:29.958, 74:29:18.061, 142.8\")", header);
  check_same(here, "circle [[187.0672882978deg, 12.6660687691deg], 7.14pix], coord=B1950", header);
}

BOOST_AUTO_TEST_CASE(casa_takes_away_in_order_and_ds9_last) {
  const std::string whole = "box [[-9pix, -9pix], [99pix, 99pix]]\n", hole = "-circle [[30pix, 20pix], 7pix]\n";
  check_same("box [[2pix, 2pix], [9pix, 9pix]]\n-box [[2pix, 2pix], [9pix, 5pix]]\n+box [[2pix, 3pix], [9pix, 3pix]]",
             "box [[2pix, 6pix], [9pix, 9pix]]\nbox [[2pix, 3pix], [9pix, 3pix]]");
  check_same(whole + hole, hole);  // what is taken away first is so from the whole image
  check_same(whole + hole, "image;-circle(31,21,7)");
  check_same(hole + "circle [[30pix, 20pix], 2pix]", whole + hole + "circle [[30pix, 20pix], 2pix]");
  check_same("image\n-circle(31,21,3)\ncircle(31,21,7)", "annulus [[30pix, 20pix], [3pix, 7pix]]");
  check_same("image\ncircle(31,21,7)\ncircle(31,21,3) # include=0", "annulus [[30pix, 20pix], [3pix, 7pix]]");
  check_same("image\nglobal include=0\ncircle(31,21,7) # include=1\ncircle(31,21,3)", "annulus [[30pix, 20pix], [3pix, 7pix]]");
}

BOOST_AUTO_TEST_SUITE_END()
