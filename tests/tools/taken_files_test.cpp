// PSFs and residuals that a run takes from files, --calcpsf false and --calcres false.
#include <cmath>

#include "tests/tools/program.h"
#include "tools/formats/image_file.h"

BOOST_AUTO_TEST_SUITE(taken_files)

namespace {

using namespace misfit;
using namespace misfit::tools::testing;
namespace fs = std::filesystem;

const Arguments taken{"--calcpsf", "false", "--calcres", "false"};

/// Two sets apart in frequency, with w.
struct Sets {
  TemporaryFolder folder;
  Arguments paths{folder / "a.ms", folder / "b.ms"};

  Sets() {
    for (const std::size_t set : {0U, 1U})
      succeed({"simulate", "--output", paths[set], "--noncoplanar", "--frequency", set == 0 ? "300MHz" : "310MHz", "--channels",
               "2", "--channel-width", "1MHz", "--noise", "10mJy", "--cell", "0.5arcsec", "--quiet"});
  }
};

Arguments image(const std::string& name, const Arguments& options) {
  static const Sets sets;
  return Arguments{"image", "--vis"} + sets.paths + Arguments{"--imagename", name, "--imsize", "64", "--cell", "2arcsec"} +
         options;
}

imager::Image plane(const std::string& path, const imager::PlaneIndex& at = {}) {
  return tools::open_image_file(path)->read(at);
}

/// Images of a run under another name, as pipelines have them.
void copy(const std::string& from, const std::string& to, const Arguments& kinds) {
  for (const std::string& kind : kinds)
    for (const std::string end : {"", ".fits"})
      if (fs::exists(from + kind + end)) fs::copy(from + kind + end, to + kind + end, fs::copy_options::recursive);
}

/// To single precision, in which files have what was taken, and what minor cycles make of its roundings.
void check_same(const std::string& one, const std::string& other, const imager::PlaneIndex& at = {}) {
  const imager::Image a = plane(one, at), b = plane(other, at);
  double largest = 0, difference = 0;
  for (std::size_t i = 0; i < a.pixel.size(); ++i) {
    largest = std::max(largest, std::abs(a.pixel[i]));
    difference = std::max(difference, std::abs(a.pixel[i] - b.pixel[i]));
  }
  BOOST_TEST_INFO(one << " and " << other);
  BOOST_TEST(difference <= 1e-5 * largest);
}

void check_refused(const Arguments& arguments, const std::string& words) {
  const Outcome outcome = run(arguments + Arguments{"--quiet"});
  BOOST_TEST_INFO(outcome.err);
  BOOST_TEST(outcome.code == 1);
  BOOST_TEST(outcome.err.find(words) != std::string::npos);
}

}  // namespace

/// The images that are taken are those in whose place the run puts others, also where it reads them once more.
BOOST_AUTO_TEST_CASE(a_run_reads_what_it_wrote_and_not_what_it_took) {
  const TemporaryFolder folder;
  const Arguments cube{"--specmode", "cube", "--outframe", "TOPO", "--outformat", "casa", "--restoringbeam", "common"},
      first = cube + Arguments{"--niter", "60", "--nmajor", "2"};
  succeed(image(folder / "anew", first));
  succeed(image(folder / "taken", {"--specmode", "cube", "--outframe", "TOPO", "--outformat", "casa"}));
  succeed(image(folder / "taken", first + taken));
  for (const std::string kind : {".residual", ".model", ".image"})
    check_same(folder / "anew" + kind, folder / "taken" + kind, {1, 0});
  // A start model, too, lies where the run puts another.
  fs::copy(folder / "anew.model", folder / "start.model", fs::copy_options::recursive);
  succeed(image(folder / "anew", first + Arguments{"--startmodel", folder / "start.model"}));
  succeed(image(folder / "taken", first + taken + Arguments{"--startmodel", folder / "taken.model"}));
  for (const std::string kind : {".residual", ".model", ".image"})
    check_same(folder / "anew" + kind, folder / "taken" + kind, {1, 0});
}

