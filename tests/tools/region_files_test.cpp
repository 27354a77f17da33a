// Region files as programs write them, and of which planes their regions are.
#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include "tests/tools/region_masks.h"

BOOST_AUTO_TEST_SUITE(region_files)

using namespace misfit;
using namespace misfit::tools::testing;
using tools::RegionText;

namespace {

bool refused(const std::string& regions, const std::string& part, const imager::ImageHeader& header = header_in()) {
  try {
    RegionText("regions", regions, header);
  } catch (const std::runtime_error& error) {
    BOOST_TEST_MESSAGE(error.what());
    const bool found = std::string(error.what()).find(part) != std::string::npos;
    BOOST_TEST(found, error.what() << " lacks " << part);
    return found;
  }
  return false;
}

}  // namespace

BOOST_AUTO_TEST_CASE(an_editor_s_mark_of_utf_8_is_none_of_the_text) {
  const std::string mark = "\xef\xbb\xbf";
  check_same(mark + "#CRTFv0\ncircle [[30pix, 20pix], 7pix]", "circle [[30pix, 20pix], 7pix]");
  check_same(mark + "image;circle(31,21,7)", "circle [[30pix, 20pix], 7pix]");
}

BOOST_AUTO_TEST_CASE(files_of_carta_and_ds9_are_read_as_they_write_them) {
  check_same(
      "#CRTFv0 CASA Region Text Format version 0\n"
      "rotbox [[12:30:49.3653, +12.23.04.0000], [30.2arcsec, 20.2arcsec], 30deg] coord=J2000, corr=[I], linewidth=1, "
      "linestyle=-, symsize=1, symthick=1, color=green, font=Helvetica, fontsize=10, fontstyle=bold, usetex=false\n"
      "# textbox [[20pix, 20pix], [3pix, 3pix]] label=\"x\", align=center\n"
      "ann polyline [[20pix, 20pix], [3pix, 3pix]] coord=J2000, linewidth=2\nvector [[1pix, 2pix], [3pix, 4pix]] coord=J2000\n",
      "rotbox [[20pix, 13pix], [15.1pix, 10.1pix], 30deg]\n");
  check_same(
      "ellipse [[30pix, 20pix], [10.4000pix, 4.3000pix], 30deg] coord=J2000, linewidth=1, linestyle=-, color=2EE6D6, "
      "label=\"it's; [a]\", labelcolor=2EE6D6, labelpos=top, font=Fixed [Sony], fontsize=10, fontstyle=bold-italic",
      "# Region file format: DS9 CARTA 5\nglobal color=green dashlist=8 3 width=1 font=\"helvetica 10 normal roman\" select=1 "
      "highlite=1 dash=0 fixed=0 edit=1 move=1 delete=1 include=1 source=1\nimage\n"
      "ellipse(31.00, 21.00, 10.40, 4.30, 120) # color=#2EE6D6 width=1 text={it's; #a}\n"
      "# text(10,20) text={not a region}\nline(1,2,3,4) # line=0 1 color=red\n");
  check_same(
      "# Region file format: DS9 version 4.1\nimage\n# composite(30,20,0) || composite=1 color=green\n"
      "circle(31,21,7) || # color=red tag={a} tag={b}\nbox(11,11,5,5,0) # source dash=1",
      "circle [[30pix, 20pix], 7pix]\ncenterbox [[10pix, 10pix], [5pix, 5pix]]");
  check_same("global color=red; image; circle(31,21,7)", "circle [[30pix, 20pix], 7pix]");
  check_same("Global color=red\ncircle [[30pix, 20pix], 7pix]", "circle [[30pix, 20pix], 7pix]");
  check_same("ellipse 20 20 4 8; box 30 30 6 8 # text='a; b' ; tile 1; line 1 1 4 4",
             "ellipse [[19pix, 19pix], [8pix, 4pix], 0deg]\ncenterbox [[29pix, 29pix], [6pix, 8pix]]");
  check_same("image; ellipse(31,21,4,2,12,6,30); box(11,11,2,2,4,4,n=2)",
             "image; ellipse(31,21,12,6,30); -ellipse(31,21,4,2,30); box(11,11,4,4); -box(11,11,2,2)");
}

