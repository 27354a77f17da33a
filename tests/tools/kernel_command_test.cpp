// Kernels as files: made, shown, imaged with.
#include "kernels/catalogue.h"
#include "kernels/kernel_table.h"
#include "tests/kernels/kernels.h"
#include "tests/tools/markup.h"
#include "tests/tools/program.h"

BOOST_AUTO_TEST_SUITE(kernel_command)

namespace {

using namespace misfit;
using namespace misfit::tools::testing;
using nlohmann::json;

struct Scene {
  TemporaryFolder folder;
  std::string file = folder / "k.fits";

  Arguments make(const Arguments& more) const { return Arguments{"kernel", "--output", file} + more; }
  Arguments inspect(const Arguments& more = {}) const { return Arguments{"kernel", "--inspect", file} + more; }
};

void check_refused(const Arguments& arguments, int code, const std::string& part) {
  const Outcome outcome = run(arguments);
  BOOST_TEST_CONTEXT(outcome.err) {
    BOOST_TEST(outcome.code == code);
    BOOST_TEST(outcome.out == "");
    BOOST_TEST(std::count(outcome.err.begin(), outcome.err.end(), '\n') == 1);
    BOOST_TEST_INFO(part);
    BOOST_TEST(contains(outcome.err, part));
  }
}

double relative_difference(const std::vector<double>& a, const std::vector<double>& b) {
  BOOST_REQUIRE(a.size() == b.size());
  double difference = 0, norm = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    difference += std::pow(a[i] - b[i], 2);
    norm += std::pow(b[i], 2);
  }
  return std::sqrt(difference / norm);
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_made_file_holds_the_kernel_asked_for) {
  const Scene scene;
  for (const char* name : {"least-misfit", "spheroidal"})
    for (const Arguments& x0 : {Arguments{"--x0", "0.3125"}, {"--padding", "1.6"}}) {
      succeed(scene.make(Arguments{"--kernel", name, "--width", "6", "--sampling", "64", "--interpolation", "3"} + x0));
      const kernels::KernelTable table = kernels::read_kernel_table(scene.file);
      BOOST_TEST(table.checksum_ok);
      BOOST_TEST(kernels::testing::same(table.kernel, kernels::kernel_family(name).make(6, 0.3125)));
      BOOST_TEST(table.sampling->per_cell == 64);
      BOOST_TEST(table.sampling->interpolation == 3);
    }
}

BOOST_AUTO_TEST_CASE(a_degree_cuts_the_polynomials_and_the_error_says_so) {
  const Scene scene;
  double finer = 1;
  for (const int degree : {0, 3, 5, 24}) {
    const Outcome outcome = run(scene.make({"--width", "6", "--x0", "0.25", "--degree", std::to_string(degree)}));
    BOOST_REQUIRE(outcome.code == 0);
    const kernels::Kernel kernel = kernels::read_kernel_table(scene.file).kernel;
    BOOST_TEST(kernel.polynomial.degree() <= degree);
    BOOST_TEST(kernel.misfit.mean == kernels::judge(kernel.polynomial, 0.25).mean);
    BOOST_TEST(kernel.misfit.mean < finer);
    BOOST_TEST(contains(outcome.out, "polynomials of this degree hold no more") ==
               (kernel.misfit.mean > 1.01 * kernel.origin.mean_error));
    finer = kernel.misfit.mean;
  }
}

BOOST_AUTO_TEST_CASE(what_doubles_cannot_hold_is_said) {
  const Scene scene;
  const Outcome outcome = run(scene.make({"--width", "17", "--x0", "0.25"}));
  BOOST_TEST(outcome.code == 0);
  BOOST_TEST(contains(outcome.out, "doubles hold no more"));
}

BOOST_AUTO_TEST_CASE(a_function_that_bends_inside_a_cell_is_said_to) {
  const Scene scene;
  const auto says_so = [&](const Arguments& kernel) {
    const Outcome outcome = run(scene.make(kernel + Arguments{"--x0", "0.25"}));
    BOOST_TEST(outcome.code == 0, outcome.err);
    return contains(outcome.out, "bends or jumps inside a cell");
  };
  BOOST_TEST(says_so({"--kernel", "bent", "--kernel-folder", MISFIT_PLUGINS, "--width", "4"}));
  BOOST_TEST(!says_so({"--kernel", "gauss", "--kernel-folder", MISFIT_PLUGINS, "--width", "4"}));
  for (const char* smooth : {"least-misfit", "spheroidal", "kaiser-bessel", "exp-semicircle", "prolate"})
    for (const char* width : {"4", "5", "8"}) BOOST_TEST(!says_so({"--kernel", smooth, "--width", width}));
}

