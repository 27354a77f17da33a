#include "imager/plan/planned_transform.h"

#include <boost/test/unit_test.hpp>

#include "tests/imager/comparison.h"
#include "tests/imager/random_samples.h"

BOOST_AUTO_TEST_SUITE(planned_transform)

using namespace misfit::imager;
using namespace misfit::imager::testing;

namespace {

const ImageGeometry field{128, 96, 0.002, {}};

GriddingRequest request_for(const VisibilityBlock& block, double max_abs_w) {
  GriddingRequest request;
  request.geometry = field;
  request.accuracy = 1e-5;
  request.samples = block.samples();
  request.max_abs_w = max_abs_w;
  request.threads = 2;
  return request;
}

AdjointResult adjoint_of(const Transform& transform, const VisibilityBlock& block) {
  const auto sum = transform.adjoint({.with_psf = true});
  sum->add(block);
  return sum->finish();
}

Image model_of(int pixels) {
  Image model(field.width, field.height);
  for (int i = 0; i < pixels; ++i) model.at(i % field.height, 7 * i % field.width) = 1 + 0.1 * i;
  return model;
}

bool decided(const GriddingPlan& plan, const std::string& item) {
  return std::any_of(plan.decisions.begin(), plan.decisions.end(), [&](const Decision& d) { return d.item == item; });
}

}  // namespace

BOOST_AUTO_TEST_CASE(images_of_a_few_samples_are_direct_sums) {
  const VisibilityBlock block = random_samples_with_w(3, 2, field.cell_rad, 200, 1);
  const GriddingPlan plan = plan_gridding(request_for(block, 300));
  BOOST_TEST_REQUIRE(plan.direct);
  BOOST_TEST(decided(plan, "images and predictions"));
  BOOST_TEST(plan.expected_error < 1e-12);
  const AdjointResult planned = adjoint_of(PlannedTransform(plan), block);
  const AdjointResult direct = adjoint_of(DirectTransform(field, 1), block);
  BOOST_TEST((planned.images[0].pixel == direct.images[0].pixel));
  BOOST_TEST((planned.psf.pixel == direct.psf.pixel));
}

BOOST_AUTO_TEST_CASE(small_models_are_predicted_by_direct_sums_and_larger_ones_by_degridding) {
  const VisibilityBlock block = random_samples_with_w(4000, 4, field.cell_rad, 200, 2);
  const GriddingPlan plan = plan_gridding(request_for(block, 300));
  BOOST_TEST_REQUIRE(!plan.direct);
  BOOST_TEST_REQUIRE(plan.direct_pixels > 0U);
  BOOST_TEST(decided(plan, "prediction"));
  const PlannedTransform transform(plan);
  const auto few = static_cast<int>(plan.direct_pixels);
  for (const int pixels : {1, few, few + 1}) {
    const Image model = model_of(pixels);
    const auto planned = transform.predict(model)->at(block);
    const auto direct = DirectTransform(field, 2).predict(model)->at(block);
    BOOST_TEST((planned == direct) == (pixels <= few));
    BOOST_TEST(relative_error(planned, direct) < 1e-5);
  }
}

BOOST_AUTO_TEST_CASE(a_kernel_or_a_way_that_was_asked_for_is_used) {
  const VisibilityBlock block = random_samples_with_w(3, 2, field.cell_rad, 200, 1);
  const auto is_direct = [&](auto change) {
    GriddingRequest request = request_for(block, 300);
    change(request);
    const GriddingPlan plan = plan_gridding(request);
    return plan.direct || plan.direct_pixels > 0;
  };
  BOOST_TEST(is_direct([](GriddingRequest&) {}));
  BOOST_TEST(!is_direct([](GriddingRequest& r) { r.kernel_width = 9; }));
  BOOST_TEST(!is_direct([](GriddingRequest& r) { r.padding = 2; }));
  BOOST_TEST(!is_direct([](GriddingRequest& r) { r.kernel = misfit::kernels::kernel_family("kaiser-bessel"); }));
  BOOST_TEST(!is_direct([](GriddingRequest& r) { r.gridder = Gridder::wide; }));
  BOOST_TEST(!is_direct([](GriddingRequest& r) { r.gridder = Gridder::standard; }));
  BOOST_TEST(!is_direct([](GriddingRequest& r) { r.accuracy = 0; }));
  BOOST_TEST(!is_direct([](GriddingRequest& r) { r.samples = 0; }));
}

BOOST_AUTO_TEST_CASE(coarser_transforms_are_as_exact_as_they_say_and_there_are_none_where_residuals_are_quick) {
  const VisibilityBlock block = random_samples_with_w(1000, 4, field.cell_rad, 200, 2);
  GriddingRequest request = request_for(block, 300);
  BOOST_TEST(PlannedTransform(plan_gridding(request)).coarser().empty());
  request.samples = 20'000'000;
  const PlannedTransform transform(plan_gridding(request));
  const AdjointResult direct = adjoint_of(DirectTransform(field, 2), block);
  const Image model = model_of(5000);
  const auto predicted = DirectTransform(field, 2).predict(model)->at(block);
  BOOST_TEST_REQUIRE(!transform.coarser().empty());
  double before = 1;
  for (const CoarserTransform& coarser : transform.coarser()) {
    BOOST_TEST(coarser.accuracy < before);
    before = coarser.accuracy;
    BOOST_TEST(relative_error(adjoint_of(*coarser.transform, block).images[0].pixel, direct.images[0].pixel) <= before);
    BOOST_TEST(relative_error(coarser.transform->predict(model)->at(block), predicted) <= before);
  }
  request.padding = 2;
  BOOST_TEST(PlannedTransform(plan_gridding(request)).coarser().empty());
}

BOOST_AUTO_TEST_SUITE_END()
