#include "tools/run/cube_options.h"

#include <boost/test/unit_test.hpp>
#include <cmath>

#include "imager/numerics/constants.h"

BOOST_AUTO_TEST_SUITE(cube_options)

using namespace misfit;
using namespace misfit::tools;

namespace {

ms_io::SpectralWindow window(double first_hz, double step_hz, std::size_t channels) {
  ms_io::SpectralWindow w;
  for (std::size_t c = 0; c < channels; ++c) {
    w.frequency_hz.push_back(first_hz + step_hz * static_cast<double>(c));
    w.channel_width_hz.push_back(std::abs(step_hz));
  }
  return w;
}

CubeOptions cube(const std::string& start = "", const std::string& width = "", int nchan = -1) {
  CubeOptions o;
  o.specmode = "cube";
  o.start = start;
  o.chanwidth = width;
  o.nchan = nchan;
  o.restfreq = "1.4GHz";
  return o;
}

imager::SpectralAxis axis_of(const CubeOptions& o, double step_hz = 1e6) {
  check(o);
  return cube_sampling(o, {window(step_hz > 0 ? 1.4e9 : 1.409e9, step_hz, 10)}, "TOPOCENT").axis;
}

struct Expected {
  double first_hz, step_hz;
  int channels;
};

void compare(const imager::SpectralAxis& axis, const Expected& expected) {
  BOOST_TEST(std::abs(axis.reference_hz - expected.first_hz) < 1e-3);
  BOOST_TEST(std::abs(axis.increment_hz - expected.step_hz) < 1e-3);
  BOOST_TEST(axis.channels == expected.channels);
}

/// The message with which options are refused.
std::string refusal(const CubeOptions& o) {
  try {
    axis_of(o);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

}  // namespace

BOOST_AUTO_TEST_CASE(planes_are_channels_unless_told_otherwise) {
  compare(axis_of(cube()), {1.4e9, 1e6, 10});
  compare(axis_of(cube(), -1e6), {1.409e9, -1e6, 10});
  compare(axis_of(cube("3")), {1.403e9, 1e6, 7});
  compare(axis_of(cube("3", "", 2)), {1.403e9, 1e6, 2});
}

BOOST_AUTO_TEST_CASE(planes_of_several_channels_begin_where_their_first_channel_does) {
  compare(axis_of(cube("", "2")), {1.4005e9, 2e6, 5});
  compare(axis_of(cube("2", "4")), {1.4035e9, 4e6, 2});
  compare(axis_of(cube("", "-1")), {1.409e9, -1e6, 10});
  compare(axis_of(cube("", "-2")), {1.4085e9, -2e6, 5});
  compare(axis_of(cube("", "2"), -1e6), {1.4085e9, -2e6, 5});
}

BOOST_AUTO_TEST_CASE(frequencies_go_up_and_velocities_too) {
  compare(axis_of(cube("1.402GHz")), {1.402e9, 1e6, 8});
  compare(axis_of(cube("1.402GHz"), -1e6), {1.402e9, 1e6, 8});
  compare(axis_of(cube("1.402GHz", "500kHz", 3)), {1.402e9, 0.5e6, 3});
  compare(axis_of(cube("1.402GHz", "-500kHz", 3)), {1.402e9, -0.5e6, 3});
  const double c = imager::speed_of_light_m_s;
  compare(axis_of(cube("-1000km/s", "100km/s", 4)), {1.4e9 * (1 + 1e6 / c), -1.4e9 * 1e5 / c, 4});
  compare(axis_of(cube("-1000km/s", "-100km/s", 4)), {1.4e9 * (1 + 1e6 / c), 1.4e9 * 1e5 / c, 4});
  compare(axis_of(cube("-1000km/s", "", 4)), {1.4e9 * (1 + 1e6 / c), -1e6, 4});
}

BOOST_AUTO_TEST_CASE(optical_velocities_are_evenly_spaced) {
  const double c = imager::speed_of_light_m_s;
  for (const double step_m_s : {1e5, -1e5})
    for (const std::string start : {"-1000km/s", "4"}) {
      CubeOptions o = cube(start, step_m_s > 0 ? "100km/s" : "-100km/s", 12);
      o.veltype = "Optical";
      const imager::SpectralAxis axis = axis_of(o);
      BOOST_TEST(axis.in_wavelength);
      const double first_m_s = c * (1.4e9 / axis.reference_hz - 1);
      if (start == "4") {  // the first plane begins where its channel does, whose own width is 214 km/s
        BOOST_TEST(std::abs(axis.reference_hz - 1.404e9) < 0.5e6);
      } else {
        BOOST_TEST(std::abs(first_m_s + 1e6) < 1e-3);
      }
      for (int plane = 0; plane < axis.channels; ++plane)
        BOOST_TEST(std::abs(c * (1.4e9 / axis.frequency_hz(plane) - 1) - first_m_s - plane * step_m_s) < 1e-3);
    }
  CubeOptions by_channel = cube("-1000km/s", "", 4);
  by_channel.veltype = "optical";
  compare(axis_of(by_channel), {1.4e9 / (1 - 1e6 / c), -1e6, 4});
  CubeOptions by_frequency = cube("-1000km/s", "1MHz", 4);
  by_frequency.veltype = "optical";
  BOOST_TEST(!axis_of(by_frequency).in_wavelength);
  CubeOptions to_the_end = cube("-1000km/s", "100km/s");
  to_the_end.veltype = "optical";
  // From −1050 km/s, where the first plane begins, to 107 km/s at the edge of the data, 1.3995 GHz, are 11.57 planes.
  BOOST_TEST(axis_of(to_the_end).channels == 12);
}

BOOST_AUTO_TEST_CASE(planes_have_the_frame_that_their_mode_says) {
  const auto frame_of = [](const std::string& specmode, const std::string& outframe, const std::string& data) {
    CubeOptions o = cube();
    o.specmode = specmode;
    if (!outframe.empty()) o.outframe = outframe;
    check(o);
    return cube_sampling(o, {window(1.4e9, 1e6, 10)}, data).axis.frame;
  };
  BOOST_TEST(frame_of("cube", "", "TOPOCENT") == "LSRK");
  BOOST_TEST(frame_of("cube", "bary", "TOPOCENT") == "BARYCENT");
  BOOST_TEST(frame_of("cube", "rest", "SOURCE") == "SOURCE");
  BOOST_TEST(frame_of("cubedata", "", "TOPOCENT") == "");
  BOOST_TEST(frame_of("cubesource", "", "TOPOCENT") == "SOURCE");
  BOOST_TEST(frame_of("cubesource", "REST", "SOURCE") == "SOURCE");
  for (const std::string data : {"TOPOCENT", ""}) {
    try {
      frame_of("cube", "REST", data);
      BOOST_TEST(false);
    } catch (const std::invalid_argument& error) {
      BOOST_TEST(std::string(error.what()).find("--outframe REST: expected data at rest in the source") != std::string::npos,
                 error.what());
    }
  }
  CubeOptions o = cube();
  o.specmode = "cubedata";
  o.outframe = "BARY";
  BOOST_TEST(refusal(o).find("none with --specmode cubedata") != std::string::npos);
  o.specmode = "cubesource";
  BOOST_TEST(refusal(o).find("REST or none with --specmode cubesource") != std::string::npos);
  CubeOptions no_velocity = cube("3");
  no_velocity.veltype = "optical";
  BOOST_TEST(refusal(no_velocity).find("--veltype optical: expected a velocity") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(all_windows_count_for_the_end) {
  const auto axis = cube_sampling(cube(), {window(1.4e9, 1e6, 10), window(1.42e9, 1e6, 10)}, "TOPOCENT").axis;
  BOOST_TEST(axis.channels == 30);
}

BOOST_AUTO_TEST_CASE(what_cannot_be_is_refused_in_one_line) {
  for (const auto& [options, named] : {std::pair{cube("10"), "--start 10: expected 0 to 9"},
                                       {cube("-1"), "--start -1"},
                                       {cube("1.5GHz", "", 4), "hold no data; expected planes within 1.3995 GHz to 1.4095 GHz"},
                                       {cube("1.4GHz", "-500MHz", 9), "not positive"},
                                       {cube("", "0.01Hz"), "wider planes, or --nchan: it takes 1e+09 to the end"},
                                       {cube("somewhere"), "--start somewhere: expected a number of channels, a frequency"},
                                       {cube("5km"), "--start 5km"},
                                       {cube("", "0"), "--chanwidth 0"},
                                       {cube("", "0MHz"), "--chanwidth 0MHz"},
                                       {cube("", "", 0), "--nchan 0"}}) {
    BOOST_TEST_INFO(refusal(options));
    BOOST_TEST(refusal(options).find(named) != std::string::npos);
  }
  CubeOptions no_line = cube("5km/s");
  no_line.restfreq = "";
  BOOST_TEST(refusal(no_line).find("--restfreq beside a velocity") != std::string::npos);
  CubeOptions other_frame = cube();
  other_frame.outframe = "HELIO";
  BOOST_TEST(refusal(other_frame).find("--outframe HELIO: expected LSRK") != std::string::npos);
  CubeOptions no_cube = cube("3");
  no_cube.specmode = "mfs";
  BOOST_TEST(refusal(no_cube).find("--specmode cube beside it") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(channels_without_width_are_refused) {
  ms_io::SpectralWindow flat = window(1.4e9, 1e6, 3);
  flat.channel_width_hz[1] = 0;
  BOOST_CHECK_THROW(cube_sampling(cube(), {flat}, "TOPOCENT"), std::runtime_error);
}

BOOST_AUTO_TEST_SUITE_END()
