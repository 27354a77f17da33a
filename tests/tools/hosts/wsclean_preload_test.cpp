// The installed WSClean with an emitted kernel; skipped where it is not installed.
#include <boost/test/data/test_case.hpp>

#include "tests/tools/program.h"

BOOST_AUTO_TEST_SUITE(wsclean_preload)

namespace bdata = boost::unit_test::data;
namespace {

using namespace misfit;
using namespace misfit::tools::testing;
using nlohmann::json;

constexpr int pixels = 400;

bool installed() {
  static const bool found = [] {
    const bool answers = Child({"--version"}, "wsclean").wait().code == 0;
    if (!answers) BOOST_TEST_MESSAGE("skipped: WSClean is not installed");
    return answers;
  }();
  return found;
}

/// Noise without w, and its exact image.
struct Observation {
  TemporaryFolder folder;
  std::string vis = folder / "noise.ms";
  imager::Image exact;

  Observation() {
    std::ofstream(folder / "sky.csv") << "l_arcsec,m_arcsec,flux_jy\n0,0,1e-9\n";
    succeed({"simulate", "--output", vis, "--sky", folder / "sky.csv", "--coplanar", "--hours", "3", "--interval", "120",
             "--noise", "1Jy"});
    const std::string name = folder / "exact";
    succeed({"image", "--vis", vis, "--imagename", name, "--imsize", std::to_string(pixels), "--cell", "0.05arcsec",
             "--accuracy", "1e-8", "--niter", "0"});
    exact = pixels_of(name, "residual");
  }
};

/// WSClean on the data, with what `environment` sets.
Outcome run_wsclean(const Observation& data, const Arguments& environment, const Arguments& more) {
  const std::string size = std::to_string(pixels);
  return Child(environment +
                   Arguments{"wsclean",
                             "-size",
                             size,
                             size,
                             "-scale",
                             "0.05asec",
                             "-niter",
                             "0",
                             "-weight",
                             "natural",
                             "-no-small-inversion",
                             "-padding",
                             "1.2",
                             "-nwlayers",
                             "1",
                             "-no-dirty",
                             "-data-column",
                             "DATA",
                             "-name",
                             data.folder / "wsclean"} +
                   more + Arguments{data.vis},
               "env")
      .wait();
}

/// Its image relative to the exact one.
double error_of(const Observation& data, const Outcome& outcome) {
  BOOST_REQUIRE_MESSAGE(outcome.code == 0, outcome.err);
  const imager::Image image = imager::read_fits(data.folder / "wsclean-image.fits").image;
  double difference = 0, norm = 0;
  for (std::size_t i = 0; i < image.pixel.size(); ++i) {
    difference += std::pow(image.pixel[i] - data.exact.pixel[i], 2);
    norm += std::pow(data.exact.pixel[i], 2);
  }
  return std::sqrt(difference / norm);
}

json emitted(const std::string& file, int width, int sampling) {
  return json::parse(run({"kernel", "--width", std::to_string(width), "--emit", "wsclean", "--sampling",
                          std::to_string(sampling), "--imsize", std::to_string(pixels), "--output", file, "--json"})
                         .out);
}

Arguments preloaded(const std::string& file) {
  return {"LD_PRELOAD=" MISFIT_WSCLEAN, "MISFIT_WSCLEAN_KERNEL=" + file};
}

}  // namespace

BOOST_AUTO_TEST_CASE(wsclean_errs_by_what_is_said_without_the_kernel_and_with_it) {
  if (!installed()) return;
  const Observation data;
  const std::string file = data.folder / "k.h";
  // A fine table's error is a few times WSClean's rounding at padding 1.2. The noise of one observation: 10 %.
  for (const auto& [width, sampling] : {std::pair{6, 1023}, {7, 63}, {7, 1023}}) {
    const json said = emitted(file, width, sampling);
    const Outcome outcome = run_wsclean(data, preloaded(file), {"-oversampling", std::to_string(sampling)});
    const double measured = error_of(data, outcome);
    const double expected = said["error"]["rms"];
    BOOST_TEST_MESSAGE("said " << expected << ", measured " << measured);
    BOOST_TEST(std::abs(measured / expected - 1) < 0.1);
    BOOST_TEST((outcome.err.find("libmisfit_wsclean") == std::string::npos));
  }
  const double stock = emitted(file, 7, 1023)["error_of_host_without_this"]["rms"];
  BOOST_TEST(std::abs(error_of(data, run_wsclean(data, {}, {})) / stock - 1) < 0.1);
}

BOOST_AUTO_TEST_CASE(a_table_that_is_not_the_kernels_ends_the_run) {
  if (!installed()) return;
  const Observation data;
  const std::string file = data.folder / "k.h";
  emitted(file, 7, 1023);
  const auto other_table = [&](const Arguments& more) {
    std::filesystem::remove(data.folder / "wsclean-image.fits");
    const Outcome outcome = run_wsclean(data, preloaded(file), more);
    BOOST_TEST(outcome.code == 1);
    BOOST_TEST((outcome.err.find("WSClean's table is not the kernel's; expected version 3.1") != std::string::npos));
    BOOST_TEST(!std::filesystem::exists(data.folder / "wsclean-image.fits"));
  };
  for (const Arguments& more :
       {Arguments{"-oversampling", "63"}, {"-kernel-size", "9"}, {"-kernel-size", "5"}, {"-grid-mode", "rect"}})
    other_table(more);
  const Outcome unused = run_wsclean(data, preloaded(file), {"-use-wgridder"});
  BOOST_TEST(unused.code == 0);
  BOOST_TEST((unused.err.find("made no use of the kernel") != std::string::npos));
  const Outcome none = run_wsclean(data, preloaded(data.folder / "sky.csv"), {});
  BOOST_TEST(none.code == 1);
  BOOST_TEST((none.err.find("sky.csv is no file by misfit kernel --emit wsclean") != std::string::npos));
}

BOOST_AUTO_TEST_SUITE_END()
