// Planes of a cube that are made at the same time, by the program itself, in threads and in ranks.
#include <algorithm>
#include <cmath>
#include <cstring>

#include "tests/tools/ranks_program.h"
#include "tools/formats/image_file.h"

BOOST_AUTO_TEST_SUITE(cube_threads)

namespace {

using namespace misfit;
using namespace misfit::tools::testing;

constexpr int channels = 7;

/// A source off the middle, with noise.
const std::string& set() {
  static const TemporaryFolder folder;
  static const std::string path = [] {
    const std::string list = folder / "sky.csv";
    std::ofstream(list) << "l_arcsec,m_arcsec,flux_jy,spectral_index,reference_frequency_hz\n1.2,-0.7,1,0,4e9\n";
    succeed({"simulate",
             "--output",
             folder / "cube.ms",
             "--sky",
             list,
             "--coplanar",
             "--array",
             "vla-a",
             "--hours",
             "0.5",
             "--interval",
             "600",
             "--frequency",
             "4GHz",
             "--channels",
             std::to_string(channels),
             "--channel-width",
             "1MHz",
             "--noise",
             "2Jy"});
    return folder / "cube.ms";
  }();
  return path;
}

Arguments cube(const std::string& imagename, const std::string& threads, const std::string& pixels = "64") {
  return {"image",     "--vis",      set(),  "--imagename", imagename, "--imsize",  pixels, "--cell",
          "0.1arcsec", "--specmode", "cube", "--outframe",  "TOPO",    "--threads", threads};
}

const std::string kinds[] = {"psf", "residual", "model", "image", "mask"};

/// What a report tells of the sky.
const char* const told[] = {"planes", "warnings", "visibilities", "error",         "noise",
                            "clean",  "beam",     "kernel",       "plane_samples", "samples_outside_planes"};

bool has_values(const imager::Image& image) {
  return std::any_of(image.pixel.begin(), image.pixel.end(), [](double x) { return !std::isnan(x); });
}

/// Bit by bit, NaN too.
bool same(const imager::Image& a, const imager::Image& b) {
  return a.pixel.size() == b.pixel.size() && std::memcmp(a.pixel.data(), b.pixel.data(), a.pixel.size() * sizeof(double)) == 0;
}

void check_same(const imager::ImageReader& one, const imager::ImageReader& other) {
  for (int plane = 0; plane < one.header().spectral.channels; ++plane) {
    for (int stokes = 0; stokes < static_cast<int>(one.header().stokes.size()); ++stokes)
      BOOST_TEST(same(one.read({plane, stokes}), other.read({plane, stokes})), "plane " << plane << ", " << stokes);
    const auto beam = one.beam({plane, 0}), other_beam = other.beam({plane, 0});
    BOOST_TEST(beam.has_value() == other_beam.has_value());
    if (beam && other_beam) BOOST_TEST(beam->major_rad == other_beam->major_rad);
  }
}

std::string decision_on(const nlohmann::json& report, const std::string& item) {
  for (const nlohmann::json& decision : report["plan"])
    if (decision["item"] == item) return decision["decision"];
  return "";
}

}  // namespace

BOOST_AUTO_TEST_CASE(pixels_beams_and_report_do_not_depend_on_the_number_of_threads) {
  for (const std::string restoringbeam : {"", "common"}) {
    const TemporaryFolder folder;
    Arguments options{"--start",     "3.997GHz", "--nchan",  "10", "--niter",     "40",  // the first planes are empty
                      "--usemask",   "auto",     "--nsigma", "3",  "--outformat", "both",
                      "--weighting", "briggs",   "--verify", "8"};
    if (!restoringbeam.empty()) options = options + Arguments{"--restoringbeam", restoringbeam};
    succeed(cube(folder / "one", "1") + options);
    succeed(cube(folder / "three", "3") + options);
    for (const std::string& kind : kinds)
      for (const std::string suffix : {".fits", ""}) {
        BOOST_TEST_CONTEXT(kind << suffix) {
          check_same(*tools::open_image_file(folder / ("one." + kind + suffix)),
                     *tools::open_image_file(folder / ("three." + kind + suffix)));
        }
      }
    const nlohmann::json one = report_of(folder / "one"), three = report_of(folder / "three");
    BOOST_TEST(decision_on(one, "planes").find("imaged at a time") == std::string::npos);
    BOOST_TEST(decision_on(three, "planes").find("and 3 imaged at a time") != std::string::npos);
    BOOST_TEST_REQUIRE(one["planes"].size() == 10U);
    for (const char* key : told) BOOST_TEST(one[key] == three[key], key);
  }
}

