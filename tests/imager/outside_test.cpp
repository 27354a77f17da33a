#include "imager/outside/outside.h"

#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>

#include "imager/direct/direct_transform.h"
#include "imager/direct/source_sums.h"
#include "imager/noise.h"
#include "imager/outside/alias.h"
#include "imager/outside/wide_search.h"
#include "imager/plan/gridding_plan.h"
#include "tests/imager/comparison.h"
#include "tests/imager/random_samples.h"

namespace bdata = boost::unit_test::data;
using namespace misfit::imager;
using namespace misfit::imager::testing;

namespace {

const ImageGeometry geometry{64, 48, 1e-5, {}};

GriddingPlan plan_with(const ImageGeometry& image, const std::string& kernel, int kernel_width, double padding,
                       double max_abs_w = 0) {
  GriddingRequest r;
  r.geometry = image;
  r.accuracy = 0;
  r.kernel = misfit::kernels::kernel_family(kernel);
  r.kernel_width = kernel_width;
  r.padding = padding;
  r.max_abs_w = max_abs_w;
  r.gridder = max_abs_w > 0 ? Gridder::wide : Gridder::standard;
  r.threads = 2;
  return plan_gridding(r);
}

/// Where a source lies that is this many times the image's width to the east and height to the north of its middle.
DirectionCosines fields_away(double east, double north) {
  return {east * geometry.width * geometry.cell_rad, north * geometry.height * geometry.cell_rad};
}

/// Noise of `noise_jy` in each part of 3000 visibilities that lie closer to the middle the shorter they are, and these sources.
VisibilityBlock observed(const std::vector<Source>& sources, double noise_jy, double max_w = 0) {
  VisibilityBlock block = random_samples_with_w(3000, 1, geometry.cell_rad, max_w, 4);
  for (std::size_t row = 0; row < 3000; ++row) {
    const double shorter = std::pow(static_cast<double>(row + 1) / 3000, 1.5);
    for (std::size_t i = 0; i < 2; ++i) block.uvw_m[3 * row + i] *= shorter;
  }
  const auto exact = predict_sources(sources, block, 2);
  for (std::size_t i = 0; i < exact.size(); ++i)
    block.visibility[i] = std::complex<float>(exact[i]) + static_cast<float>(noise_jy) * block.visibility[i];
  return block;
}

/// The largest pixel of the error of a plan's image.
double largest_error(const GriddingPlan& plan, const VisibilityBlock& block) {
  const auto image_by = [&](const Transform& transform) {
    const auto sum = transform.adjoint(false);
    sum->add(block);
    return sum->finish();
  };
  AdjointResult made = image_by(*make_transform(plan.options));
  subtract(image_by(DirectTransform(plan.options.geometry, 2)).image, made.image);
  return largest_magnitude(made.image) / made.sums.weight;
}

struct Found {
  std::vector<OutsideSource> sources;
  WideField field;
};

Found search(const VisibilityBlock& block, const GriddingPlan& plan) {
  const StoredVisibilities source = stored({block});
  Found found{{}, wide_field(source, plan.options.geometry)};
  StageTimes times;
  const WideSearch wide = search_wide_field(source, found.field, 2, ignore_progress, times);
  found.sources = sources_outside(wide.components, found.field.geometry, plan.options, {wide.least_jy, 0.1});
  return found;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(outside)

BOOST_DATA_TEST_CASE(the_alias_of_a_source_is_as_high_as_it_is_in_the_image,
                     bdata::make({"nearest", "spheroidal-exact", "least-misfit", "kaiser-bessel"}) * bdata::make({1.28, 1.7}) *
                         bdata::make({0.0, 0.3}),
                     name, east, north) {
  const DirectionCosines at = fields_away(east, north);
  const GriddingPlan plan = plan_with(geometry, name, std::string(name) == "nearest" ? 1 : 3, 1.5);
  const double alias = 1000 * alias_level(plan.options, at, 0.1);
  const double measured = largest_error(plan, observed({{at, 1000}}, 0));
  // There are the sidelobes of other copies too, which lie off the image: less than the highest copy upon it.
  BOOST_TEST(alias < 2 * measured);
  BOOST_TEST(alias > measured / 2);
}

BOOST_AUTO_TEST_CASE(a_source_in_the_padding_has_no_alias) {
  const GriddingPlan plan = plan_with(geometry, "nearest", 1, 2);
  BOOST_TEST(alias_level(plan.options, fields_away(0.8, -0.7), 0.1) == 0);
  BOOST_TEST(alias_level(plan.options, fields_away(0.8, -1.3), 0.1) > 0);
}

BOOST_DATA_TEST_CASE(with_a_w_axis_the_alias_is_no_higher_than_said, bdata::make({1.28, -1.75}), east) {
  const ImageGeometry wide{64, 48, 2e-3, {}};
  const DirectionCosines at{east * 64 * 2e-3, 0.1};
  const GriddingPlan plan = plan_with(wide, "linear", 2, 1.5, 100);
  VisibilityBlock block = random_samples_with_w(12000, 1, wide.cell_rad, 100, 6);
  const auto exact = predict_sources({{at, 1000}}, block, 2);
  block.visibility.assign(exact.begin(), exact.end());
  // Sidelobes of other copies come on top, which with so narrow a kernel are lower than the highest copy.
  BOOST_TEST(largest_error(plan, block) < 2 * 1000 * alias_level(plan.options, at, 1));
}

BOOST_AUTO_TEST_CASE(a_strong_source_outside_is_found_with_its_alias) {
  const Source bright{fields_away(1.5, 0.2), 1000}, weak{fields_away(0.1, -0.2), 3};
  const GriddingPlan plan = plan_with(geometry, "nearest", 1, 2);
  const VisibilityBlock block = observed({bright, weak}, 1);
  const Found found = search(block, plan);
  BOOST_REQUIRE(!found.sources.empty());
  const OutsideSource& first = found.sources.front();
  BOOST_TEST(std::abs(first.source.position.l - bright.position.l) < found.field.geometry.cell_rad);
  BOOST_TEST(std::abs(first.source.position.m - bright.position.m) < found.field.geometry.cell_rad);
  BOOST_TEST(first.source.flux_jy == 1000, boost::test_tools::tolerance(0.05));  // components beyond three pixels are missed
  const double measured = largest_error(plan, block);
  BOOST_TEST(first.alias_jy < 2 * measured);
  BOOST_TEST(first.alias_jy > measured / 2);
  for (std::size_t i = 1; i < found.sources.size(); ++i) BOOST_TEST(found.sources[i].source.flux_jy < 10);
}

BOOST_AUTO_TEST_CASE(a_good_kernel_keeps_its_alias_below_the_noise) {
  const GriddingPlan plan = plan_with(geometry, "least-misfit", 9, 2);
  const VisibilityBlock block = observed({{fields_away(1.5, 0.2), 1000}}, 1);
  const Found found = search(block, plan);
  BOOST_REQUIRE(!found.sources.empty());
  BOOST_TEST(found.sources.front().alias_jy < 1 / std::sqrt(3000.0));
}

BOOST_AUTO_TEST_CASE(a_bright_source_inside_is_none_outside) {
  const GriddingPlan plan = plan_with(geometry, "nearest", 1, 2);
  for (const DirectionCosines at : {fields_away(0.21, 0.13), fields_away(0.49, -0.47)})
    BOOST_TEST(search(observed({{at, 1000}}, 1), plan).sources.empty());
}

BOOST_AUTO_TEST_CASE(noise_alone_has_no_sources) {
  BOOST_TEST(search(observed({}, 1), plan_with(geometry, "nearest", 1, 2)).sources.empty());
}

BOOST_AUTO_TEST_CASE(a_field_without_short_baselines_is_imaged_as_finely_as_they_need) {
  VisibilityBlock block = random_samples(500, 1, geometry.cell_rad, 5);
  BOOST_TEST(wide_field(stored({block}), geometry).geometry.cell_rad == geometry.cell_rad);
  for (double& coordinate : block.uvw_m) coordinate /= 16;
  const WideField field = wide_field(stored({block}), geometry);
  BOOST_TEST(field.geometry.cell_rad == 4 * geometry.cell_rad);
  BOOST_TEST(field.geometry.width == geometry.width);
  BOOST_TEST(field.geometry.height == geometry.height);
}

BOOST_AUTO_TEST_SUITE_END()