BOOST_AUTO_TEST_CASE(places_are_written_in_every_way_that_casa_and_ds9_know) {
  const std::string here = "circle [[30pix, 23pix], 3.3pix]";
  for (const char* ra : {"12h30m48s", "12:30:48.0", "187.7deg", "3.27598300rad", "187d42m00s", "'187.7deg'"})
    for (const char* dec : {"12d23m24s", "+12d23m24.0s", "12.23.24.0", "+12.23.24", "12.39deg"})
      check_same(here, std::string("circle[[") + ra + ", " + dec + "],6.6arcsec]");
  for (const char* ra : {"12h30m48s", "12:30:48.0", "187.7", "187.7d", "3.27598300r", "187d42m00s"})
    for (const char* dec : {"12d23m24s", "+12:23:24.0", "12.39", "12.39d"})
      for (const char* radius : {"6.6\"", "0.11'", "0.00183333333", "0.00183333333d", "3.3i", "3.3p", "3.19977e-5r"})
        check_same(here, std::string("fk5\ncircle(") + ra + "," + dec + " " + radius + ")");
  check_same(here, "circle 12:30:48 +12:23:24 6.6\"");  // celestial units mean the image's frame
  check_same(here, "wcs;circle(187.7,12.39,6.6\")");
}

BOOST_AUTO_TEST_CASE(sixty_seconds_of_a_place_are_its_next_minute) {
  const std::string next = "circle [[12h31m00s, 12d23m00s], 40arcsec]";
  imager::ImageHeader header = header_in();
  header.geometry.cell_rad *= 6;
  for (const char* place : {"12h30m60.00s, 12d22m60.00s", "12:30:60.0, 12.22.60.00", "187d44m60s, +12d22m60.0s"})
    check_same(next, std::string("circle [[") + place + "], 40arcsec]", header);
  for (const char* place : {"12:30:60.00, +12:22:60.00", "12h30m60.0s, 12d22m60.00s"})
    check_same(next, std::string("fk5; circle(") + place + ", 40\")", header);
}

BOOST_AUTO_TEST_CASE(what_ds9_draws_and_says_beside_regions_changes_nothing) {
  const std::string here = "circle [[30pix, 23pix], 3.3pix]", circle = "circle(31,24,3.3)";
  for (const char* drawn : {"line(1,2,3,4)", "-line(1,2,3,4)", "+text(3,4) # text={a}", "-vector(1,2,3,4)",
                            "point(3,4) # point=circle 10", "-x point 3 4"})
    check_same(here, std::string("image\n") + drawn + "\n" + circle);
  check_same(here, "image\n" + circle + " # color=red tag={a tag} This is a Comment");
  check_same(here, "image\n" + circle + " # a comment alone");
}

BOOST_AUTO_TEST_CASE(a_region_is_of_the_correlations_that_it_names) {
  const imager::ImageHeader header = header_in("FK5", "IQUV");
  const std::string regions =
      "#CRTFv0\nglobal corr=[I, Q]\nbox [[0pix, 0pix], [0pix, 0pix]]\nbox [[1pix, 0pix], [1pix, 0pix]], corr=[Q]\n"
      "box [[2pix, 0pix], [2pix, 0pix]] corr=[V,XX], color=red\n-box [[0pix, 0pix], [0pix, 0pix]], corr=Q\n";
  const RegionText read("regions", regions, header);
  BOOST_TEST(!read.one_for_all_stokes());
  BOOST_TEST(read.one_for_all_channels());
  const std::vector<std::vector<double>> allowed{{1, 0, 0}, {0, 1, 0}, {0, 0, 0}, {0, 0, 1}};
  for (int stokes = 0; stokes < 4; ++stokes) {
    const imager::Image mask = read.mask({0, stokes});
    for (int c = 0; c < 3; ++c)
      BOOST_TEST(mask.at(0, c) == allowed[static_cast<std::size_t>(stokes)][static_cast<std::size_t>(c)]);
    BOOST_TEST(count(mask) == (stokes == 2 ? 0 : 1));
  }
  BOOST_TEST(RegionText("regions", "box [[0pix, 0pix], [1pix, 0pix]], corr=[V, U, Q, I]", header).one_for_all_stokes());
  BOOST_TEST(RegionText("regions", "image;circle(3,3,3)", header).one_for_all_stokes());
}

BOOST_AUTO_TEST_CASE(a_file_without_a_region_of_the_image_is_refused) {
  const std::string box = "box [[0pix, 0pix], [1pix, 0pix]]";
  BOOST_TEST(refused(box + ", corr=[Q]",
                     "line 1: found 'corr=[Q]', expected planes of the image, corr of I and range within its 1 channel"));
  BOOST_TEST(refused(box + ", corr=[XX, YY]", "corr of IQ", header_in("FK5", "IQ")));
  BOOST_TEST(refused(box + ", range=[30chan, 40chan]",
                     "'range=[30chan, 40chan]', expected planes of the image, corr of I and range within its 5 channels",
                     header_in("FK5", "I", 5)));
  for (const char* nothing : {"", "\n", "#CRTF\n", "ann\ttext [[1pix, 2pix], 'x']", "# Region file format: DS9\nfk5\n"})
    BOOST_TEST(refused(nothing, "holds no region"));
}