BOOST_AUTO_TEST_CASE(pixels_beams_and_report_do_not_depend_on_the_number_of_ranks) {
  if (!has_mpi()) return;
  for (const Arguments& common : {Arguments{}, {"--restoringbeam", "common", "--perchanweightdensity", "false"}}) {
    const TemporaryFolder folder;
    const Arguments options =
        Arguments{"--start",     "3.997GHz", "--nchan",  "10", "--niter",   "40",  // the first planes are empty
                  "--usemask",   "auto",     "--nsigma", "3",  "--pblimit", "0.1",
                  "--weighting", "briggs",   "--verify", "8",  "--stokes",  "IQ"} +
        common;
    succeed(cube(folder / "one", "1") + options);
    const nlohmann::json one = report_of(folder / "one");
    for (const int size : {2, 8}) {
      const std::string name = folder / std::to_string(size);
      succeed_together(size, cube(name, "1") + options);
      BOOST_TEST_CONTEXT(size << " ranks") {
        for (const std::string kind : {"psf", "residual", "model", "image", "mask", "pb"})
          check_same(*tools::open_image_file(folder / ("one." + kind + ".fits")),
                     *tools::open_image_file(name + "." + kind + ".fits"));
        const nlohmann::json report = report_of(name);
        for (const char* key : told) BOOST_TEST(one[key] == report[key], key);
        BOOST_TEST(decision_on(report, "shared among ranks") ==
                   std::to_string(size) + ", which take " + (size == 2 ? "2 planes" : "a plane") + " at a time");
        BOOST_TEST(decision_on(report, "exchanged among ranks") != "");
      }
    }
  }
}

/// Which for themselves would hold unlike numbers of planes.
BOOST_AUTO_TEST_CASE(ranks_of_unlike_threads_go_together) {
  if (!has_mpi()) return;
  const TemporaryFolder folder;
  const auto options = [&](const std::string& name, const std::string& threads) {
    return cube(folder / name, threads) + Arguments{"--weighting", "briggs", "--perchanweightdensity", "false", "--quiet"};
  };
  succeed(options("one", "1"));
  for (const auto& [first, second] : {std::pair{"4", "1"}, {"1", "4"}}) {
    const Arguments two = ranks(1) + options("two", first) + Arguments{":"} + ranks(1, false) + options("two", second);
    const Outcome outcome = Child(two, "mpirun").wait();
    BOOST_TEST_INFO(outcome.err);
    BOOST_REQUIRE_EQUAL(outcome.code, 0);
    check_same(*tools::open_image_file(folder / "one.residual.fits"), *tools::open_image_file(folder / "two.residual.fits"));
  }
}

BOOST_AUTO_TEST_CASE(a_plane_of_another_rank_that_fails_ends_all_and_leaves_no_images) {
  if (!has_mpi()) return;
  const TemporaryFolder folder;
  std::ofstream(folder / "a.clean") << "no folder";  // for CLEAN's states
  const Outcome outcome = Child(ranks(3) + cube(folder / "a", "1") + Arguments{"--niter", "10", "--quiet"}, "mpirun").wait();
  BOOST_TEST_INFO(outcome.err);
  BOOST_TEST(outcome.code == 1);
  BOOST_TEST(outcome.err.find("a.clean") != std::string::npos);
  for (const auto& file : std::filesystem::directory_iterator(folder / ""))
    BOOST_TEST(file.path().string().find(".fits") == std::string::npos, file.path().string());
}

BOOST_AUTO_TEST_CASE(a_plane_that_fails_ends_the_run_with_one_line_and_leaves_no_images) {
  const TemporaryFolder folder;
  std::ofstream(folder / "a.clean") << "no folder";  // for CLEAN's states
  const Outcome outcome = run(cube(folder / "a", "3") + Arguments{"--niter", "10", "--quiet"});
  BOOST_TEST_INFO(outcome.err);
  BOOST_TEST(outcome.code == 1);
  BOOST_TEST(outcome.err.find("a.clean") != std::string::npos);
  BOOST_TEST(std::count(outcome.err.begin(), outcome.err.end(), '\n') == 1);
  for (const auto& file : std::filesystem::directory_iterator(folder / ""))
    BOOST_TEST(file.path().string().find(".fits") == std::string::npos, file.path().string());
}

BOOST_AUTO_TEST_CASE(an_interrupt_leaves_the_planes_that_are_done) {
  const TemporaryFolder folder;
  Child child(cube(folder / "a", "2", "256") + Arguments{"--niter", "3000", "--gain", "0.02"});
  child.wait_for("plane 0");
  child.signal(SIGINT);
  const Outcome outcome = child.wait();
  BOOST_TEST_INFO(outcome.err);
  BOOST_TEST_REQUIRE((outcome.code == 130 || outcome.code == 0));  // it may be over by then
  const nlohmann::json planes = report_of(folder / "a")["planes"];
  std::vector<bool> done(channels);
  for (const nlohmann::json& plane : planes) done[plane["plane"].get<std::size_t>()] = true;
  const auto image = tools::open_image_file(folder / "a.image.fits");
  for (int plane = 0; plane < channels; ++plane)
    BOOST_TEST(has_values(image->read({plane, 0})) == done[static_cast<std::size_t>(plane)], "plane " << plane);
  BOOST_TEST(done[0]);
}

BOOST_AUTO_TEST_SUITE_END()
