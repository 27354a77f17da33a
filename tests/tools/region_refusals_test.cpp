// What region files say and a mask cannot honour is refused, by line, with what was expected.
#include <stdexcept>
#include <string>

#include "tests/tools/region_masks.h"

BOOST_AUTO_TEST_SUITE(region_refusals)

using namespace misfit;

namespace {

bool refused(const std::string& regions, const std::string& part) {
  constexpr double degree = M_PI / 180;
  imager::ImageHeader header;
  header.geometry = {61, 47, 2 * degree / 3600, {187.7 * degree, 12.39 * degree, "FK5"}};
  header.spectral = {1.42e9, 1e6, 1, "LSRK", 1.42e9};
  try {
    tools::RegionText("regions", regions, header);
  } catch (const std::runtime_error& error) {
    const bool found = std::string(error.what()).find(part) != std::string::npos;
    BOOST_TEST(found, error.what() << " lacks " << part);
    return found;
  }
  return false;
}

}  // namespace

BOOST_AUTO_TEST_CASE(what_casa_region_text_cannot_mean_is_refused) {
  const std::string box = "box [[0pix, 0pix], [1pix, 0pix]]";
  BOOST_TEST(refused("#CRTFv1\n" + box, "line 1: found '#CRTFv1', expected version 0"));
  BOOST_TEST(refused("#CRTF\nblob [[1pix, 2pix]]", "line 2: found 'blob [[1pix, 2pix]]', expected one of box"));
  BOOST_TEST(refused("poly [[1pix, 2pix], [3pix, 4pix]]", "expected poly [[x1, y1], [x2, y2], [x3, y3], …]"));
  BOOST_TEST(refused("rotbox [[1pix, 2pix], [3pix, 4pix]]", "expected rotbox [[x, y], [width, height], angle]"));
  BOOST_TEST(refused("rotbox [[1pix, 2pix], [3pix, 4pix], 3pix]", "'3pix', expected an angle"));
  BOOST_TEST(refused("ellipse [[1pix, 2pix], 30deg, [3pix, 4pix]]", "expected ellipse"));
  BOOST_TEST(refused("annulus [[1pix, 2pix], [4pix, 3pix]]", "'4pix, 3pix', expected the inner radius first"));
  BOOST_TEST(refused("circle [[1pix, 2pix], 3pix", "expected circle [[x, y], radius]"));
  BOOST_TEST(refused("circle [[1pix, 2pix]], 3pix]", "'3pix]', expected a keyword"));
  BOOST_TEST(refused("circle [[1pix, 2pix], 2e9pix]", "at most 1e9 pixels"));
  BOOST_TEST(refused("circle [[1e10pix, 2pix], 2pix]", "a place at most 1e9 pixels away"));
  BOOST_TEST(refused(box + " " + box, "expected a keyword and its value"));
  BOOST_TEST(refused(box + ", coor=J2000", "'coor', expected one of coord, corr"));
  BOOST_TEST(refused(box + ", coord=AZEL", "'coord=AZEL', expected J2000"));
  BOOST_TEST(refused(box + ", coord=BMEAN", "a mean equinox is that of a date"));
  BOOST_TEST(refused(box + ", coord=", "expected a value"));
  BOOST_TEST(refused(box + ", corr=[I, S]", "'corr=[I, S]', expected some of I, Q"));
  BOOST_TEST(refused(box + ", corr=[I", "expected a closing bracket"));
  BOOST_TEST(refused(box + ", label='a, corr=[Q]", "expected a closing quote"));
  BOOST_TEST(refused(box + ", corr=[I], corr=[Q]", "expected corr once"));
  BOOST_TEST(refused(box + ", color=red # corr=[Q]", "expected comments on lines of their own"));
  BOOST_TEST(refused(box + ", frame=SUN", "'SUN'"));
  BOOST_TEST(refused(box + ", veltype=SLOW", "'veltype=SLOW', expected one of RADIO"));
  BOOST_TEST(refused("circle [[7.7deg, 12.39deg], 3pix]", "'7.7deg, 12.39deg', expected a place within 90 degrees"));
  BOOST_TEST(refused("circle [[12:30:49, 12.39deg], 3pix], coord=GALACTIC", "expected a longitude"));
  for (const char* place : {"12h60m48s, 12d23m24s", "12:30:60.1, 12d23m24s", "12h30m48s, 12d60m24s", "12h30m48s, 12.23.61",
                            "24h30m48s, 12d23m24s", "12h30m48s, 1h00m00s", "12.30.48, 12d23m24s", "12h30m-5s, 12d23m24s"})
    BOOST_TEST(refused(std::string("circle [[") + place + "], 3pix]", "', expected a "), place);
  BOOST_TEST(refused("circle [[547.7deg, 12.39deg], 3pix]", "'547.7deg, 12.39deg', expected a longitude of -360 to 360"));
}

