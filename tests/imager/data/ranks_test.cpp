// What ranks make together is what one makes alone: sums of the same terms in another order.
#include "imager/data/ranks.h"

#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>
#include <mutex>

#include "imager/clean/clean.h"
#include "imager/clean/joint_clean.h"
#include "imager/clean/shared_model.h"
#include "imager/direct/verify.h"
#include "imager/outside/wide_search.h"
#include "imager/plan/accurate_imaging.h"
#include "imager/streaming/streamed_visibilities.h"
#include "imager/streaming/weight_shares.h"
#include "imager/taylor/taylor_imaging.h"
#include "tests/imager/comparison.h"
#include "tests/imager/several_stokes.h"
#include "tests/imager/taylor/wide_band.h"
#include "tests/imager/thread_ranks.h"

BOOST_AUTO_TEST_SUITE(ranks)

namespace bdata = boost::unit_test::data;
using namespace misfit::imager;
using namespace misfit::imager::testing;

namespace {

constexpr double arcsec = pi / 180 / 3600;
const ImageGeometry geometry{48, 40, 1e-5, {}};

/// With fewer rows than there are ranks in the last block, and a flagged sample.
std::vector<VisibilityBlock> blocks(double max_w = 0) {
  std::vector<VisibilityBlock> made;
  for (const std::size_t rows : {60, 90, 3})
    made.push_back(random_samples_with_w(rows, 3, geometry.cell_rad, max_w, static_cast<unsigned>(rows)));
  made[1].weight[17] = 0;
  for (VisibilityBlock& block : made) count(block);
  return made;
}

GriddingPlan plan_of(const ImageGeometry& image, double accuracy, double max_w = 0) {
  GriddingRequest request;
  request.geometry = image;
  request.accuracy = request.psf_accuracy = accuracy;
  request.max_abs_w = max_w;
  request.samples = 10000000;  // so that it grids
  request.threads = 2;
  return plan_gridding(request);
}

using Values = std::vector<double>;

void append(Values& values, const std::vector<double>& more) {
  values.insert(values.end(), more.begin(), more.end());
}

/// For any rank: Boost.Test is for one thread at a time.
void check(bool holds, const std::string& what) {
  static std::mutex one_at_a_time;
  const std::lock_guard lock(one_at_a_time);
  BOOST_TEST(holds, what);
}

/// Compares what `run` returns at rank 0 with what it returns for one who has all samples, relative to its norm.
void check_alike(const std::vector<VisibilityBlock>& all, double tolerance,
                 const std::function<Values(const VisibilitySource&)>& run) {
  const Values should = run(stored(all));
  for (const int size : {1, 2, 3, 8}) {
    Values is;
    ThreadRanks(size).run([&](const Ranks& ranks) {
      const Values mine = run(RankShare(all, ranks));
      if (ranks.first()) is = mine;
    });
    BOOST_TEST_CONTEXT(size << " ranks") {
      BOOST_REQUIRE_EQUAL(is.size(), should.size());
      BOOST_TEST(relative_error(is, should) <= tolerance);
    }
  }
}

/// Sums of some hundred terms in two orders, in double precision.
constexpr double reordered = 1e-13;

}  // namespace

BOOST_DATA_TEST_CASE(images_and_sums_are_those_of_all_samples, bdata::make({0.0, 3000.0}) * bdata::make({1e-4, 1e-9}), max_w,
                     accuracy) {
  const PlannedTransform transform(plan_of(geometry, accuracy, max_w));
  // Grids of 1e-4 are single.
  check_alike(blocks(max_w), accuracy < 1e-7 ? reordered : 1e-6, [&](const VisibilitySource& source) {
    const DirtyImages made = make_dirty_images(source, transform, {.with_psf = true}, {});
    const SampleSums& sums = made.sums.front();
    Values values = made.dirty.front().pixel;
    append(values, made.psf.pixel);
    append(values, {made.dirty_statistics.front().root_mean_square(), made.psf_statistics.largest_magnitude(), sums.weight,
                    sums.weight_abs, sums.weight_square, sums.weight2_square, static_cast<double>(sums.used)});
    check(made.dirty.front().pixel.empty() == !source.ranks().first(), "images are at rank 0 alone");
    return values;
  });
}

