#include "kernels/plugin_family.h"

#include <boost/test/unit_test.hpp>
#include <cfenv>

#include "tests/kernels/kernels.h"
#include "tests/temporary_folder.h"

using namespace misfit::kernels;
using misfit::testing::TemporaryFolder;

namespace {

const std::string folder = MISFIT_PLUGINS;

std::string file(const std::string& name) {
  return plugin_file(folder, name);
}

/// What `call` says when it throws a std::runtime_error; "" when it throws nothing.
template <typename Call>
std::string refusal(Call call) {
  try {
    call();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

std::string refusal_to_load(const std::string& name, const std::string& from = folder) {
  return refusal([&] { plugin_family(from, name); });
}

std::string refusal_to_make(const std::string& name, int width, double x0) {
  const KernelFamily family = plugin_family(folder, name);
  return refusal([&] { family.make(width, x0); });
}

double largest_difference(const Kernel& a, const Kernel& b) {
  BOOST_REQUIRE_EQUAL(a.polynomial.degree(), b.polynomial.degree());
  return (a.polynomial.coefficient - b.polynomial.coefficient).cwiseAbs().maxCoeff() /
         b.polynomial.coefficient.cwiseAbs().maxCoeff();
}

}  // namespace

BOOST_AUTO_TEST_SUITE(plugin_family)

BOOST_AUTO_TEST_CASE(a_library_with_a_formula_of_the_catalogue_makes_its_kernel) {
  const KernelFamily family = misfit::kernels::plugin_family(folder, "gauss");
  BOOST_TEST(family.name == "gauss");
  BOOST_TEST(family.description == "a test");
  BOOST_TEST(!family.costly);  // so that no cache keeps what may change
  for (const double x0 : {0.01, 0.25, 0.49}) {
    const Kernel made = family.make(8, x0), known = kernel_family("gaussian").make(8, x0);
    BOOST_TEST(made.name == "gauss");
    BOOST_TEST(made.x0 == x0);
    BOOST_TEST(largest_difference(made, known) < 1e-14);  // some roundings
    BOOST_TEST(std::abs(made.misfit.mean / known.misfit.mean - 1) < 1e-10);
    BOOST_TEST(std::abs(made.origin.mean_error / known.origin.mean_error - 1) < 1e-10);
  }
}

BOOST_AUTO_TEST_CASE(a_library_says_which_widths_and_x0_it_offers_and_has_a_context) {
  const KernelFamily family = misfit::kernels::plugin_family(folder, "gauss-wide");
  BOOST_TEST(family.min_width == 1);
  BOOST_TEST(family.max_width == 20);
  BOOST_TEST(family.min_x0 == 0.1);
  BOOST_TEST(family.max_x0 == 0.3);
  BOOST_CHECK_THROW(family.make(21, 0.25), std::invalid_argument);
  BOOST_CHECK_THROW(family.make(8, 0.31), std::invalid_argument);
  const Eigen::VectorXd taps = family.make(8, 0.25).polynomial(0.25);
  // Of exp(−u²/4) at u = 3.75 and 0.25; stored to 1e-10 of the largest.
  BOOST_TEST(std::abs(taps[0] / taps[4] - std::exp((0.25 * 0.25 - 3.75 * 3.75) / 4)) < 1e-9);
}

BOOST_AUTO_TEST_CASE(x0_has_the_usual_range_where_a_library_gives_none) {
  const KernelFamily family = misfit::kernels::plugin_family(folder, "gauss"), usual;
  BOOST_TEST(family.min_x0 == usual.min_x0);
  BOOST_TEST(family.max_x0 == usual.max_x0);
}

BOOST_AUTO_TEST_CASE(values_are_asked_for_inside_of_cells_only_and_of_any_scale) {
  const KernelFamily family = misfit::kernels::plugin_family(folder, "steep");
  for (int width = 1; width <= 20; ++width) {
    const Kernel kernel = family.make(width, 0.01);
    BOOST_TEST(std::abs(optimal_correction(kernel.polynomial, Eigen::VectorXd::Zero(1))[0] - 1) < 1e-14);
  }
}

BOOST_AUTO_TEST_CASE(loading_a_library_leaves_the_arithmetic_as_it_is) {
  BOOST_REQUIRE(std::fegetround() == FE_TONEAREST);
  misfit::kernels::plugin_family(folder, "rounding-up");
  BOOST_TEST(std::fegetround() == FE_TONEAREST);
}

BOOST_AUTO_TEST_CASE(what_is_stored_of_a_function_that_bends_within_cells_is_judged_as_it_is_stored) {
  const Kernel kernel = misfit::kernels::plugin_family(folder, "bent").make(4, 0.25);
  BOOST_TEST(kernel.polynomial.degree() == highest_degree);
  BOOST_TEST(kernel.misfit.mean == judge(kernel.polynomial, 0.25).mean);
}

BOOST_AUTO_TEST_CASE(a_folder_lists_its_libraries) {
  const TemporaryFolder some;
  for (const char* name : {"libmisfit_kernel_b.so", "libmisfit_kernel_a-1.so", "libmisfit_kernel_.so", "kernel_c.so", "d"})
    std::ofstream(some / name) << "";
  BOOST_TEST((plugins_in(some / "") == std::vector<std::string>{"a-1", "b"}));
  BOOST_TEST(plugins_in(some / "none").empty());
}

BOOST_AUTO_TEST_CASE(files_that_are_no_kernel_libraries_are_named) {
  const TemporaryFolder some;
  const auto says = [&](const std::string& name, const std::string& message) {
    BOOST_TEST_INFO(message);
    const std::string said = refusal_to_load(name, some / "");
    BOOST_TEST(said.rfind("kernel library " + plugin_file(some / "", name).string() + " " + message, 0) == 0, said);
  };
  says("none", "does not exist");
  std::ofstream(some / "libmisfit_kernel_text.so") << "text";
  says("text", "cannot be loaded: ");
  std::filesystem::copy(file("gauss"), plugin_file(some / "", "other-name"));
  says("other-name",
       "has no function register_other_name; expected extern \"C\" void register_other_name(MisfitKernelPlugin*)");
}

BOOST_AUTO_TEST_CASE(a_library_that_lacks_a_function_is_refused_with_its_name) {
  BOOST_TEST(refusal_to_load("unresolved").find("misfit_test_function_that_is_nowhere") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(what_a_library_fills_in_wrongly_is_named_with_what_was_expected) {
  for (const auto& [name, message] : {
           std::pair("silent", ": register_silent sets no version; expected MISFIT_KERNEL_PLUGIN_VERSION"),
           {"aged",
            " was built for version 2 of the kernel interface, this program has version 1: build it anew against the "
            "installed misfit"},
           {"nameless", ": register_nameless sets no name; expected \"nameless\""},
           {"misnamed", ": register_misnamed sets the name \"someone-else\"; expected \"misnamed\""},
           {"reserving", ": register_reserving sets what is reserved; expected 0 there"},
           {"valueless", ": register_valueless sets no value; expected the function"},
           {"narrow", ": register_narrow offers widths 0 to 20; expected min_width of 1 or more"},
           {"wide", ": register_wide offers widths 1 to 21; expected"},
           {"crossed", ": register_crossed offers widths 6 to 5; expected"},
           {"beyond-x0", ": register_beyond_x0 offers x0 from 0.01 to 0.5; expected"},
           {"crossed-x0", ": register_crossed_x0 offers x0 from 0.3 to 0.2; expected"},
           {"refusing", ": register_refusing failed: no licence for this kernel"},
           {"breaking", ": register_breaking threw something that is no std::exception"},
       }) {
    const std::string said = refusal_to_load(name);
    BOOST_TEST(said.rfind("kernel library " + file(name) + message, 0) == 0, said);
    BOOST_TEST(said.find('\n') == std::string::npos);
  }
}

BOOST_AUTO_TEST_CASE(a_function_that_cannot_be_used_is_named_with_where_and_why) {
  const auto says = [](const std::string& name, int width, double x0, const std::string& message) {
    const std::string said = refusal_to_make(name, width, x0);
    BOOST_TEST(said.rfind("kernel " + name + " of " + file(name) + ", width " + std::to_string(width) + ", x0 ", 0) == 0, said);
    BOOST_TEST(said.find(message) != std::string::npos, said);
    BOOST_TEST(said.find('\n') == std::string::npos);
  };
  says("throwing", 6, 0.25, " failed: no value beyond 1");
  says("nan", 6, 0.25, ", x0 0.25: value at u = ");
  says("nan", 6, 0.25, " is nan; expected a finite number");
  says("infinite", 4, 0.25, " is inf; expected a finite number");
  says("negative", 4, 0.25, "has an integral over u of -36");
  says("box", 4, 0.25, "cannot be corrected for");
  BOOST_TEST(refusal_to_make("throwing", 2, 0.25) == "");
  BOOST_TEST(refusal_to_make("nan", 2, 0.25) == "");
  BOOST_TEST(refusal_to_make("box", 4, 0.2) == "");
}

BOOST_AUTO_TEST_SUITE_END()
