// What is so of a run whether it makes one image or the channels of a cube.
#include "tests/tools/program.h"
#include "tests/tools/set_changes.h"

BOOST_AUTO_TEST_SUITE(runs_alike)

namespace {

using namespace misfit::tools::testing;

const Arguments one_image{"--specmode", "mfs"}, a_cube{"--specmode", "cube"};

/// An observation of one source, with noise.
struct Observed {
  TemporaryFolder folder;
  std::string set = folder / "a.ms";

  explicit Observed(const std::string& noise_jy = "0.1") {
    std::ofstream(folder / "sky.csv") << "ra_deg,dec_deg,flux_jy\n30,40,3\n";
    succeed({"simulate", "--output", set, "--sky", folder / "sky.csv", "--array", "vla-d", "--ra", "30deg", "--dec", "40deg",
             "--channels", "2", "--noise", noise_jy, "--quiet"});
  }
  Arguments image(const Arguments& how) const {
    return Arguments{"image", "--vis", set, "--imagename", folder / "a", "--imsize", "64", "--cell", "5arcsec", "--quiet"} +
           how;
  }
  /// Of the plan that the report has, the items that begin so.
  std::size_t decisions(const std::string& item) const {
    std::size_t found = 0;
    const auto report = report_of(folder / "a");
    for (const auto& decision : report["plan"]) found += decision["item"].get<std::string>().rfind(item, 0) == 0 ? 1 : 0;
    return found;
  }
};

}  // namespace

BOOST_AUTO_TEST_CASE(what_weighting_came_to_is_told) {
  for (const Arguments& how : {one_image, a_cube}) {
    const Observed observed;
    succeed(observed.image(how + Arguments{"--weighting", "briggs"}));
    BOOST_TEST(observed.decisions("weights") == 1U);
  }
}

/// Where every sample comes twice, the second time with nearly its negative, a second pass is made: its times are no measure.
BOOST_AUTO_TEST_CASE(times_of_images_made_twice_teach_nothing) {
  for (const Arguments& how : {one_image, a_cube})
    for (const bool cancelling : {false, true}) {
      const Observed observed;
      const std::string other = observed.folder / "b.ms", cache = observed.folder / "cache";
      std::filesystem::copy(observed.set, other, std::filesystem::copy_options::recursive);
      scale_data(other, cancelling ? -0.9999F : 1);
      const EnvironmentVariable own("MISFIT_CACHE", cache);
      succeed(observed.image(how + Arguments{"--vis", other}));
      BOOST_TEST(std::filesystem::exists(cache + "/times.json") == !cancelling);
    }
}

BOOST_AUTO_TEST_CASE(the_plan_says_what_minor_cycles_subtract) {
  for (const Arguments& how : {one_image, a_cube})
    for (const std::string deconvolver : {"hogbom", "clark", "multiscale"}) {
      const Observed observed;
      const Outcome plan = run(Arguments{"image", "--vis", observed.set, "--imagename", observed.folder / "a", "--imsize", "64",
                                         "--cell", "5arcsec", "--niter", "10", "--dry-run", "--deconvolver", deconvolver} +
                               (deconvolver == "multiscale" ? Arguments{"--scales", "0,5"} : Arguments{}) + how);
      BOOST_TEST((plan.out.find("PSF patch: none, the whole PSF") != std::string::npos), plan.out);
    }
}

BOOST_AUTO_TEST_SUITE_END()
