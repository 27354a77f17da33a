#include "imager/taylor/taylor_prediction.h"

#include <boost/test/unit_test.hpp>

#include "imager/direct/direct_transform.h"
#include "imager/plan/gridding_plan.h"
#include "tests/imager/comparison.h"
#include "tests/imager/random_samples.h"

BOOST_AUTO_TEST_SUITE(taylor_prediction)

using namespace misfit::imager;
using namespace misfit::imager::testing;

namespace {

const ImageGeometry geometry{18, 12, 1e-4, {}};
constexpr double reference_hz = 1.1e9;

std::vector<Image> models(int terms) {
  std::vector<Image> result;
  for (int t = 0; t < terms; ++t)
    result.push_back(random_image(geometry.width, geometry.height, 40 + static_cast<unsigned>(t)));
  return result;
}

VisibilityBlock samples() {
  return random_samples(60, 5, geometry.cell_rad, 3);
}

std::unique_ptr<Transform> gridding() {
  GriddingRequest request;
  request.geometry = geometry;
  request.accuracy = 1e-6;
  return make_coplanar_transform(plan_gridding(request).options);
}

}  // namespace

BOOST_AUTO_TEST_CASE(it_is_the_sum_of_the_terms_predictions_times_powers_of_x) {
  const DirectTransform transform({geometry, true, 1});
  const VisibilityBlock block = samples();
  for (const int terms : {1, 2, 3}) {
    const std::vector<Image> of = models(terms);
    const TaylorPrediction prediction(transform, of, {reference_hz, terms});
    std::vector<std::complex<double>> sum(block.samples());
    for (int t = 0; t < terms; ++t) {
      const auto one = transform.predict(of[static_cast<std::size_t>(t)])->at(block);
      for (std::size_t i = 0; i < sum.size(); ++i)
        sum[i] += std::pow(block.frequency_hz[i % block.channels()] / reference_hz - 1, t) * one[i];
    }
    // Rounding of doubles in another order.
    BOOST_TEST(relative_error(prediction.at(block), sum) < 1e-14);
    BOOST_TEST(relative_error(prediction.at_usable(block), sum) < 1e-14);
    BOOST_TEST((prediction.at_usable_of({&block, &block}).back() == prediction.at_usable(block)));
  }
}

/// ⟨Σ_t x^t A I_t, V⟩ = Σ_t ⟨I_t, A*(x^t V)⟩ with weights, to rounding: by direct sums and by gridding alike.
BOOST_AUTO_TEST_CASE(it_is_the_adjoint_of_imaging_taylor_weighted_visibilities) {
  constexpr int terms = 3;
  const TaylorExpansion expansion{reference_hz, terms};
  const VisibilityBlock block = samples();
  const std::vector<std::complex<double>> visibility(block.visibility.begin(), block.visibility.end());
  const std::vector<Image> of = models(terms);
  for (const std::shared_ptr<Transform>& transform :
       {std::shared_ptr<Transform>(std::make_shared<DirectTransform>(DirectSums{geometry, true, 1})),
        std::shared_ptr<Transform>(gridding())}) {
    const auto predicted = TaylorPrediction(*transform, of, expansion).at_usable(block);
    double in_data = 0, size = 0;
    for (std::size_t i = 0; i < predicted.size(); ++i) {
      in_data += double{block.weight[i]} * (predicted[i] * std::conj(visibility[i])).real();
      size += double{block.weight[i]} * std::abs(predicted[i]) * std::abs(visibility[i]);
    }
    auto sum = transform->adjoint({.images = terms});
    sum->add(block, taylor_sets(expansion, block, visibility, {0, terms - 1}));
    const AdjointResult images = sum->finish();
    double in_images = 0;
    for (std::size_t t = 0; t < of.size(); ++t)
      for (std::size_t i = 0; i < of[t].pixel.size(); ++i) in_images += of[t].pixel[i] * images.images[t].pixel[i];
    // Grids are of single precision at this accuracy: each sample rounds at 1e-7 or so.
    BOOST_TEST(std::abs(in_data - in_images) < 1e-6 * size);
  }
}

BOOST_AUTO_TEST_CASE(sets_are_visibilities_times_powers_of_x) {
  const VisibilityBlock block = samples();
  const std::vector<std::complex<double>> visibility(block.visibility.begin(), block.visibility.end());
  const auto sets = taylor_sets({reference_hz, 3}, block, visibility, {1, 4});
  BOOST_REQUIRE(sets.size() == 4U);
  for (std::size_t k = 1; k <= 4; ++k)
    for (std::size_t i = 0; i < visibility.size(); ++i) {
      const double power = std::pow(block.frequency_hz[i % block.channels()] / reference_hz - 1, double(k));
      BOOST_REQUIRE(std::abs(sets[k - 1][i] - power * visibility[i]) <= 1e-14 * std::abs(visibility[i]));
    }
}

BOOST_AUTO_TEST_CASE(a_model_is_needed_for_each_term) {
  const DirectTransform transform({geometry, true, 1});
  const std::vector<Image> of = models(2);
  BOOST_CHECK_THROW(TaylorPrediction(transform, of, {reference_hz, 3}), std::invalid_argument);
}

/// As many sets of visibilities as images.
BOOST_AUTO_TEST_CASE(an_adjoint_refuses_other_numbers_of_sets_than_of_images) {
  const VisibilityBlock block = samples();
  auto sum = gridding()->adjoint({.images = 2});
  const std::vector<std::complex<double>> visibility(block.samples(), 1);
  BOOST_CHECK_THROW(sum->add(block, taylor_sets({reference_hz, 3}, block, visibility, {0, 2})), std::invalid_argument);
}

BOOST_AUTO_TEST_SUITE_END()
