#include "imager/streaming/streamed_visibilities.h"

#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>

#include "imager/plan/gridding_plan.h"
#include "imager/transform/imaging.h"
#include "tests/imager/comparison.h"
#include "tests/imager/random_samples.h"

BOOST_AUTO_TEST_SUITE(streamed_visibilities)

namespace bdata = boost::unit_test::data;
using namespace misfit::imager;
using namespace misfit::imager::testing;

namespace {

/// Stored blocks that count how often they are opened.
class Counted : public VisibilitySource {
 public:
  explicit Counted(const std::vector<VisibilityBlock>& blocks) : blocks_(stored(blocks)) {}
  std::unique_ptr<BlockStream> open() const override {
    ++opened;
    return blocks_.open();
  }
  std::uint64_t samples() const override { return blocks_.samples(); }

  mutable int opened = 0;

 private:
  StoredVisibilities blocks_;
};

std::vector<VisibilityBlock> blocks() {
  std::vector<VisibilityBlock> made;
  for (unsigned seed = 1; seed < 5; ++seed) {
    made.push_back(random_samples_with_w(10 * seed, 3, 1e-5, 50, seed));
    made.back().counts.used = made.back().counts.samples_read = made.back().samples();
  }
  made[1].counts.flagged = std::exchange(made[1].counts.used, 0);
  made[1].weight.assign(made[1].samples(), 0);
  return made;
}

std::vector<float> weights_of_a_pass(const VisibilitySource& source) {
  std::vector<float> weights;
  const auto stream = source.open();
  while (const auto block = stream->next()) weights.insert(weights.end(), block->weight.begin(), block->weight.end());
  return weights;
}

}  // namespace

BOOST_DATA_TEST_CASE(every_pass_hands_out_what_the_source_does, bdata::make({false, true}) * bdata::make({0, 2}), keep, ahead) {
  const Counted source(blocks());
  const StreamedVisibilities streamed(source, {keep, static_cast<std::size_t>(ahead)});
  BOOST_TEST(streamed.samples() == source.samples());
  const std::vector<float> expected = weights_of_a_pass(source);
  source.opened = 0;
  for (int pass = 0; pass < 3; ++pass) BOOST_CHECK(weights_of_a_pass(streamed) == expected);
  BOOST_TEST(source.opened == (keep ? 1 : 3));
}

BOOST_AUTO_TEST_CASE(a_full_pass_tells_what_was_in_it) {
  const Counted source(blocks());
  SampleCounts counts;
  WSpread spread;
  UvCoverage coverage(1e5);
  for (const VisibilityBlock& block : blocks()) {
    counts += block.counts;
    spread.add(block);
    coverage.add(block);
  }
  const StreamedVisibilities streamed(source, {.uv_reach_lambda = coverage.reach_lambda()});
  streamed.open()->next();  // a pass that is broken off tells nothing
  BOOST_TEST(streamed.counts().used == 0U);
  for (int pass = 0; pass < 2; ++pass) {
    weights_of_a_pass(streamed);
    BOOST_TEST(streamed.counts().used == counts.used);
    BOOST_TEST(streamed.counts().flagged == counts.flagged);
    BOOST_TEST(streamed.w_spread().weight == spread.weight);
    BOOST_TEST(streamed.w_spread().weighted_w_square == spread.weighted_w_square);
    BOOST_CHECK(streamed.uv_coverage().counts() == coverage.counts());
  }
  BOOST_TEST(source.opened == 2);
}

BOOST_AUTO_TEST_CASE(images_have_the_same_bits_however_the_visibilities_come) {
  GriddingRequest request;
  request.geometry = {40, 30, 1e-5, {}};
  request.threads = 2;
  const auto transform = make_coplanar_transform(plan_gridding(request).options);
  const Counted source(blocks());
  const Image model = random_image(40, 30, 1);
  const DirtyImages plain = make_dirty_images(source, *transform, {.with_psf = true}, {});
  const Image residual = make_residual_image({source, *transform, plain.normalisation}, model, {});
  for (const StreamingOptions& options : {StreamingOptions{true, 2}, {true, 0}, {false, 0}, {false, 1}, {false, 2}}) {
    const StreamedVisibilities streamed(source, options);
    const DirtyImages images = make_dirty_images(streamed, *transform, {.with_psf = true}, {});
    BOOST_CHECK(images.dirty[0].pixel == plain.dirty[0].pixel);
    BOOST_CHECK(images.psf.pixel == plain.psf.pixel);
    BOOST_CHECK(make_residual_image({streamed, *transform, plain.normalisation}, model, {}).pixel == residual.pixel);
  }
}

BOOST_AUTO_TEST_CASE(a_pass_without_usable_samples_is_an_error_that_counts_the_reasons) {
  VisibilityBlock block = random_samples(5, 2, 1e-5, 1);
  block.counts.samples_read = 10;
  block.counts.autocorrelations = 1;
  block.counts.flagged = 2;
  block.counts.nonfinite = 3;
  block.counts.zero_weight = 4;
  const Counted source({block});
  const StreamedVisibilities streamed(source, {});
  BOOST_CHECK_EXCEPTION(weights_of_a_pass(streamed), NothingUsable, [](const std::exception& error) {
    return std::string(error.what()) ==
           "none of 10 visibilities can be used: 1 auto-correlations, 2 flagged, 3 not finite, 4 of zero weight; "
           "expected at least one";
  });
}

BOOST_AUTO_TEST_SUITE_END()
