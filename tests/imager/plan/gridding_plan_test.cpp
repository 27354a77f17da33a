#include "imager/plan/gridding_plan.h"

#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <cstdio>
#include <optional>
#include <stdexcept>
#include <string>

BOOST_AUTO_TEST_SUITE(gridding_plan)

namespace bdata = boost::unit_test::data;
using namespace misfit::imager;

namespace {

struct Size {
  int width, height;
};
constexpr Size sizes[] = {{1, 1}, {7, 7}, {63, 63}, {5000, 5000}, {5000, 3}, {331, 2000}};

GriddingRequest request(Size size, double accuracy, const std::string& kernel = "least-misfit") {
  GriddingRequest r;
  r.geometry = {size.width, size.height, 1e-6, {}};
  r.accuracy = accuracy;
  r.kernel = misfit::kernels::kernel_family(kernel);
  r.samples = 1000000;
  return r;
}

const Decision& decision_of(const GriddingPlan& plan, const std::string& item) {
  for (const Decision& decision : plan.decisions)
    if (decision.item == item) return decision;
  throw std::out_of_range(item);
}

/// What the message of a refusal says can be reached.
double named_accuracy(const GriddingRequest& r) {
  try {
    plan_gridding(r);
  } catch (const std::invalid_argument& error) {
    const std::string message = error.what(), before = "it can reach ";
    const std::size_t at = message.find(before);
    if (at != message.npos) return std::stod(message.substr(at + before.size()));
  }
  BOOST_FAIL("accuracy " << r.accuracy << " was not refused");
  return 0;
}

/// The widest kernel that is solved for before a plan stands.
int widest_solved(GriddingRequest r) {
  int widest = 0;
  r.kernel.solve = [&widest, solve = r.kernel.solve](int width, double x0) {
    widest = std::max(widest, width);
    return solve(width, x0);
  };
  plan_gridding(r);
  return widest;
}

/// A refusal names an accuracy that is granted.
void check_refusal(GriddingRequest r) {
  const double asked = r.accuracy;
  r.accuracy = named_accuracy(r);
  BOOST_TEST(r.accuracy > asked);
  BOOST_CHECK_NO_THROW(plan_gridding(r));
}

/// Either the accuracy is promised, or refused with one that is granted.
void check_refusal_or_promise(const GriddingRequest& r) {
  GriddingRequest best = r;
  best.best_effort = true;
  if (plan_gridding(best).worst_error > r.accuracy) check_refusal(r);
}

}  // namespace

BOOST_TEST_DECORATOR(*boost::unit_test::label("sweep"))
BOOST_DATA_TEST_CASE(the_worst_error_is_within_the_accuracy_and_less_accuracy_never_costs_more, bdata::xrange(std::size(sizes)),
                     i) {
  const Size size = sizes[i];
  std::optional<GriddingPlan> stricter;
  for (const double accuracy : {1e-10, 1e-6, 1e-4, 1e-2}) {
    const GriddingPlan plan = plan_gridding(request(size, accuracy));
    BOOST_TEST_CONTEXT(size.width << " × " << size.height << " at " << accuracy) {
      BOOST_TEST(plan.worst_error <= accuracy);
      BOOST_TEST(plan.expected_error <= plan.worst_error);
      BOOST_TEST(plan.worst_error <= plan.bound_max);
      BOOST_TEST(plan.bound_rms <= plan.bound_max);
      const bool single = plan.options.precision == Precision::single_precision;
      BOOST_TEST(single >= (accuracy >= 1e-4));  // cheaper wherever its rounding is far below
      BOOST_TEST(single <= (accuracy >= 1e-6));
      BOOST_CHECK_NO_THROW(make_coplanar_transform(plan.options));
    }
    if (stricter) {
      const CoplanarOptions &a = plan.options, &b = stricter->options;
      BOOST_TEST(!(a.precision == b.precision && a.kernel_u.width() >= b.kernel_u.width() && a.nu >= b.nu && a.nv >= b.nv &&
                   plan.worst_error > stricter->worst_error));
    }
    stricter = plan;
  }
}

