#include <array>
#include <boost/test/unit_test.hpp>
#include <stdexcept>
#include <string>
#include <utility>

#include "tools/formats/regions/spectral_range.h"

BOOST_AUTO_TEST_SUITE(region_keywords)

using namespace misfit;
using namespace misfit::tools::regions;

namespace {

/// Ten planes of 1 MHz from 1.42 GHz on; the line lies in the middle of plane 4.
const imager::SpectralAxis axis{1.42e9, 1e6, 10, "LSRK", 1.424e9};

PlaneSpan span_of(const std::string& keywords, const imager::SpectralAxis& of = axis) {
  return planes_of_range(parse_region_keywords(keywords), of);
}

void check_span(const std::string& keywords, int first, int last, const imager::SpectralAxis& of = axis) {
  BOOST_TEST_CONTEXT(keywords) {
    const PlaneSpan span = span_of(keywords, of);
    BOOST_TEST(span.first == first);
    BOOST_TEST(span.last == last);
  }
}

bool refused(const std::string& keywords, const std::string& part, const imager::SpectralAxis& of = axis) {
  try {
    span_of(keywords, of);
  } catch (const std::exception& error) {
    BOOST_TEST_INFO(error.what());
    BOOST_TEST(std::string(error.what()).find(part) != std::string::npos);
    return true;
  }
  return false;
}

}  // namespace

BOOST_AUTO_TEST_CASE(apostrophes_within_words_and_brackets_that_close_nothing_hide_nothing) {
  for (const char* text : {", label=O'Neill, range=[3chan, 7chan]", ", label=a], range=[3chan, 7chan]"})
    BOOST_TEST(parse_region_keywords(text).at("range") == "[3chan, 7chan]");
}

BOOST_AUTO_TEST_CASE(commas_in_brackets_and_quotes_part_nothing) {
  for (const char* text : {", Coord = J2000, range=[1chan, 2chan],label='a, range=[3]', font=\"x,y\"",
                           " coord=J2000 range=[1chan, 2chan] label='a, range=[3]'  font='x,y',"}) {
    const RegionKeywords keywords = parse_region_keywords(text);
    BOOST_TEST(keywords.size() == 4U);
    BOOST_TEST(keywords.at("coord") == "J2000");
    BOOST_TEST(keywords.at("range") == "[1chan, 2chan]");
    BOOST_TEST(keywords.at("label") == "a, range=[3]");
    BOOST_TEST(keywords.at("font") == "x,y");
  }
}

BOOST_AUTO_TEST_CASE(what_viewers_draw_means_nothing) {
  for (const char* keyword : {"color=red", "color=#2EE6D6", "linewidth=2", "linestyle=:", "symsize=1", "symthick=1",
                              "font=Fixed [Sony]", "fontsize=10pt", "fontstyle=bold", "usetex=True", "label=''",
                              "labelcolor='green'", "labelpos=top", "labeloff=[1, -1]"}) {
    check_span(keyword, 0, 9);
    BOOST_TEST(stokes_of_corr(parse_region_keywords(keyword), {misfit::imager::Stokes::Q}).at(0));
    BOOST_TEST(frame_of_coord(parse_region_keywords(keyword), "ICRS") == "ICRS");
  }
}

BOOST_AUTO_TEST_CASE(without_a_range_all_planes_are_meant) {
  check_span("coord=J2000", 0, 9);
}

BOOST_AUTO_TEST_CASE(channels_count_from_0_and_both_ends_are_within) {
  for (const char* range : {"range=[3chan, 7chan]", "range=[3channel,7channel]", "range=[3 chan, 7.0chan]"})
    check_span(range, 3, 7);
  check_span("range=[0chan, 0chan]", 0, 0);
  check_span("range=[9chan, 1e12chan]", 9, 9);
}

BOOST_AUTO_TEST_CASE(frequencies_mean_the_planes_that_they_reach_into) {
  check_span("range=[1.4226GHz, 1.4243GHz]", 3, 4);
  check_span("range=[1424.3MHz, 1422600kHz]", 3, 4);
  check_span("range=[1.4233GHz, 1.4233GHz]", 3, 3);
  check_span("range=[1.4225GHz, 1.4245GHz]", 3, 4);  // from edge to edge
  imager::SpectralAxis falling = axis;
  falling.increment_hz = -1e6;
  check_span("range=[1.4174GHz, 1.4157GHz]", 3, 4, falling);
}

BOOST_AUTO_TEST_CASE(frequencies_and_velocities_may_stand_in_either_order) {
  for (const auto& [one, other] : {std::pair("1.4226GHz", "1424.3MHz"), {"-421km/s", "421km/s"}, {"1.42GHz", "1421000000Hz"}}) {
    const PlaneSpan span = span_of(std::string("range=[") + one + ", " + other + "]");
    check_span(std::string("range=[") + other + ", " + one + "]", span.first, span.last);
  }
}

BOOST_AUTO_TEST_CASE(velocities_are_those_of_the_line) {
  // 2 MHz of 1.424 GHz are 421.06 km/s.
  check_span("range=[-421km/s, 421km/s]", 2, 6);
  check_span("range=[100000m/s, 105km/s]", 4, 4);
  check_span("range=[-421km/s, 421km/s], restfreq=1.425GHz", 3, 7);
}

