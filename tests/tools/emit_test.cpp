// Kernels for other imagers: what their files hold does what is said of it.
#include <boost/test/data/test_case.hpp>

#include "kernels/catalogue.h"
#include "tests/tools/emulated_hosts.h"
#include "tests/tools/program.h"
#include "tools/emit/hosts.h"

BOOST_AUTO_TEST_SUITE(emit)

namespace bdata = boost::unit_test::data;
namespace {

using namespace misfit;
using namespace misfit::tools::testing;
using nlohmann::json;

const std::vector<std::string> emulated{"wsclean", "ducc", "finufft", "yandasoft", "c-header", "csv"};

struct Scene {
  TemporaryFolder folder;
  std::string file = folder / "k";

  Arguments emit(const std::string& host, const Arguments& more) const {
    return Arguments{"kernel", "--emit", host, "--output", file} + more;
  }
  json emitted(const std::string& host, const Arguments& more) const {
    return json::parse(run(emit(host, more) + Arguments{"--json"}).out);
  }
};

constexpr int pixels = 180;

/// 800 visibilities of a random sky know the RMS to 4 %, and 180 pixels stand for a continuum to 3 %.
void check_agrees(double measured, double predicted) {
  BOOST_TEST(measured < 1.1 * predicted);
  BOOST_TEST(measured > 0.9 * predicted);
}

void check_refused(const Arguments& arguments, const std::string& part) {
  const Outcome outcome = run(arguments);
  BOOST_TEST_CONTEXT(outcome.err) {
    BOOST_TEST(outcome.code == 2);
    BOOST_TEST(outcome.out == "");
    BOOST_TEST(std::count(outcome.err.begin(), outcome.err.end(), '\n') == 1);
    BOOST_TEST_INFO(part);
    BOOST_TEST((outcome.err.find(part) != std::string::npos));
  }
}

}  // namespace

BOOST_TEST_DECORATOR(*boost::unit_test::label("sweep"))
BOOST_DATA_TEST_CASE(a_host_errs_by_what_is_said, bdata::make(emulated) * bdata::make({1.2, 2.0}) * bdata::make({4, 7, 8}),
                     host, padding, width) {
  const Scene scene;
  const std::string number = std::to_string(padding);
  Arguments options{"--width", std::to_string(width), "--padding", number, "--host-padding", number};
  if (host == "wsclean") options = options + Arguments{"--imsize", std::to_string(pixels)};
  const json said = scene.emitted(host, options);
  const EmulatedHost emulation = emulated_host(host, content(scene.file));
  const int fft_size = static_cast<int>(std::lround(pixels * padding));
  check_agrees(measured_error(emulation, false, pixels, fft_size), said["error"]["rms"]);
  BOOST_TEST(said["error_with_own_correction"].is_null() == !emulation.own_divisor);
  if (emulation.own_divisor)
    check_agrees(measured_error(emulation, true, pixels, fft_size), said["error_with_own_correction"]["rms"]);
}

BOOST_AUTO_TEST_CASE(a_kernel_for_another_padding_is_refused_unless_forced) {
  const Scene scene;
  const Arguments unfit{"--width", "7", "--x0", "0.25"};
  for (const char* host : {"casacore", "wsclean"}) {
    check_refused(scene.emit(host, unfit), "pads by 1.2");
    BOOST_TEST(!std::filesystem::exists(scene.file));
  }
  for (const char* host : {"ducc", "finufft", "yandasoft", "c-header", "csv"}) {
    succeed(scene.emit(host, unfit));  // they pad as one likes
    check_refused(scene.emit(host, unfit + Arguments{"--host-padding", "1.9"}), "pads by 1.9");
  }
  for (const char* x0 : {"0.2502", "0.2498"}) {  // 8e-4 of it
    succeed(scene.emit("casacore", {"--width", "7", "--x0", x0, "--host-padding", "2"}));
  }
  check_refused(scene.emit("casacore", {"--width", "7", "--x0", "0.2504", "--host-padding", "2"}), "x0 = 0.2504");
}

BOOST_AUTO_TEST_CASE(what_is_forced_is_judged_where_the_host_keeps_the_image) {
  const Scene scene;
  for (const char* x0 : {"0.25", "0.35", "0.45"}) {
    const json said = scene.emitted("wsclean", {"--width", "6", "--x0", x0, "--force", "--imsize", std::to_string(pixels)});
    BOOST_TEST(said["padding"] == 1.2);
    check_agrees(measured_error(emulated_host("wsclean", content(scene.file)), false, pixels, 216), said["error"]["rms"]);
  }
}