BOOST_AUTO_TEST_CASE(less_accuracy_takes_no_wider_kernel_at_a_given_padding) {
  int width = 0;
  for (const double accuracy : {0.5, 1e-2, 1e-4, 1e-6, 1e-8, 1e-10}) {
    GriddingRequest r = request({512, 512}, accuracy);
    r.padding = 2;
    const int needed = plan_gridding(r).options.kernel_u.width();
    BOOST_TEST(needed >= width);
    width = needed;
  }
}

BOOST_AUTO_TEST_CASE(out_of_reach_is_refused_with_what_can_be_reached, *boost::unit_test::label("sweep")) {
  for (const Size size : {Size{1, 1}, {64, 64}, {5000, 300}}) {
    for (const double accuracy : {1e-12, 1e-17}) check_refusal_or_promise(request(size, accuracy));
    check_refusal(request(size, 1e-9, "spheroidal"));
  }
  for (int width = 2; width <= 6; ++width)
    for (const double padding : {1.1, 1.5}) {
      GriddingRequest r = request({1000, 1000}, 1e-15);
      r.kernel_width = width;
      r.padding = padding;
      check_refusal(r);
    }
}

BOOST_AUTO_TEST_CASE(best_effort_takes_the_most_exact_kernel) {
  GriddingRequest r = request({500, 400}, 1e-17);
  r.best_effort = true;
  const GriddingPlan best = plan_gridding(r);
  r.accuracy = 1e-10;
  BOOST_TEST(best.worst_error <= plan_gridding(r).worst_error);
  BOOST_TEST((best.options.precision == Precision::double_precision));
}

BOOST_AUTO_TEST_CASE(the_spheroidal_function_keeps_the_accuracies_it_reaches) {
  for (const Size size : sizes) {
    const GriddingPlan plan = plan_gridding(request(size, 1e-2, "spheroidal"));
    BOOST_TEST(plan.worst_error <= 1e-2);
    BOOST_TEST(plan.options.kernel_u.name == "spheroidal");
  }
}

BOOST_AUTO_TEST_CASE(a_given_width_and_padding_are_taken) {
  for (const int width : {1, 4, 9})
    for (const double padding : {1.02, 1.1, 1.5, 3.0})
      for (const Size size : {Size{50, 50}, {1000, 600}, {8031, 40}}) {
        GriddingRequest r = request(size, 0);
        r.kernel_width = width;
        r.padding = padding;
        const GriddingPlan plan = plan_gridding(r);
        BOOST_TEST(plan.options.kernel_u.width() == width);
        BOOST_TEST(plan.options.kernel_v.width() == width);
        BOOST_TEST(plan.options.nu >= padding * size.width);
        BOOST_TEST(plan.options.nv >= padding * size.height);
        BOOST_TEST_INFO("padding " << padding << " of " << size.width << " × " << size.height);
        BOOST_CHECK_NO_THROW(make_coplanar_transform(plan.options));
      }
}

BOOST_AUTO_TEST_CASE(what_tables_or_stored_kernels_limit_is_not_looked_for_along_w_among_ever_wider_kernels) {
  GriddingRequest r = request({1, 1}, 0);
  r.gridder = Gridder::wide;
  r.max_abs_w = 1000;
  r.kernel_width = 6;
  r.padding = 1.126;
  r.lookup = misfit::kernels::TableOptions{100, misfit::kernels::Interpolation::nearest};
  BOOST_TEST(widest_solved(r) < 12);  // of 20, since at the least padding one of 10 is below the error of the tables

  r = request({64, 64}, 0, "kaiser-bessel");
  r.gridder = Gridder::wide;
  r.max_abs_w = 1000;
  r.kernel_width = 16;
  r.padding = 3;
  BOOST_TEST(widest_solved(r) < 20);
}