BOOST_AUTO_TEST_CASE(velocities_are_of_the_kind_that_is_named) {
  // A tenth of c: 0.9 and 1/1.1 of the line.
  const imager::SpectralAxis wide{1e9, 1e6, 200, "LSRK", 1.2e9};
  check_span("range=[29979.2458km/s, 29979.2458km/s]", 80, 80, wide);
  check_span("range=[29979.2458km/s, 29979.2458km/s], veltype=RADIO", 80, 80, wide);
  check_span("range=[29979.2458km/s, 29979.2458km/s], veltype=OPTICAL", 91, 91, wide);
  check_span("range=[29979.2458km/s, 29979.2458km/s], veltype=Z", 91, 91, wide);
  // The square root of 0.9/1.1 of the line.
  check_span("range=[29979.2458km/s, 29979.2458km/s], veltype=BETA", 85, 85, wide);
}

BOOST_AUTO_TEST_CASE(a_range_beside_the_planes_is_of_none) {
  const PlaneSpan span = span_of("range=[1.5GHz, 1.6GHz]");
  for (int plane = 0; plane < 10; ++plane) BOOST_TEST(!span.holds(plane));
}

BOOST_AUTO_TEST_CASE(one_plane_of_the_whole_band_must_be_reached) {
  const imager::SpectralAxis band{1.4e9, 0.1e9, 1, "LSRK", 0};
  check_span("range=[1.44GHz, 1.5GHz]", 0, 0, band);
  BOOST_TEST(
      refused("range=[1.46GHz, 1.5GHz]", "expected one that reaches into the image's only plane, 1.35 GHz to 1.45 GHz", band));
  BOOST_TEST(refused("range=[3chan, 7chan]", "'range=[3chan, 7chan]', expected one that reaches", band));
  const imager::SpectralAxis one_frequency{1.4e9, 0, 1, "LSRK", 0};
  check_span("range=[1.4GHz, 1.5GHz]", 0, 0, one_frequency);
  BOOST_TEST(refused("range=[1.41GHz, 1.5GHz]", "only plane", one_frequency));
}

BOOST_AUTO_TEST_CASE(two_ends_of_a_range_are_of_one_kind) {
  const std::array<std::string, 4> ends{"3chan", "1.423GHz", "20km/s", "4"};  // and a number without a unit is of none
  for (std::size_t i = 0; i < ends.size(); ++i)
    for (std::size_t k = 0; k < ends.size(); ++k) {
      const std::string range = "range=[" + ends[i] + ", " + ends[k] + "]";
      BOOST_TEST(
          refused(range, "'" + range + "', expected two channels, two frequencies or two velocities") == (i != k || i == 3),
          range);
    }
}

BOOST_AUTO_TEST_CASE(what_cannot_be_meant_is_refused) {
  for (const char* range : {"range=3chan", "range=[3chan]", "range=[1GHz, 2GHZ]", "range=[1deg, 2deg]", "range=[, ]",
                            "range=[1chan, 2chan, 3chan]", "range=[nanchan, 2chan]", "range=[3pix, 7pix]"})
    BOOST_TEST(refused(range, "expected two channels, two frequencies or two velocities"), range);
  BOOST_TEST(refused("range=[7chan, 3chan]", "'range=[7chan, 3chan]', expected the lower channel first"));
  for (const char* range : {"range=[-4chan, 0chan]", "range=[3.5chan, 7chan]"})
    BOOST_TEST(refused(range, "expected whole channels, counted from 0"), range);
  for (const char* range : {"range=[0Hz, 2GHz]", "range=[1.42GHz, -2GHz]"})
    BOOST_TEST(refused(range, "expected frequencies above 0"), range);
  for (const char* range : {"range=[3e5km/s, 1km/s]", "range=[1km/s, 3e5km/s], veltype=BETA",
                            "range=[1km/s, -3e5km/s], veltype=Z", "range=[-3e5km/s, 0km/s], veltype=optical"})
    BOOST_TEST(refused(range, "at which the line has a frequency above 0"), range);
  BOOST_TEST(refused("range=[1km/s, 2km/s], veltype=GAMMA", "expected RADIO, OPTICAL, Z or BETA"));
  for (const char* rest : {"7", "-1GHz", "0Hz", "1km/s"})
    BOOST_TEST(refused(std::string("restfreq=") + rest, "expected a frequency above 0"), rest);
  imager::SpectralAxis no_line = axis;
  no_line.rest_frequency_hz = 0;
  BOOST_TEST(refused("range=[1km/s, 2km/s]", "expected restfreq", no_line));
  check_span("range=[1chan, 2chan], frame=BARY, veltype=Z", 1, 2);  // channels have neither
}

BOOST_AUTO_TEST_CASE(a_frame_of_frequencies_is_the_image_s_or_refused_with_the_reason) {
  for (const char* range : {"range=[1.42GHz, 1.43GHz]", "range=[1km/s, 2km/s]"}) {
    const std::string text(range);
    BOOST_TEST(refused(text + ", frame=BARY", "'frame=BARY', expected the image's, LSRK"));
    BOOST_TEST(refused(text + ", frame=REST", "'frame=REST', expected the image's, LSRK: that at rest in the source takes"));
    BOOST_TEST(refused(text + ", frame=SUN", "spectral frame 'SUN'"));
    imager::SpectralAxis at_rest = axis, unknown = axis;
    at_rest.frame = "SOURCE";
    unknown.frame = "";
    const PlaneSpan span = span_of(text);
    for (const char* frame : {"REST", "rest"}) check_span(text + ", frame=" + frame, span.first, span.last, at_rest);
    check_span(text + ", frame=lsrk", span.first, span.last);
    BOOST_TEST(refused(text + ", frame=LSRK", "'frame=LSRK', expected none", unknown));
    check_span(text, span.first, span.last, unknown);
  }
}

BOOST_AUTO_TEST_SUITE_END()
