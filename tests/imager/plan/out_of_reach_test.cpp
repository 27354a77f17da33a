#include "imager/plan/out_of_reach.h"

#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>

#include "imager/data/extent.h"
#include "imager/plan/gridding_plan.h"

BOOST_AUTO_TEST_SUITE(out_of_reach)

namespace bdata = boost::unit_test::data;
using namespace misfit;
using namespace misfit::imager;

namespace {

GriddingRequest request(int pixels, double accuracy) {
  GriddingRequest r;
  r.geometry = {pixels, pixels, 1e-6, {}};
  r.accuracy = accuracy;
  r.samples = 1000;
  return r;
}

std::string refusal(const GriddingRequest& r) {
  try {
    plan_gridding(r);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  BOOST_FAIL("accuracy " << r.accuracy << " was not refused");
  return "";
}

void check_names(const GriddingRequest& r, const std::string& limit) {
  const std::string said = refusal(r);
  BOOST_TEST(said.find("is out of reach of " + limit + ";") != std::string::npos, said);
}

/// The number after `before`; 0 where it is not there.
double number_after(const std::string& before, const std::string& text) {
  const std::size_t at = text.find(before);
  return at == std::string::npos ? 0 : std::stod(text.substr(at + before.size()));
}

}  // namespace

BOOST_DATA_TEST_CASE(tables_are_blamed_with_a_sampling_that_serves,
                     bdata::make({64, 500}) * bdata::xrange(4) * bdata::make({1e-3, 1e-5, 1e-7}), pixels, degree, accuracy) {
  GriddingRequest r = request(pixels, accuracy);
  r.kernel_width = 10;  // exact enough for them all, and no others need be solved
  r.padding = 2;
  const auto interpolation = static_cast<kernels::Interpolation>(degree);
  r.lookup = kernels::TableOptions{3, interpolation};
  const std::string said = refusal(r);
  const std::string table = kernels::interpolation_names[static_cast<std::size_t>(degree)];
  BOOST_TEST(said.find("is out of reach of " + table + " tables of 3 entries a cell;") != std::string::npos, said);
  BOOST_TEST(said.find("--evaluation polynomial") != std::string::npos);
  const double sampling = number_after("--sampling ", said);
  BOOST_TEST((sampling == 0) == (degree == 0 && accuracy == 1e-7));  // 3 million entries are more than a table may have
  if (sampling == 0) return;
  r.lookup->samples_per_cell = static_cast<int>(sampling);
  BOOST_CHECK_NO_THROW(plan_gridding(r));
}

BOOST_DATA_TEST_CASE(single_precision_is_blamed_where_double_serves, bdata::make({64, 500}) * bdata::make({1e-7, 1e-9}), pixels,
                     accuracy) {
  GriddingRequest r = request(pixels, accuracy);
  r.precision = Precision::single_precision;
  check_names(r, "single precision");
  BOOST_TEST(refusal(r).find("expected --precision double or auto") != std::string::npos);
  r.precision.reset();
  BOOST_CHECK_NO_THROW(plan_gridding(r));
}

BOOST_DATA_TEST_CASE(where_w_may_be_neglected_what_is_named_is_granted,
                     bdata::make({"sinc", "nearest", "spheroidal-0"}) * bdata::make({0.01, 0.2, 0.31}), kernel, part) {
  for (const double asked : {0.07, 1e-4}) {
    GriddingRequest r = request(64, asked);
    r.kernel = kernels::kernel_family(kernel);
    r.max_abs_w = part * asked / max_w_phase_rad(1, r.geometry);
    if (choose_gridding(r).reached) continue;
    r.accuracy = number_after("it can reach ", refusal(r));
    BOOST_REQUIRE(r.accuracy > 0);  // 0 asks for none
    BOOST_TEST_INFO("asked " << asked << ", then " << r.accuracy);
    if (r.accuracy < 1) BOOST_CHECK_NO_THROW(plan_gridding(r));
  }
}

BOOST_DATA_TEST_CASE(with_a_w_axis_what_is_named_and_more_is_granted,
                     bdata::make({"spheroidal", "spheroidal-0", "spheroidal-1.5", "gaussian"}) * bdata::make({16, 40}), kernel,
                     pixels) {
  GriddingRequest r = request(pixels, 1e-7);
  r.kernel = kernels::kernel_family(kernel);
  r.gridder = Gridder::wide;
  r.max_abs_w = 1e-3 / max_w_phase_rad(1, r.geometry);
  const double named = number_after("it can reach ", refusal(r));
  BOOST_REQUIRE(named > 0);
  for (const double times : {1.0, 1.03, 1.07, 1.12, 1.2}) {
    r.accuracy = times * named;
    BOOST_TEST_INFO("named " << named << ", asked " << times << " times that");
    BOOST_CHECK_NO_THROW(plan_gridding(r));
  }
}

BOOST_AUTO_TEST_CASE(of_tables_and_single_precision_the_worse_is_blamed) {
  GriddingRequest r = request(64, 1e-9);
  r.precision = Precision::single_precision;
  r.lookup = kernels::TableOptions{3, kernels::Interpolation::nearest};
  check_names(r, "nearest tables of 3 entries a cell");
  r.lookup = kernels::TableOptions{512, kernels::Interpolation::cubic};
  check_names(r, "single precision");
}

BOOST_AUTO_TEST_CASE(kernels_are_blamed_with_what_was_given_of_them) {
  GriddingRequest r = request(64, 1e-9);
  r.kernel = kernels::kernel_family("spheroidal");
  check_names(r, "kernel spheroidal");
  BOOST_TEST(refusal(r).ends_with("; expected --kernel least-misfit"));
  r = request(64, 1e-9);
  r.kernel_width = 3;
  check_names(r, "kernel least-misfit of width 3");
  BOOST_TEST(refusal(r).ends_with("; expected --kernel-width and --padding left to be chosen"));
  r.padding = 2;
  r.lookup = kernels::TableOptions{500, kernels::Interpolation::cubic};
  check_names(r, "kernel least-misfit of width 3 at padding 2");
}

BOOST_AUTO_TEST_CASE(double_precision_is_blamed_below_all_that_kernels_reach_and_with_many_turns) {
  for (const int pixels : {64, 500}) check_names(request(pixels, 1e-16), "double precision");
  GriddingRequest r = request(64, 1e-9);
  r.max_abs_w = 1e8 / max_w_phase_rad(1, r.geometry);
  check_names(r, "double precision, where phases reach 1.6e+07 turns");
}

BOOST_AUTO_TEST_SUITE_END()