BOOST_TEST_DECORATOR(*boost::unit_test::label("sweep"))
BOOST_DATA_TEST_CASE(a_target_is_reached_by_the_least_that_does, bdata::make(tools::host_names()), host) {
  const Scene scene;
  for (const char* target : {"1e-2", "3e-3", "1e-3"}) {
    const json said = scene.emitted(host, {"--target-error", target, "--padding", "1.5", "--host-padding", "1.5"});
    BOOST_TEST(said["error"]["rms"].get<double>() <= std::stod(target));
    // A fifth fewer entries do not do, nor does a degree less.
    const Arguments as_chosen{"--padding", "1.5", "--host-padding", "1.5"};
    if (said["sampling"].is_number()) {
      const int fewer = said["sampling"].get<int>() * 8 / 10 | 1;
      if (fewer < 5 || fewer >= said["sampling"]) continue;
      const json less = scene.emitted(host, as_chosen + Arguments{"--width", std::to_string(said["width"].get<int>()),
                                                                  "--sampling", std::to_string(fewer)});
      BOOST_TEST(less["error"]["rms"].get<double>() > std::stod(target));
    } else if (const int degree = said["degree"]; degree > 3) {
      const json less = scene.emitted(host, as_chosen + Arguments{"--width", std::to_string(said["width"].get<int>()),
                                                                  "--degree", std::to_string(degree - 1)});
      BOOST_TEST(less["error"]["rms"].get<double>() > std::stod(target));
    }
  }
}

BOOST_TEST_DECORATOR(*boost::unit_test::label("sweep"))
BOOST_DATA_TEST_CASE(a_narrower_kernel_than_is_chosen_for_a_target_misses_it,
                     bdata::make({"wsclean", "ducc", "finufft", "c-header"}), host) {
  const Scene scene;
  for (const char* target : {"1e-2", "1e-3"}) {
    const Arguments padding{"--padding", "1.5", "--host-padding", "1.5"};
    const json chosen = scene.emitted(host, padding + Arguments{"--target-error", target});
    if (chosen["width"] == tools::find_host(host).min_width) continue;
    Arguments narrower = padding + Arguments{"--width", std::to_string(chosen["width"].get<int>() - 1)};
    if (chosen["sampling"].is_number())
      narrower = narrower + Arguments{"--sampling", std::to_string(chosen["sampling"].get<int>() * 10 | 1)};
    const json less = scene.emitted(host, narrower);
    BOOST_TEST(less["error"]["rms"].get<double>() > std::stod(target));
  }
}

BOOST_TEST_DECORATOR(*boost::unit_test::label("sweep"))
BOOST_DATA_TEST_CASE(a_target_is_reached_at_paddings_where_cells_meet_badly, bdata::make({"1.04", "1.05", "1.06"}), padding) {
  const Scene scene;  // of even tables an entry lies where C jumps, and the error depends on it
  const json said = scene.emitted("casacore", {"--host-padding", padding, "--target-error", "5e-3"});
  BOOST_TEST(said["error"]["rms"].get<double>() <= 5e-3);
  BOOST_TEST(said["sampling"].get<int>() % 2 == 1);
}

BOOST_AUTO_TEST_CASE(a_target_out_of_reach_is_refused_with_what_is_within) {
  const Scene scene;
  check_refused(scene.emit("casacore", {"--target-error", "1e-6"}), "cannot reach it at padding 1.2; expected at least 7.6");
  check_refused(scene.emit("yandasoft", {"--target-error", "1e-5", "--padding", "2"}), "with 1023 entries a cell");
  check_refused(scene.emit("wsclean", {"--target-error", "1e-7", "--padding", "2", "--host-padding", "2"}), "cannot reach it");
  check_refused(scene.emit("ducc", {"--target-error", "1e-15", "--padding", "1.2"}), "cannot reach it at padding 1.2");
}

