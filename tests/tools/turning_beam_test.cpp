#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <fstream>

#include "tests/tools/beam_files.h"
#include "tests/tools/program.h"

BOOST_AUTO_TEST_SUITE(turning_beam)

namespace bdata = boost::unit_test::data;
using namespace misfit;
using namespace misfit::tools::testing;
using misfit::testing::TemporaryFolder;

namespace {

/// 40′ by 56′ between half-power points at 1.4 GHz.
void write_elliptical_beam(const std::string& path) {
  write_beam_file(path, {}, [](double east, double north, double) {
    const double x = east * 60 / 40, y = north * 60 / 56;
    return std::exp(-4 * std::log(2.0) * (x * x + y * y));
  });
}

}  // namespace

/// A source about the half-power points, seen for eight hours in which the zenith turns by more than 100°: to the east, between
/// the axes, and to the north.
BOOST_DATA_TEST_CASE(a_source_has_its_flux_where_an_elliptical_beam_turns, bdata::make({84, 60, 0}) ^ bdata::make({0, 60, 88}),
                     east, north) {
  constexpr int cell = 15, middle = 128;
  const TemporaryFolder folder;
  const std::string beam = folder / "beam.fits";
  write_elliptical_beam(beam);
  std::ofstream(folder / "sky.csv") << "l_arcsec,m_arcsec,flux_jy\n" << east * cell << "," << north * cell << ",2.5\n";
  succeed(
      {"simulate", "--output", folder / "a.ms", "--sky",   folder / "sky.csv", "--array", "vla-d",           "--primary-beam",
       "--beam",   beam,       "--frequency",   "1.39GHz", "--channels",       "4",       "--channel-width", "5MHz",
       "--hours",  "8",        "--interval",    "600"});
  const Arguments image{"image",    "--vis",   folder / "a.ms", "--imagename", folder / "a", "--imsize", "256", "--cell",
                        "15arcsec", "--niter", "2000",          "--threshold", "1mJy",       "--beam",   beam};
  succeed(image + Arguments{"--pbcor"});
  const auto at_source = [&](const char* kind) { return pixels_of(folder / "a", kind).at(middle + north, middle - east); };
  BOOST_TEST(std::abs(at_source("image.pbcor") / 2.5 - 1) < 0.005);
  BOOST_TEST(at_source("pb") > 0.4);
  BOOST_TEST(at_source("pb") < 0.7);
  // Of two terms, whose beam is made with their weights.
  succeed(image + Arguments{"--pbcor", "--nterms", "2"});
  BOOST_TEST(std::abs(at_source("image.tt0.pbcor") / 2.5 - 1) < 0.005);
  const Outcome plan = run(image + Arguments{"--dry-run"});
  BOOST_TEST(plan.out.find("primary beam: ") != std::string::npos);
  BOOST_TEST(plan.out.find("--beam " + beam) != std::string::npos);
}

BOOST_AUTO_TEST_CASE(beams_that_are_none_are_refused) {
  const TemporaryFolder folder;
  const Outcome none =
      run({"image", "--vis", "a.ms", "--imagename", folder / "a", "--imsize", "64", "--cell", "1arcsec", "--beam", "gmtr"});
  BOOST_TEST(none.code == 2);
  BOOST_TEST(none.err.find("--beam 'gmtr': expected VLA, EVLA") != std::string::npos, none.err);
  std::ofstream(folder / "no.fits") << "text";
  succeed({"simulate", "--output", folder / "a.ms", "--hours", "0"});
  const Outcome text = run({"image", "--vis", folder / "a.ms", "--imagename", folder / "a", "--imsize", "64", "--cell",
                            "0.1arcsec", "--beam", folder / "no.fits"});
  BOOST_TEST(text.code == 1);
  BOOST_TEST(text.err.find("no.fits") != std::string::npos, text.err);
  const Outcome alone = run({"simulate", "--output", folder / "b.ms", "--beam", "vla"});
  BOOST_TEST(alone.err.find("--beam vla without --primary-beam") != std::string::npos, alone.err);
}

BOOST_AUTO_TEST_SUITE_END()