BOOST_AUTO_TEST_CASE(every_rank_is_told_the_same_of_images_that_it_has_not) {
  const PlannedTransform transform(plan_of(geometry, 1e-6));
  std::vector<double> rms(4), weight(4);
  ThreadRanks(4).run([&](const Ranks& ranks) {
    const auto at = static_cast<std::size_t>(ranks.rank());
    const DirtyImages made = make_dirty_images(RankShare(blocks(), ranks), transform, {.with_psf = true}, {});
    rms[at] = made.dirty_statistics.front().root_mean_square();
    weight[at] = made.sums.front().weight;
  });
  BOOST_TEST(rms == std::vector<double>(4, rms.front()), boost::test_tools::per_element());
  BOOST_TEST(weight == std::vector<double>(4, weight.front()), boost::test_tools::per_element());
}

BOOST_DATA_TEST_CASE(residuals_are_those_of_all_samples, bdata::make({0.0, 3000.0}), max_w) {
  const PlannedTransform transform(plan_of(geometry, 1e-9, max_w));
  const Image model = random_image(geometry.width, geometry.height, 3);
  check_alike(blocks(max_w), reordered, [&](const VisibilitySource& source) {
    const Normalisation normalisation = make_dirty_images(source, transform, AdjointOptions{}, {}).normalisation;
    return make_residual_image({source, transform, normalisation}, model, {}).pixel;
  });
}

BOOST_TEST_DECORATOR(*boost::unit_test::label("sweep"))
BOOST_DATA_TEST_CASE(weights_follow_from_the_density_of_all_samples, bdata::make({0, 1, 2, 3}) * bdata::make({false, true}),
                     which, keep) {
  constexpr Weighting ways[] = {Weighting::natural, Weighting::uniform, Weighting::superuniform, Weighting::briggs};
  const PlannedTransform transform(plan_of(geometry, 1e-9));
  const WeightingOptions options{.weighting = ways[which],
                                 .rank_filter = RankFilter{2, 3},
                                 .taper = UvTaper{1e-10, 2e-10, 0.3},
                                 .window = {1e3, 45e3, 2e3, 5e3}};
  // Weights are single: sums in another order may round some of them otherwise.
  check_alike(blocks(), 1e-6, [&, keep = keep](const VisibilitySource& source) {
    StreamedVisibilities streamed(source, {.keep = keep, .ahead = 1, .uv_reach_lambda = 5e4});
    streamed.apply(make_imaging_weights(streamed, options, geometry, {2}), 2);
    const DirtyImages made = make_dirty_images(streamed, transform, {.with_psf = true}, {});
    Values values = made.psf.pixel;
    append(values, {streamed.weight_sums().noise_jy(), static_cast<double>(streamed.counts().used),
                    static_cast<double>(streamed.counts().flagged)});
    const std::vector<std::uint64_t> coverage = streamed.uv_coverage().counts();
    for (const std::uint64_t count : coverage) values.push_back(static_cast<double>(count));
    values.push_back(streamed.w_spread().weight);
    return values;
  });
}

BOOST_AUTO_TEST_CASE(a_second_pass_is_made_by_all) {
  // Every sample twice, the second time with nearly the opposite visibility.
  std::vector<VisibilityBlock> weak = blocks();
  VisibilityBlock opposite = weak[1];
  for (auto& visibility : opposite.visibility) visibility *= -0.9999F;
  weak = {weak[1], opposite};
  check_alike(weak, 1e-9, [&](const VisibilitySource& source) {
    const AccurateImages made = make_accurate_images(source, plan_of(geometry, 1e-6), {});
    check(made.plan.decisions.back().item == "second pass", "there was a second pass");
    Values values = made.images.dirty.front().pixel;
    append(values, made.images.psf.pixel);
    return values;
  });
}