BOOST_AUTO_TEST_CASE(regions_without_a_pixel_are_told_of) {
  const RegionText read(
      "regions",
      "circle [[30pix, 20pix], 7pix]\ncircle [[300pix, 20pix], 7pix]\n-centerbox [[3.5pix, 4.5pix], [.5pix, "
      ".5pix]]\ncircle [[3pix, 4pix], 2pix], corr=[Q]\nsymbol [[3pix, 4pix], .]\nann symbol [[3pix, 4pix], .]\n",
      header_in());
  BOOST_REQUIRE(read.doubts().size() == 4U);
  const auto told = [&](const std::string& sentence) {
    return std::find(read.doubts().begin(), read.doubts().end(), sentence) != read.doubts().end();
  };
  const std::string no_pixel = "the region holds the centre of no pixel of the image, 61 × 47 pixels: its own is at column ";
  BOOST_TEST(told("regions, line 2: " + no_pixel + "300, row 20"));
  BOOST_TEST(told("regions, line 3: " + no_pixel + "3.5, row 4.5"));
  BOOST_TEST(told("regions, line 4: the region of corr=[Q] is of no plane of the image"));
  BOOST_TEST(told("regions, line 5: a symbol holds no pixel and is passed over"));
  BOOST_TEST(RegionText("regions", "circle [[30pix, 20pix], 7pix]", header_in()).doubts().empty());
}

BOOST_AUTO_TEST_CASE(channels_beyond_the_image_s_last_are_told_of) {
  for (const int channels : {1, 5, 8})
    for (const int last : {0, 4, 5, 100}) {
      const std::string range = "range=[0chan, " + std::to_string(last) + "chan]";
      const RegionText read("regions", "circle [[30pix, 20pix], 7pix], " + range, header_in("FK5", "I", channels));
      std::vector<std::string> told;
      if (last >= channels)
        told = {"regions, line 1: the region of " + range + " names channels beyond the image's last, " +
                std::to_string(channels - 1) + "chan"};
      BOOST_TEST(read.doubts() == told, boost::test_tools::per_element());
    }
}

BOOST_AUTO_TEST_CASE(shapes_without_an_area_are_passed_over_with_a_word_that_names_their_lines) {
  const auto doubts = [](const std::string& text) { return RegionText("regions", text, header_in()).doubts(); };
  const std::string crtf = "circle [[30pix, 20pix], 7pix]\n", ds9 = "image\ncircle(31,21,7)\n";
  for (const char* shape : {"symbol", "line", "polyline", "vector", "text"}) {
    const std::string line = std::string(shape) + " [[3pix, 4pix], [5pix, 6pix]]\n", name = shape;
    const std::vector<std::string> one{"regions, line 2: a " + name + " holds no pixel and is passed over"};
    const std::vector<std::string> several{"regions, lines 2 to 4 and 6: a " + name + " holds no pixel and is passed over"};
    BOOST_TEST(doubts(crtf + line) == one, boost::test_tools::per_element());
    BOOST_TEST(doubts(crtf + line + line + line + crtf + line) == several, boost::test_tools::per_element());
    BOOST_TEST(refused(line, "holds no region with an area"));
    BOOST_TEST(doubts(crtf + "ann " + line).empty());
  }
  for (const char* shape : {"point", "line", "vector", "segment", "projection", "ruler", "compass", "text", "+textbox",
                            "circle point", "boxcircle point"}) {
    const std::string line = std::string(shape) + "(3,4,5,6) # color=red\n";
    const std::string name = line.find("point") != std::string::npos ? "point" : line.substr(0, line.find('('));
    const std::vector<std::string> one{"regions, line 3: a " + name.substr(name[0] == '+') +
                                       " holds no pixel and is passed over"};
    BOOST_TEST(doubts(ds9 + line) == one, boost::test_tools::per_element());
    BOOST_TEST(doubts("image; circle(31,21,7); " + line).size() == 1U);
    BOOST_TEST(refused("image\n" + line, "holds no region with an area"));
    BOOST_TEST(doubts(ds9 + "# " + line).empty());
  }
}

BOOST_AUTO_TEST_SUITE_END()