BOOST_AUTO_TEST_CASE(a_refusal_says_whether_it_is_the_psf_whose_accuracy_is_out_of_reach) {
  GriddingRequest r = request({64, 64}, 1e-3, "spheroidal");
  r.psf_accuracy = 1e-9;
  const auto begins_with = [](const std::string& begin) {
    return [begin](const std::invalid_argument& error) { return std::string(error.what()).rfind(begin, 0) == 0; };
  };
  BOOST_CHECK_EXCEPTION(plan_gridding(r), std::invalid_argument, begins_with("accuracy of the PSF 1e-09 is out of reach"));
  std::swap(r.accuracy, r.psf_accuracy);
  BOOST_CHECK_EXCEPTION(plan_gridding(r), std::invalid_argument, begins_with("accuracy 1e-09 is out of reach"));
}

BOOST_AUTO_TEST_CASE(single_precision_never_limits_a_given_width_and_padding) {
  for (const double padding : {1.05, 1.1, 1.15, 1.5, 2.0})
    for (const int width : {3, 5, 10, 14}) {
      GriddingRequest r = request({256, 256}, 0);
      r.kernel_width = width;
      r.padding = padding;
      const GriddingPlan plan = plan_gridding(r);
      const bool single = plan.options.precision == Precision::single_precision;
      BOOST_TEST((!single || plan.rounding < 0.1 * plan.worst_error), "width " << width << ", padding " << padding);
    }
}

BOOST_AUTO_TEST_CASE(what_cannot_be_meant_is_refused) {
  const auto refused = [](auto change) {
    GriddingRequest r = request({64, 64}, 1e-6);
    change(r);
    BOOST_CHECK_THROW(plan_gridding(r), std::invalid_argument);
  };
  refused([](GriddingRequest& r) { r.accuracy = -1e-6; });
  refused([](GriddingRequest& r) { r.accuracy = 1; });
  refused([](GriddingRequest& r) { r.accuracy = std::nan(""); });
  refused([](GriddingRequest& r) { r.kernel_width = 21; });
  refused([](GriddingRequest& r) {
    r.kernel = misfit::kernels::family_of(r.kernel.make(7, 0.25));
    r.padding = 1.9;
  });
  refused([](GriddingRequest& r) { r.kernel_width = 21; });
  refused([](GriddingRequest& r) { r.kernel_width = -1; });
  refused([](GriddingRequest& r) { r.padding = 1.01; });
  refused([](GriddingRequest& r) { r.padding = 11; });
  refused([](GriddingRequest& r) { r.max_abs_w = -10; });
}

BOOST_AUTO_TEST_CASE(a_single_kernel_is_padded_for_its_own_x0_and_judged_over_what_is_left) {
  for (const double x0 : {0.45, 0.25, 0.06}) {
    GriddingRequest r = request({100, 331}, 0);
    const misfit::kernels::Kernel kernel = r.kernel.make(5, x0);
    r.kernel = misfit::kernels::family_of(kernel);
    const CoplanarOptions options = plan_gridding(r).options;
    for (const auto& [used, pixels, fft] :
         {std::tuple(options.kernel_u, 100, options.nu), {options.kernel_v, 331, options.nv}}) {
      BOOST_TEST(used.x0 == 0.5 * pixels / fft);
      BOOST_TEST(used.x0 <= x0);
      BOOST_TEST(used.x0 > 0.9 * x0);  // sizes that FFTs are fast at lie closer than that
      BOOST_TEST((used.polynomial.coefficient == kernel.polynomial.coefficient));
      BOOST_TEST(used.misfit.mean == misfit::kernels::judge(kernel.polynomial, used.x0).mean);
    }
  }
}

BOOST_AUTO_TEST_CASE(a_psf_is_as_exact_as_asked_whether_its_transform_is_its_own_or_not, *boost::unit_test::label("sweep")) {
  for (const double max_abs_w : {0.0, 1e8})
    for (const double psf_accuracy : {1e-2, 1e-4, 1e-8}) {
      GriddingRequest r = request({2000, 2000}, 1e-4);
      r.psf_accuracy = psf_accuracy;
      r.max_abs_w = max_abs_w;
      const GriddingPlan plan = plan_gridding(r);
      BOOST_TEST(plan.worst_error <= r.accuracy);
      BOOST_TEST((plan.psf ? plan.psf->worst_error : plan.worst_error) <= psf_accuracy);
    }
}