BOOST_AUTO_TEST_CASE(samples_that_nobody_can_use_are_counted_over_all_ranks) {
  std::vector<VisibilityBlock> flagged = blocks();
  for (VisibilityBlock& block : flagged) {
    block.weight.assign(block.samples(), 0);
    count(block);
  }
  const PlannedTransform transform(plan_of(geometry, 1e-6));
  ThreadRanks three(3);
  BOOST_CHECK_EXCEPTION(three.run([&](const Ranks& ranks) {
    const RankShare share(flagged, ranks);
    const StreamedVisibilities streamed(share, {});
    make_dirty_images(streamed, transform, {.with_psf = true}, {});
  }),
                        NothingUsable, [](const NothingUsable& error) {
                          return std::string(error.what()).find("none of 459 visibilities can be used: 459 flagged") !=
                                 std::string::npos;
                        });
}

BOOST_AUTO_TEST_CASE(measured_errors_are_those_of_all_samples) {
  GriddingPlan rough = plan_of(geometry, 1e-3);
  const PlannedTransform transform(rough);
  // Grids are single: an error of some 1e-4 changes by 1e-7 of the image.
  check_alike(blocks(), 2e-3, [&](const VisibilitySource& source) {
    const DirtyImages made = make_dirty_images(source, transform, {.with_psf = true}, {});
    const MeasuredError error = measure_error(source, transform, geometry, made, 100, {2});
    // That of other samples, as ranks choose them.
    check(error.predict_rms > 1e-5 && error.predict_rms < 1e-3, "the error of prediction is that of the kernel");
    check(error.image.size() == 1, "every rank knows the error of the image");
    return Values{error.image.front().rms, error.image.front().max};
  });
}

BOOST_AUTO_TEST_CASE(shares_of_weights_are_those_of_all_samples) {
  check_alike(blocks(), reordered, [](const VisibilitySource& source) {
    Values values;
    for (const WeightShare& share : misfit::imager::weight_shares(source, {geometry.cell_rad, {}, 1}))
      append(values, {share.frequency_hz, share.weight});
    return values;
  });
}

BOOST_DATA_TEST_CASE(clean_finds_the_same_components, bdata::make({0.0, 3000.0}), max_w) {
  std::vector<VisibilityBlock> seen = blocks(max_w);
  for (VisibilityBlock& block : seen) {
    const auto exact = predict_sources({{geometry.at(10, 30), 1}, {geometry.at(25, 12), 0.4}}, block, 2);
    block.visibility.assign(exact.begin(), exact.end());
  }
  const PlannedTransform transform(plan_of(geometry, 1e-9, max_w));
  check_alike(seen, 1e-9, [&](const VisibilitySource& source) {
    const DirtyImages made = make_dirty_images(source, transform, {.with_psf = true}, {});
    const ImagedData imaged{source, transform, made.normalisation};
    if (!source.ranks().first()) {
      follow_clean(imaged, {}, {}, {2});
      return Values();
    }
    CleanOptions options;
    options.max_iterations = 300;
    options.max_major_cycles = 4;
    const CleanInput input{.imaged = imaged, .dirty = made.dirty, .psf = {&made.psf}, .max_sidelobe = 0.3, .accuracy = 1e-9};
    const JointClean minor({&made.psf}, {.threads = 2});
    const CleanResult result = misfit::imager::clean(
        input, minor, options, first_state(ComponentModel(geometry.width, geometry.height, {0})), [](const CleanState&) {}, {});
    Values values = result.residual.pixel;
    append(values, result.model.pixel);
    append(values, {static_cast<double>(result.report.iterations), static_cast<double>(result.report.stop),
                    static_cast<double>(result.report.cycles.size())});
    return values;
  });
}