BOOST_AUTO_TEST_CASE(inspection_shows_what_the_file_holds) {
  const Scene scene;
  succeed(scene.make({"--width", "7", "--x0", "0.25"}));
  const kernels::Kernel kernel = kernels::read_kernel_table(scene.file).kernel;
  const json shown = json::parse(run(scene.inspect({"--json"})).out);
  const json expected = {{"kernel", "least-misfit"},
                         {"width", 7},
                         {"x0", 0.25},
                         {"padding", 2.0},
                         {"sampling", 128},
                         {"interpolation", 3},
                         {"degree", kernel.polynomial.degree()},
                         {"E", kernel.misfit.mean},
                         {"max_ell", kernel.misfit.max},
                         {"worst_mean", kernel.misfit.worst_mean},
                         {"worst", kernel.misfit.worst},
                         {"E_optimum", kernel.origin.mean_error},
                         {"max_ell_optimum", kernel.origin.max_error},
                         {"max_ell_bound", nullptr},
                         {"condition", kernel.origin.condition},
                         {"iterations", kernel.origin.iterations},
                         {"precision", "double"},
                         {"version", shown.at("version")},
                         {"checksum_ok", true}};
  BOOST_TEST(shown == expected);
  const Outcome text = run(scene.inspect());
  BOOST_TEST(text.code == 0);
  BOOST_TEST(text.err == "");
  for (const char* part : {"least-misfit", "width 7", "x0 0.25", "padding of 2", "1.45439e-14", "128 rows", "degree 3"})
    BOOST_TEST(contains(text.out, part));
}

BOOST_AUTO_TEST_CASE(a_changed_file_is_shown_and_ends_with_an_error) {
  const Scene scene;
  succeed(scene.make({"--width", "7", "--x0", "0.25"}));
  std::string bytes = content(scene.file);
  bytes[bytes.size() - 3000] ^= 1;
  std::ofstream(scene.file, std::ios::binary) << bytes;
  for (const Arguments& way : {Arguments{}, Arguments{"--json"}}) {
    const Outcome outcome = run(scene.inspect(way));
    BOOST_TEST(outcome.code == 1);
    BOOST_TEST(contains(outcome.out, "least-misfit"));
    BOOST_TEST(contains(outcome.err, scene.file + " does not match its checksum"));
  }
  BOOST_TEST(json::parse(run(scene.inspect({"--json"})).out).at("checksum_ok") == false);
}

BOOST_AUTO_TEST_CASE(what_cannot_be_meant_is_wrong_usage) {
  const Scene scene;
  const auto refused = [&](const Arguments& more, const std::string& part) { check_refused(scene.make(more), 2, part); };
  check_refused({"kernel"}, 2, "one of --output, --inspect and --accuracy");
  refused({}, "--width");
  refused({"--width", "7"}, "either --x0 or --padding");
  refused({"--width", "7", "--x0", "0.25", "--padding", "2"}, "either --x0 or --padding");
  refused({"--width", "21", "--x0", "0.25"}, "width 21, expected 1 to 20");
  refused({"--width", "-1", "--x0", "0.25"}, "-1, expected 1 to 20");
  refused({"--width", "7", "--x0", "0.5"}, "0.5, expected 0.01 to 0.49");
  refused({"--width", "7", "--x0", "nan"}, "nan, expected 0.01 to 0.49");
  refused({"--width", "7", "--padding", "1"}, "expected more than 1");
  refused({"--width", "7", "--padding", "1000"}, "--padding 1000: expected more than 1, at most 500");
  refused({"--width", "7", "--x0", "0.25", "--sampling", "0"}, "--sampling 0: expected 1 to");
  refused({"--width", "7", "--x0", "0.25", "--interpolation", "4"}, "--interpolation 4: expected 0 to 3");
  refused({"--width", "7", "--x0", "0.25", "--degree", "25"}, "--degree 25: expected 0 to 24");
  refused({"--width", "7", "--x0", "0.25", "--kernel", "nosuch"}, "least-misfit, minimax");
  refused({"--inspect", scene.file}, "--inspect");
  refused({"--json"}, "--inspect");
  BOOST_TEST(!std::filesystem::exists(scene.file));
}