BOOST_AUTO_TEST_CASE(every_term_is_compared) {
  const TemporaryFolder folder;
  const Arguments terms{"--nterms", "2"}, kinds{".psf.tt0", ".psf.tt1", ".psf.tt2", ".residual.tt0", ".residual.tt1"};
  succeed(image(folder / "a", terms));
  succeed(image(folder / "other", terms + Arguments{"--weighting", "uniform"}));
  for (const std::string& kind : kinds) {
    copy(folder / "a", folder / "b", kinds);
    fs::remove(folder / "b" + kind + ".fits");
    check_refused(image(folder / "b", terms + taken), "b" + kind + " does not exist");
    copy(folder / "other", folder / "b", {kind});
    check_refused(image(folder / "b", terms + taken), "b" + kind + ".fits is ");
    for (const std::string& each : kinds) fs::remove(folder / "b" + each + ".fits");
  }
  copy(folder / "a", folder / "b", kinds);
  succeed(image(folder / "b", terms + taken + Arguments{"--niter", "40", "--nmajor", "1"}));
  succeed(image(folder / "a", terms + Arguments{"--niter", "40", "--nmajor", "1"}));
  for (const std::string& kind : kinds) check_same(folder / "a" + kind + ".fits", folder / "b" + kind + ".fits");
}

/// What a model leaves is known with w too.
BOOST_AUTO_TEST_CASE(a_residual_of_another_model_is_refused) {
  for (const Arguments& options :
       {Arguments{"--gridder", "wide"}, Arguments{"--gridder", "standard"}, Arguments{"--nterms", "2"}}) {
    const TemporaryFolder folder;
    const bool terms = options.back() == "2";
    const Arguments ends = terms ? Arguments{".tt0", ".tt1"} : Arguments{""};
    Arguments kinds, start{"--startmodel"};
    for (const std::string& end : ends) {
      kinds.push_back(".residual" + end);
      kinds.push_back(".psf" + end);
      start.push_back(folder / "one.model" + end + ".fits");
    }
    if (terms) kinds.emplace_back(".psf.tt2");
    for (const auto& [name, niter] : {std::pair{"one", "20"}, {"two", "60"}}) {
      succeed(image(folder / name, options + Arguments{"--niter", niter}));
      copy(folder / name, folder / "of_" + name, kinds);
    }
    succeed(image(folder / "of_one", options + taken + start));
    check_same(folder / "one.image" + ends.front() + ".fits", folder / "of_one.image" + ends.front() + ".fits");
    check_refused(image(folder / "of_two", options + taken + start), "the start model");
  }
}

BOOST_AUTO_TEST_CASE(a_run_that_is_refused_leaves_the_state_of_the_one_before) {
  const TemporaryFolder folder;
  succeed(image(folder / "a", {"--niter", "20"}));
  check_refused(image(folder / "a", {"--niter", "20", "--weighting", "uniform", "--calcpsf", "false"}), "a.psf.fits is ");
  succeed(image(folder / "a", {"--niter", "40", "--restart"}));
}

/// A state belongs to a dirty image, which is not there any more.
BOOST_AUTO_TEST_CASE(no_state_is_kept_of_a_residual_that_was_taken) {
  const TemporaryFolder folder;
  succeed(image(folder / "a", {"--niter", "20"}));
  succeed(image(folder / "a", {}));
  succeed(image(folder / "a", taken + Arguments{"--niter", "20"}));
  BOOST_TEST(!fs::exists(folder / "a.clean.state"));
  const Outcome both = run(image(folder / "a", {"--niter", "20", "--restart", "--calcres", "false"}));
  BOOST_TEST(both.code == 2);
}

/// Where all samples of a plane lie beyond the grid, neither run has values.
BOOST_AUTO_TEST_CASE(planes_without_values_are_taken_as_such) {
  const TemporaryFolder folder;
  const Arguments cube{"--specmode", "cube", "--outframe", "TOPO", "--start", "300MHz", "--chanwidth", "1MHz", "--nchan", "12"};
  succeed(image(folder / "a", cube));
  BOOST_TEST_REQUIRE(std::isnan(plane(folder / "a.psf.fits", {5, 0}).pixel.front()));
  succeed(image(folder / "a", cube + taken + Arguments{"--niter", "5"}));
}

BOOST_AUTO_TEST_SUITE_END()
