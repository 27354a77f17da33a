// Runs of several processes that MPI started, by the program itself.
#include <cstring>

#include "imager/data/ranks.h"
#include "tests/imager/comparison.h"
#include "tests/tools/ranks_program.h"
#include "tests/tools/set_changes.h"

BOOST_AUTO_TEST_SUITE(ranks_command)

namespace {

using namespace misfit;
using namespace misfit::tools::testing;

Arguments image(const std::string& imagename) {
  return {"image", "--vis", track(), "--imagename", imagename, "--imsize", "128", "--cell", "0.1arcsec", "--threads", "1"};
}

/// Enough for an image of 128 × 128 pixels, and not for the visibilities of a rank.
const std::string tight_gib = "0.1";

double difference(const std::string& is, const std::string& should, const std::string& kind) {
  return imager::testing::relative_error(pixels_of(is, kind).pixel, pixels_of(should, kind).pixel);
}

/// Decisions about ranks that a report holds.
std::size_t told_of_ranks(const nlohmann::json& report) {
  std::size_t told = 0;
  for (const auto& decision : report["plan"])
    told += decision["item"] == "shared among ranks" || decision["item"] == "exchanged among ranks" ? 1 : 0;
  return told;
}

}  // namespace

BOOST_AUTO_TEST_CASE(images_and_clean_are_those_of_one_process) {
  if (!has_mpi()) return;
  const TemporaryFolder folder;
  const Arguments options{"--accuracy",  "1e-8",   "--psf-accuracy", "1e-8", "--niter",        "200", "--verify", "50",
                          "--weighting", "briggs", "--pblimit",      "0.1",  "--check-outside"};
  succeed(image(folder / "one") + options);
  const nlohmann::json one = report_of(folder / "one");
  BOOST_TEST(told_of_ranks(one) == 0U);
  for (const int size : {1, 2, 3, 4, 8}) {
    const std::string name = folder / std::to_string(size);
    succeed_together(size, image(name) + options);
    BOOST_TEST_CONTEXT(size << " ranks") {
      for (const char* kind : {"psf", "residual", "model", "image"}) BOOST_TEST(difference(name, folder / "one", kind) < 1e-7);
      const nlohmann::json report = report_of(name);
      BOOST_TEST(report["visibilities"] == one["visibilities"]);
      BOOST_TEST(report["clean"]["stop_code"] == one["clean"]["stop_code"]);
      BOOST_TEST(report["clean"]["iterations"] == one["clean"]["iterations"]);
      BOOST_TEST(report["error"]["measured_rms"].get<double>() < 1e-8);
      BOOST_TEST(report["outside_search"]["found"] == one["outside_search"]["found"]);
      BOOST_TEST(told_of_ranks(report) == (size == 1 ? 0U : 2U));
    }
  }
}

/// Large images pass from rank to rank in pieces.
BOOST_AUTO_TEST_CASE(images_of_several_pieces_are_those_of_one_process) {
  if (!has_mpi()) return;
  const TemporaryFolder folder;
  Arguments large = image(folder / "one") + Arguments{"--accuracy", "1e-8", "--psf-accuracy", "1e-8"};
  large[6] = "1100";
  BOOST_TEST_REQUIRE(imager::pass_along_ranks(8, 1100 * 1100));
  succeed(large);
  for (const int size : {3, 8}) {
    large[4] = folder / std::to_string(size);
    succeed_together(size, large);
    for (const char* kind : {"psf", "residual"}) BOOST_TEST(difference(large[4], folder / "one", kind) < 1e-7);
  }
}

BOOST_AUTO_TEST_CASE(clean_goes_on_from_where_it_was) {
  if (!has_mpi()) return;
  const TemporaryFolder folder;
  succeed_together(2, image(folder / "a") + Arguments{"--niter", "100", "--psf-accuracy", "1e-6"});
  succeed_together(2, image(folder / "a") + Arguments{"--niter", "200", "--psf-accuracy", "1e-6", "--restart"});
  BOOST_TEST(report_of(folder / "a")["clean"]["iterations"] == 200);
}