BOOST_TEST_DECORATOR(*boost::unit_test::label("sweep"))
BOOST_AUTO_TEST_CASE(clean_of_taylor_terms_finds_the_same_components) {
  const ImageGeometry image{48, 40, 0.16 * arcsec, {}};
  const TaylorExpansion expansion{4e9, 2};
  VisibilityBlock block = wide_band_samples(2, 4, 0.5);
  observe({{image.at(10, 30), power_law(1, -0.7, 4e9)}, {image.at(25, 12), power_law(0.5, 0, 4e9)}}, 0, 1, block);
  const PlannedTransform transform(plan_of(image, 1e-9));
  check_alike({block}, 1e-9, [&](const VisibilitySource& source) {
    const DirtyImages first = make_dirty_images(source, transform, {.with_psf = true}, {});
    const ImagedData imaged{source, transform, first.normalisation};
    const TaylorImages further = make_taylor_images(imaged, transform, expansion, {});
    if (!source.ranks().first()) {
      follow_clean(imaged, {}, expansion, {2});
      return Values();
    }
    std::vector<const Image*> psf{&first.psf};
    for (const Image& other : further.psf) psf.push_back(&other);
    CleanOptions options;
    options.max_iterations = 200;
    options.max_major_cycles = 3;
    const CleanInput input{.imaged = imaged,
                           .expansion = expansion,
                           .dirty = {first.dirty.front(), further.dirty.front()},
                           .psf = psf,
                           .max_sidelobe = 0.3,
                           .accuracy = 1e-9};
    const JointClean minor(psf, {.threads = 2});
    const CleanResult result = misfit::imager::clean(
        input, minor, options, first_state(ComponentModel(image.width, image.height, {0})), [](const CleanState&) {}, {});
    Values values = result.residual.pixel;
    append(values, result.model.pixel);
    append(values, result.further_models.front().pixel);
    append(values, {static_cast<double>(result.report.iterations)});
    return values;
  });
}

BOOST_TEST_DECORATOR(*boost::unit_test::label("sweep"))
BOOST_AUTO_TEST_CASE(sources_outside_are_found_in_the_samples_of_all) {
  std::vector<VisibilityBlock> seen{random_samples(3000, 1, geometry.cell_rad, 4)};
  for (std::size_t row = 0; row < seen.front().rows(); ++row)
    for (std::size_t i = 0; i < 2; ++i)
      seen.front().uvw_m.edit()[3 * row + i] *= std::pow(static_cast<double>(row + 1) / 3000, 1.5);
  const DirectionCosines at{1.2 * geometry.width * geometry.cell_rad, 0};
  const auto exact = predict_sources({{at, 5}}, seen.front(), 2);
  seen.front().visibility.assign(exact.begin(), exact.end());
  check_alike(seen, 1e-5, [&](const VisibilitySource& source) {
    WideFieldFinder finder(geometry);
    const auto stream = source.open();
    while (const auto block = stream->next()) finder.add(*block);
    finder.add_up(source.ranks());
    const WideField field = finder.field();
    GriddingRequest request;
    request.geometry = geometry;
    request.samples = 3000;
    request.threads = 2;
    const WideSearch search = search_wide_field(source, plan_wide_field(field, request), {});
    Values values{static_cast<double>(field.geometry.width), field.geometry.cell_rad / geometry.cell_rad, field.reaching};
    check(can_be_imaged(field.geometry, source), "there is a sample to image from");
    if (!source.ranks().first()) return values;
    Image model(field.geometry.width, field.geometry.height);
    for (const Component& c : search.components) model.at(c.row, c.column) += c.flux_jy;
    append(values, model.pixel);
    return values;
  });
}

BOOST_AUTO_TEST_CASE(what_has_more_pieces_than_there_are_ranks_passes_along_them) {
  for (const int ranks : {2, 3, 8, 100, 5000}) {
    BOOST_TEST(pass_along_ranks(ranks, static_cast<std::size_t>(ranks) * chain_piece));
    BOOST_TEST(!pass_along_ranks(ranks, chain_piece / 2) == (ranks > 3));
  }
}

BOOST_AUTO_TEST_SUITE_END()