BOOST_AUTO_TEST_CASE(what_a_global_line_cannot_mean_is_refused_there_whatever_uses_it) {
  const std::string box =
      "box [[0pix, 0pix], [1pix, 0pix]], corr=[I], coord=ICRS, range=[0chan, 0chan], frame=LSRK, veltype=Z, "
      "restfreq=1GHz\n";
  for (const char* keyword : {"corr=[I, S]", "coord=AZEL", "range=[1chan, 2GHz]", "range=[7, 8]", "range=[7chan, 3chan]",
                              "range=[1GHz, -2GHz]", "frame=SUN", "veltype=SLOW", "restfreq=7", "colour=red"}) {
    const std::string name = std::string(keyword).substr(0, std::string(keyword).find('='));
    const std::string shown = name == "frame" || name == "colour" ? "line 2: " : "line 2: found '" + std::string(keyword) + "'";
    for (const std::string& text : {box + "global " + keyword, box + "global color=red, " + keyword + "\n" + box})
      BOOST_TEST(refused(text, shown), keyword);
  }
  // Of the lines that they go with, others may say what these lack.
  tools::testing::mask_of("global range=[1.42GHz, 1.43GHz], frame=BARY\n" + box);
  tools::testing::mask_of("global range=[3chan, 7chan]\n" + box);
}

BOOST_AUTO_TEST_CASE(what_ds9_regions_cannot_mean_is_refused) {
  BOOST_TEST(refused("image;panda(3,4,0,90,1,2,3)", "'panda(3,4,0,90,1,2,3)', expected panda x y start stop n inner outer n"));
  BOOST_TEST(refused("image;panda(3,4,0,90,1,2,3,1,30)", "expected panda x y start stop n inner outer n"));
  BOOST_TEST(refused("image;panda(3,4,0,90,0,2,3,1)", "expected 1 sector and 1 ring at least"));
  BOOST_TEST(refused("image;panda(3,4,0,90,1,2,3,1.5)", "expected 1 sector and 1 ring at least"));
  BOOST_TEST(refused("image;panda(3,4,0,90,1,3,2,1)", "expected radii that rise"));
  BOOST_TEST(refused("image;epanda(3,4,0,90,1,2,3,1)", "expected epanda x y start stop n inner inner outer outer n [angle]"));
  BOOST_TEST(refused("image;bpanda(3,4,0,90,1,2,2,4,4,1,30,1)", "expected bpanda x y start stop n"));
  BOOST_TEST(refused("image;pie(3,4,0,90)", "'pie(3,4,0,90)', expected circle"));
  BOOST_TEST(refused("azel\ncircle(3,4,5)", "'azel', expected"));
  BOOST_TEST(refused("linear;circle(3,4,5)", "'linear', expected"));
  BOOST_TEST(refused("wcsa;fk5;circle(3,4,5)", "'wcsa', expected"));
  BOOST_TEST(refused("tile 2;circle(3,4,5)", "'tile 2', expected"));
  BOOST_TEST(refused("image;circle(3,4)", "expected circle x y radius"));
  BOOST_TEST(refused("image;circle(3,4,5) & !box(3,4,1,1)", "'& !box(3,4,1,1)', expected nothing"));
  BOOST_TEST(refused("image;circle(3,4,5", "expected a closing parenthesis"));
  BOOST_TEST(refused("image;polygon(3,4,5,6,7)", "expected polygon"));
  BOOST_TEST(refused("image;annulus(3,4,5,4)", "expected radii that rise"));
  BOOST_TEST(refused("image;circle(3,4,-5)", "'-5', expected a length above 0"));
  BOOST_TEST(refused("image;circle(3,4,5q)", "'5q', expected a length"));
  BOOST_TEST(refused("image;circle(3,4,5) # background", "expected a source"));
  BOOST_TEST(refused("image;global source=0\ncircle(3,4,5)", "expected a source"));
  BOOST_TEST(refused("image;circle(3,4,5) # colour=red", "'colour=red', expected properties"));
  BOOST_TEST(refused("image;circle(3,4,5) # include=no", "'include=no', expected 0 or 1"));
  BOOST_TEST(refused("image;circle(3,4,5) # text={a", "expected a closing"));
  BOOST_TEST(refused("fk5;circle(7.7,12,5\")", "expected a place within 90 degrees"));
  BOOST_TEST(refused("fk5;circle(7.7,100,5\")", "'7.7, 100', expected a latitude"));
  for (const char* place : {"12:60:48,12:23:24", "12:30:61,12:23:24", "12h30m48s,12d60m24s", "12.30.48,12:23:24"})
    BOOST_TEST(refused(std::string("fk5;circle(") + place + ",5\")", "', expected a coordinate"), place);
}

BOOST_AUTO_TEST_SUITE_END()