BOOST_AUTO_TEST_CASE(predicted_and_saved_models_are_those_of_one_process) {
  if (!has_mpi()) return;
  const TemporaryFolder folder;
  const auto copy_of_track = [&](const std::string& name) {
    std::filesystem::copy(track(), folder / name, std::filesystem::copy_options::recursive);
    return folder / name;
  };
  const std::string one = copy_of_track("one.ms"), three = copy_of_track("three.ms");
  succeed(image(folder / "model") + Arguments{"--niter", "50"});
  const Arguments model{"--model", folder / "model.model.fits"};
  succeed(Arguments{"predict", "--vis", one} + model);
  succeed_together(3, Arguments{"predict", "--vis", three} + model);
  BOOST_TEST((visibilities(three, "MODEL_DATA") == visibilities(one, "MODEL_DATA")));
  for (const auto& [set, size] : {std::pair(one, 1), {three, 3}}) {
    Arguments saving =
        image(folder / "saving") + Arguments{"--niter", "50", "--psf-accuracy", "1e-6", "--savemodel", "modelcolumn"};
    saving[2] = set;
    succeed_together(size, saving);
  }
  // Components are those of images that differ by the order of sums.
  BOOST_TEST(imager::testing::relative_error(visibilities(three, "MODEL_DATA"), visibilities(one, "MODEL_DATA")) < 1e-5);
}

BOOST_AUTO_TEST_CASE(what_is_wrong_for_all_ends_all_with_its_message) {
  if (!has_mpi()) return;
  const TemporaryFolder folder;
  Arguments nowhere = image(folder / "a");
  nowhere[2] = folder / "nowhere.ms";
  const Arguments kernel{"kernel", "--width", "7", "--output", folder / "k.fits"};
  struct Case {
    Arguments arguments;
    int code;
    std::string said;
  };
  for (const Case& wrong : {Case{nowhere, 1, "nowhere.ms does not exist; expected a MeasurementSet"},
                            {image(folder / "a") + Arguments{"--robbust", "1"}, 2, "--robbust"},
                            {kernel, 2, "misfit kernel was started as 2 processes"}}) {
    const Outcome outcome = Child(ranks(2) + wrong.arguments, "mpirun").wait();
    BOOST_TEST(outcome.code == wrong.code);
    BOOST_TEST(outcome.err.find(wrong.said) != std::string::npos, outcome.err);
  }
  BOOST_TEST(files_below(folder / "").empty());
}

BOOST_AUTO_TEST_CASE(ranks_of_unlike_options_are_refused) {
  if (!has_mpi()) return;
  const TemporaryFolder folder;
  const Arguments cube{"--specmode", "cube", "--outframe", "TOPO", "--niter", "5", "--gain"};
  const Arguments one = image(folder / "a") + cube;
  const Outcome outcome =
      Child(ranks(1) + one + Arguments{"0.1", ":"} + ranks(1, false) + one + Arguments{"0.2"}, "mpirun").wait();
  BOOST_TEST(outcome.code == 2);
  BOOST_TEST(outcome.err.find("--gain \"0.2\" of rank 1: expected \"0.1\", which rank 0 has") != std::string::npos,
             outcome.err);
  BOOST_TEST(files_below(folder / "").empty());
}