BOOST_AUTO_TEST_CASE(libraries_that_cannot_be_used_are_named) {
  const Scene scene;
  const auto refused = [&](const std::string& kernel, int code, const std::string& part) {
    check_refused(scene.make({"--width", "4", "--x0", "0.25", "--kernel", kernel, "--kernel-folder", MISFIT_PLUGINS}), code,
                  part);
  };
  refused("nosuch", 2, "libmisfit_kernel_nosuch.so does not exist");
  refused("refusing", 1, "register_refusing failed: no licence for this kernel");
  refused("box", 1, "cannot be corrected for");
  refused("nan", 1, "expected a finite number");
  check_refused(scene.make({"--kernel", "gauss-wide", "--kernel-folder", MISFIT_PLUGINS, "--width", "4", "--x0", "0.4"}), 2,
                "kernel gauss-wide: x0 = 0.4, expected 0.1 to 0.3");
  BOOST_TEST(!std::filesystem::exists(scene.file));
}

BOOST_AUTO_TEST_CASE(files_that_cannot_be_used_are_named) {
  const Scene scene;
  check_refused(scene.inspect(), 1, scene.file + ": it does not exist");
  std::ofstream(scene.file) << "text";
  check_refused(scene.inspect(), 1, scene.file + ": it is no FITS file");
  check_refused({"kernel", "--inspect", scene.folder / ""}, 1, "no regular file");
  check_refused({"kernel", "--width", "4", "--x0", "0.25", "--output", scene.folder / "none/k.fits"}, 1, "none does not exist");
  check_refused({"kernel", "--width", "4", "--x0", "0.25", "--output", "/proc/k.fits"}, 1, "/proc");
}

BOOST_AUTO_TEST_CASE(an_image_made_with_a_file_is_that_made_with_its_kernel) {
  const Scene scene;
  for (const auto& [width, padding] : {std::pair("7", "2"), {"6", "1.5"}, {"9", "1.2"}}) {
    succeed(scene.make({"--width", width, "--padding", padding}));
    // 160 times each padding is a size that FFTs are fast at: x0 is that of the file.
    const Arguments image =
        Arguments{"image", "--vis", snapshot(), "--imsize", "160", "--cell", "0.05arcsec", "--gridder", "standard"};
    succeed(image + Arguments{"--imagename", scene.folder / "file", "--kernel", scene.file});
    succeed(image + Arguments{"--imagename", scene.folder / "name", "--kernel-width", width, "--padding", padding});
    const json report = report_of(scene.folder / "file");
    json by_file = report["kernel"], by_name = report_of(scene.folder / "name")["kernel"];
    // A file's kernel is used as it is; by name its polynomials are cut to what half a percent of E allows.
    by_file.erase("evaluation");
    by_name.erase("evaluation");
    BOOST_TEST(by_file == by_name);
    const double kernel_error = report["error"]["expected_rms"];
    for (const char* kind : {"residual", "psf"}) {
      const auto a = pixels_of(scene.folder / "file", kind).pixel, b = pixels_of(scene.folder / "name", kind).pixel;
      BOOST_TEST(relative_difference(a, b) < kernel_error + 1e-7);  // and images in single precision
    }
    // The run can be repeated.
    succeed({"image", "--config", scene.folder / "file.last.ini", "--imagename", scene.folder / "again"});
    BOOST_TEST((pixels_of(scene.folder / "again", "psf").pixel == pixels_of(scene.folder / "file", "psf").pixel));
  }
}

BOOST_AUTO_TEST_CASE(an_image_made_with_a_library_is_that_made_with_the_same_function_by_name) {
  const TemporaryFolder folder;
  const Arguments library = {"--kernel", "gauss", "--kernel-folder", MISFIT_PLUGINS};
  const Arguments given = {"--kernel-width", "8", "--padding", "2", "--evaluation", "full"};
  succeed(small_image(snapshot(), folder / "library") + given + library);
  succeed(small_image(snapshot(), folder / "name") + given + Arguments{"--kernel", "gaussian"});
  BOOST_TEST(report_of(folder / "library")["kernel"]["name"] == "gauss");
  // Images in single precision.
  BOOST_TEST(relative_difference(pixels_of(folder / "library", "residual").pixel,
                                 pixels_of(folder / "name", "residual").pixel) < 1e-7);
}