BOOST_AUTO_TEST_CASE(what_a_host_cannot_hold_is_wrong_usage) {
  const Scene scene;
  const Arguments fit{"--padding", "1.2"};
  check_refused(scene.emit("aips", fit + Arguments{"--width", "7"}), "--emit aips: expected one of casacore, wsclean, ducc");
  check_refused(scene.emit("casacore", fit + Arguments{"--width", "8"}), "1 to 7");
  check_refused(scene.emit("ducc", fit + Arguments{"--width", "3"}), "4 to 16");
  check_refused(scene.emit("finufft", fit + Arguments{"--width", "17"}), "2 to 16");
  check_refused(scene.emit("ducc", {"--width", "7", "--padding", "3"}), "1.1 to 2.6");
  check_refused(scene.emit("wsclean", fit + Arguments{"--width", "7", "--sampling", "1024"}), "an odd number");
  check_refused(scene.emit("yandasoft", fit + Arguments{"--width", "7", "--sampling", "1025"}), "1 to 1024");
  check_refused(scene.emit("casacore", fit + Arguments{"--width", "7", "--interpolation", "1"}), "takes the nearest entry");
  check_refused(scene.emit("ducc", fit + Arguments{"--width", "7", "--sampling", "100"}), "evaluates polynomials");
  check_refused(scene.emit("csv", fit + Arguments{"--width", "7", "--sampling", "3"}), "4 to 100000");
  check_refused(scene.emit("ducc", {"--width", "7"}), "expected --padding or --x0");
  check_refused(scene.emit("casacore", {}), "expected --width, or --target-error");
  check_refused(scene.emit("casacore", {"--target-error", "1e-3", "--padding", "2"}), "pads by 1.2");
  check_refused(scene.emit("casacore", {"--target-error", "1e-3", "--force"}), "without --target-error");
  check_refused(scene.emit("casacore", fit + Arguments{"--width", "7", "--imsize", "400"}), "--imsize");
  check_refused(scene.emit("casacore", {"--target-error", "1e-3", "--width", "7"}), "expected it without --width");
  check_refused({"kernel", "--emit", "casacore", "--width", "7"}, "expected --output");
}

BOOST_AUTO_TEST_CASE(a_kernel_table_is_emitted_as_it_is) {
  const Scene scene;
  const std::string table = scene.folder / "mine.fits";
  succeed({"kernel", "--width", "6", "--padding", "1.2", "--output", table});
  const json of_file = scene.emitted("wsclean", {"--kernel", table}), of_name = scene.emitted("wsclean", {"--width", "6"});
  BOOST_TEST(of_file["error"] == of_name["error"]);
  BOOST_TEST(of_file["width"] == 6);
  check_refused({"kernel", "--kernel", table, "--emit", "wsclean", "--output", table}, "is the kernel that is to be emitted");
  BOOST_TEST(run({"kernel", "--inspect", table}).code == 0);
}

/// Every header is C99, and what it computes there is what the arrays in it say.
BOOST_DATA_TEST_CASE(a_compiler_takes_the_headers, bdata::make({"wsclean", "ducc", "finufft", "yandasoft", "c-header"}), host) {
  const Scene scene;
  succeed(scene.emit(host, {"--width", "6", "--padding", "1.2"}));
  const std::map<std::string, std::string> uses{{"wsclean", "misfit_divisor(0.3)"},
                                                {"ducc", "misfit_coeff[misfit_W]"},
                                                {"finufft", "misfit_phi(-0.4)"},
                                                {"yandasoft", "misfit_divisor(-0.3)"},
                                                {"c-header", "(misfit_taps(0.2, taps), taps[1])"}};
  const std::string source = scene.folder / "use.c", program = scene.folder / "use";
  std::ofstream(source)
      << "#include \"k\"\n#include <stdio.h>\nint main(void) { double taps[20]; (void)taps; printf(\"%.15g\", " << uses.at(host)
      << "); return 0; }\n";
  const Outcome compiled =
      Child({"-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-Wno-unused-const-variable", source, "-o", program},
            "cc")
          .wait();
  BOOST_TEST_REQUIRE(compiled.code == 0, compiled.err);
  const Outcome cxx = Child({"-std=c++20", "-x", "c++", "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-Wno-unused-variable",
                             "-fsyntax-only", scene.file},
                            "c++")
                          .wait();
  BOOST_TEST(cxx.code == 0, cxx.err);
  const double computed = std::stod(Child({}, program).wait().out);
  const EmulatedHost emulation = emulated_host(host, content(scene.file));
  const std::string which = host;
  if (which == "wsclean" || which == "yandasoft") BOOST_TEST(std::abs(computed / emulation.divisor(3, 10) - 1) < 1e-13);
  if (which == "finufft")  // phi at z = 2u/W: the cell 0 of a visibility at 1.2
    BOOST_TEST(std::abs(computed - emulation.taps(1.2)[static_cast<std::size_t>(1)].second) < 1e-14);
  if (which == "c-header")  // t = 0.2: a visibility 0.2 above the middle between the cells 2 and 3 of 0 … 5
    BOOST_TEST(std::abs(computed - emulation.taps(2.7)[1].second) < 1e-15);
}

BOOST_AUTO_TEST_SUITE_END()