/// A rank that dies takes the others with it, whatever they wait for.
BOOST_AUTO_TEST_CASE(a_killed_rank_ends_the_run_without_an_image) {
  if (!has_mpi()) return;
  for (const Arguments& kind : {Arguments{}, {"--specmode", "cube", "--outframe", "TOPO"}})
    for (const std::size_t victim : {0U, 1U}) {
      const TemporaryFolder folder;
      Arguments long_run = image(folder / "a") + kind + Arguments{"--niter", "1000000", "--gain", "0.001", "--cycleniter", "5"};
      Child child(ranks(2) + long_run, "mpirun");
      child.wait_until([&] {
        const auto files = files_below(folder / "");
        return std::any_of(files.begin(), files.end(),
                           [](const auto& file) { return file.first.find(".state") != std::string::npos; });
      });
      const std::vector<pid_t> started = child.children();
      BOOST_TEST_REQUIRE(started.size() == 2U);
      kill(started[victim], SIGKILL);
      BOOST_TEST(child.wait().code != 0);
      for (const auto& [file, content] : files_below(folder / ""))
        BOOST_TEST(std::filesystem::path(file).extension() != ".fits", file);
    }
}

/// Of ranks with unlike memory none keeps visibilities where one cannot, and all gather as many for a w axis as one can, so
/// that all exchange the same in every pass.
BOOST_AUTO_TEST_CASE(ranks_of_unlike_memory_go_together) {
  if (!has_mpi()) return;
  const TemporaryFolder folder;
  const std::string set = folder / "w.ms";
  succeed({"simulate", "--output", set, "--hours", "1", "--interval", "60", "--channels", "64", "--noncoplanar"});
  const Arguments plane = image("") + Arguments{"--accuracy", "1e-8", "--psf-accuracy", "1e-8", "--niter", "50"};
  Arguments with_w = image("") + Arguments{"--accuracy", "1e-6"};
  with_w[2] = set;
  with_w[6] = "512";
  with_w[8] = "5arcsec";
  struct Case {
    Arguments arguments;
    std::string tight_gib;
    double accuracy;
  };
  // With a w axis, only the tight rank alone would give the PSF a transform of its own.
  for (const auto& [arguments, gib, accuracy] : {Case{plane, tight_gib, 1e-7}, {with_w, "0.32", 1e-6}}) {
    const auto named = [&, &to = arguments](const std::string& imagename) {
      Arguments all = to + Arguments{"--weighting", "briggs", "--quiet"};
      all[4] = folder / imagename;
      return all;
    };
    succeed(named("one"));
    const Arguments roomy = named("two") + Arguments{"--memory", "1"}, tight = named("two") + Arguments{"--memory", gib};
    const Arguments second = Arguments{":"} + ranks(1, false);
    const Outcome outcome = Child(ranks(1) + roomy + second + tight, "mpirun").wait();
    BOOST_TEST_INFO(outcome.err);
    BOOST_REQUIRE_EQUAL(outcome.code, 0);
    BOOST_TEST(difference(folder / "two", folder / "one", "residual") < accuracy);
  }
}

BOOST_AUTO_TEST_CASE(processes_that_another_mpi_starts_are_refused) {
  if (!has_mpi()) return;
  const TemporaryFolder folder;
  const EnvironmentVariable rank("PMI_RANK", "1"), size("PMI_SIZE", "4");
  const Outcome outcome = run(image(folder / "a"));
  BOOST_TEST(outcome.code == 1);
  BOOST_TEST(outcome.err.find("started as one of 4 processes by a launcher that Open MPI") != std::string::npos, outcome.err);
  BOOST_TEST(files_below(folder / "").empty());
}

BOOST_AUTO_TEST_CASE(clean_does_not_go_on_from_another_number_of_ranks) {
  if (!has_mpi()) return;
  const TemporaryFolder folder;
  succeed_together(2, image(folder / "a") + Arguments{"--niter", "100"});
  const Outcome outcome = run(image(folder / "a") + Arguments{"--niter", "200", "--restart"});
  BOOST_TEST(outcome.code == 1);
  BOOST_TEST(outcome.err.find("was saved with mpirun -n 2, but this run has 1; expected mpirun -n 2, or no --restart") !=
                 std::string::npos,
             outcome.err);
}

BOOST_AUTO_TEST_SUITE_END()