BOOST_AUTO_TEST_CASE(width_and_padding_are_chosen_for_a_library_and_the_run_can_be_repeated) {
  const TemporaryFolder folder;
  const Arguments accuracy = {"--accuracy", "0.02", "--verify", "100", "--kernel", "gauss"};
  succeed(small_image(snapshot(), folder / "a") + accuracy + Arguments{"--kernel-folder", MISFIT_PLUGINS});
  BOOST_TEST(report_of(folder / "a")["error"]["measured_rms"].get<double>() < 0.02);
  const Arguments repeat = {"image", "--kernel-folder", MISFIT_PLUGINS, "--config"};
  succeed(repeat + Arguments{folder / "a.last.ini", "--imagename", folder / "b"});
  const Outcome without = run({"image", "--config", folder / "a.last.ini", "--imagename", folder / "b"});
  BOOST_TEST(without.code == 2);  // a file that is handed around brings no programs
  BOOST_TEST(without.err.find("or with --kernel-folder a library") != std::string::npos, without.err);
  const EnvironmentVariable environment("MISFIT_KERNEL_FOLDER", MISFIT_PLUGINS);
  succeed(small_image(snapshot(), folder / "c") + accuracy);
  {
    const EnvironmentVariable elsewhere("MISFIT_KERNEL_FOLDER", folder / "none");
    succeed(repeat + Arguments{folder / "c.last.ini", "--imagename", folder / "d"});
  }
  for (const char* other : {"b", "c", "d"})
    BOOST_TEST((pixels_of(folder / other, "residual").pixel == pixels_of(folder / "a", "residual").pixel), other);
}

BOOST_AUTO_TEST_CASE(a_prediction_made_with_a_library_is_that_made_with_the_same_function_by_name) {
  const TemporaryFolder folder;
  const std::string set = folder / "copy.ms";
  std::filesystem::copy(snapshot(), set, std::filesystem::copy_options::recursive);
  succeed(small_image(set, folder / "a") + Arguments{"--niter", "20"});
  const Arguments predict = {"predict", "--vis", set, "--model", folder / "a.model.fits", "--accuracy", "0.02"};
  succeed(predict + Arguments{"--kernel", "gauss", "--kernel-folder", MISFIT_PLUGINS});
  succeed(predict + Arguments{"--column", "CORRECTED_DATA"});
  succeed(small_image(set, folder / "library") + Arguments{"--datacolumn", "model"});
  succeed(small_image(set, folder / "name") + Arguments{"--datacolumn", "corrected"});
  // Each prediction keeps to 0.02, and so does the image of their difference, relative to that of the visibilities' peak.
  const auto library = pixels_of(folder / "library", "residual").pixel, name = pixels_of(folder / "name", "residual").pixel;
  const double difference = relative_difference(library, name);
  BOOST_TEST(difference > 0);
  BOOST_TEST(difference < 0.04);
}

BOOST_AUTO_TEST_CASE(a_prediction_made_with_a_file_is_that_made_by_name) {
  const Scene scene;
  const std::string set = scene.folder / "copy.ms";
  std::filesystem::copy(snapshot(), set, std::filesystem::copy_options::recursive);
  succeed(scene.make({"--width", "8", "--padding", "1.5"}));
  succeed(small_image(set, scene.folder / "a") + Arguments{"--niter", "20"});
  const Arguments predict = {"predict", "--vis", set, "--model", scene.folder / "a.model.fits"};
  succeed(predict + Arguments{"--kernel", scene.file, "--column", "CORRECTED_DATA"});
  succeed(predict);
  succeed(small_image(set, scene.folder / "file") + Arguments{"--datacolumn", "corrected"});
  succeed(small_image(set, scene.folder / "name") + Arguments{"--datacolumn", "model"});
  // Each prediction and image is made to 1e-6 or better; width 8 at padding 1.5 reaches 3e-7.
  BOOST_TEST(relative_difference(pixels_of(scene.folder / "file", "residual").pixel,
                                 pixels_of(scene.folder / "name", "residual").pixel) < 4e-6);
}

BOOST_AUTO_TEST_SUITE_END()