BOOST_AUTO_TEST_CASE(facets_leave_fewer_turns_than_the_whole_image_and_one_plane_is_compared_with_none) {
  for (const auto& [pixels, max_abs_w] : {std::pair(300, 3e3), {4001, 3e3}, {300, 1e9}}) {
    GriddingRequest r = request({pixels, pixels}, 1e-6);
    r.max_abs_w = max_abs_w;
    r.gridder = Gridder::wide;
    const GriddingPlan plan = plan_gridding(r);
    const std::string because = decision_of(plan, "facets").because;
    if (plan.options.facets_l * plan.options.facets_m == 1) {
      BOOST_TEST(because.find(" of ") == std::string::npos, because);
      continue;
    }
    double left = 0, turns = 0;
    BOOST_TEST_REQUIRE(std::sscanf(because.c_str(), "each on its own tangent plane: at most %lf of %lf", &left, &turns) == 2);
    BOOST_TEST(left < turns);
  }
}

BOOST_AUTO_TEST_CASE(every_decision_says_why) {
  for (const Decision& decision : plan_gridding(request({640, 480}, 1e-5)).decisions) {
    BOOST_TEST(!decision.item.empty());
    BOOST_TEST(!decision.decision.empty());
    BOOST_TEST(!decision.because.empty());
  }
}

BOOST_DATA_TEST_CASE(stokes_parameters_at_once_cost_more_than_one_and_less_than_alone,
                     bdata::make({0.0, 1e6}) * bdata::make({10, 100000000}), max_abs_w, samples) {
  GriddingRequest r = request({1000, 1000}, 1e-4);
  r.samples = static_cast<std::uint64_t>(samples);
  r.max_abs_w = max_abs_w;
  GriddingWork work = plan_gridding(r).choice.best.work;
  const double with_psf = CostModel().seconds(work);
  work.psf = false;
  const double one = CostModel().seconds(work);
  work.psf = true;
  work.stokes = 4;
  const double four = CostModel().seconds(work);
  BOOST_TEST(four > with_psf);
  BOOST_TEST(four < with_psf + 3 * one);
  r.stokes = 4;
  BOOST_TEST(plan_gridding(r).choice.best.work.stokes == 4);
}

/// All planes are transformed whenever samples have gathered, so that FFTs count as often.
BOOST_AUTO_TEST_CASE(the_less_is_gathered_at_once_the_less_is_left_to_ffts) {
  GriddingRequest r = request({2048, 2048}, 1e-4);
  r.geometry.cell_rad = 5e-6;
  r.max_abs_w = 5e4;
  r.samples = 1000000000;
  double last = HUGE_VAL;
  for (const std::size_t at_once : {std::size_t{1} << 40, std::size_t{1} << 26, std::size_t{1} << 20, std::size_t{1} << 17}) {
    r.samples_at_once = at_once;
    const GriddingPlan plan = plan_gridding(r);
    const GriddingWork& work = plan.choice.best.work;
    BOOST_TEST(work.gathers == static_cast<int>((r.samples + at_once - 1) / at_once));
    BOOST_TEST((decision_of(plan, "w planes").because.find("; made ") != std::string::npos) == (work.gathers > 1));
    GriddingWork once = work;
    once.gathers = 1;
    const double ffts_s = CostModel().fft_seconds(once);
    BOOST_TEST(CostModel().fft_seconds(work) == work.gathers * ffts_s, boost::test_tools::tolerance(1e-12));
    BOOST_TEST(ffts_s <= last);
    last = ffts_s;
  }
  r.samples_at_once = std::size_t{1} << 40;
  BOOST_TEST(CostModel().fft_seconds(plan_gridding(r).choice.best.work) > last);
}

BOOST_AUTO_TEST_SUITE_END()
