#include "imager/outside/outside.h"

#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>

#include "imager/data/noise.h"
#include "imager/direct/direct_transform.h"
#include "imager/direct/source_sums.h"
#include "imager/outside/alias.h"
#include "imager/outside/wide_search.h"
#include "imager/plan/gridding_plan.h"
#include "tests/imager/comparison.h"
#include "tests/imager/random_samples.h"

BOOST_AUTO_TEST_SUITE(outside)

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
    for (std::size_t i = 0; i < 2; ++i) block.uvw_m.edit()[3 * row + i] *= shorter;
  }
  const auto exact = predict_sources(sources, block, 2);
  for (std::size_t i = 0; i < exact.size(); ++i)
    block.visibility[i] = std::complex<float>(exact[i]) + static_cast<float>(noise_jy) * block.visibility[i];
  return block;
}

/// The largest pixel of the error of a plan's image.
double largest_error(const GriddingPlan& plan, const VisibilityBlock& block) {
  const auto image_by = [&](const Transform& transform) {
    const auto sum = transform.adjoint({});
    sum->add(block);
    return sum->finish();
  };
  AdjointResult made = image_by(*make_transform(plan.options));
  subtract(image_by(DirectTransform(plan.options.geometry, 2)).images[0], made.images[0]);
  return largest_magnitude(made.images[0]) / made.sums[0].weight;
}

WideField wide_field(const SampleCoordinates& samples) {
  WideFieldFinder finder(geometry);
  finder.add(samples);
  return finder.field();
}

struct Found {
  std::vector<OutsideSource> sources;
  WideField field;
  Unexplained unexplained;
};

Found search(const VisibilityBlock& block, const GriddingPlan& plan) {
  const StoredVisibilities source = stored({block});
  Found found{{}, wide_field(block), {}};
  GriddingRequest request = plan.request;
  request.samples = block.samples();
  const WideSearch wide = search_wide_field(source, plan_wide_field(found.field, request), {});
  const AliasLevels aliases(plan, found.field.geometry, wide.sidelobes);
  found.sources = sources_outside(wide.components, found.field.geometry, plan.options.geometry, aliases, wide.least_jy);
  found.unexplained = wide.unexplained;
  return found;
}

/// What is said of a source of 1000 Jy, beside what is measured.
struct Levels {
  double said = 0;
  double measured = 0;
};

Levels levels_of(const GriddingPlan& plan, const VisibilityBlock& block, DirectionCosines at) {
  const auto transform = make_transform(plan.options);
  const auto sum = transform->adjoint({.with_psf = true});
  sum->add(block);
  AdjointResult made = sum->finish();
  for (double& pixel : made.psf.pixel) pixel /= made.sums[0].weight;
  const ImageGeometry& g = plan.options.geometry;
  const ImageGeometry exactly{4000 * g.width, 4000 * g.height, 1e-3 * g.cell_rad, {}};  // the place is known
  return {1000 * AliasLevels(plan, exactly, Sidelobes(made.psf)).of(at), largest_error(plan, block)};
}

GriddingPlan plan_of_way(const std::string& kernel, double padding, const ImageGeometry& image = geometry,
                         double max_abs_w = 0) {
  const std::size_t space = kernel.find(' ');
  return plan_with(image, kernel.substr(0, space), std::stoi(kernel.substr(space)), padding, max_abs_w);
}

}  // namespace

/// Sources whose copies fall upon the image, beside it along one axis or both, and sources within the padding.
BOOST_TEST_DECORATOR(*boost::unit_test::label("sweep"))
BOOST_DATA_TEST_CASE(the_level_said_of_a_source_holds_against_direct_sums,
                     bdata::make({"nearest 1", "spheroidal-exact 6", "least-misfit 3", "least-misfit 7"}) *
                         bdata::make({1.2, 1.5, 2.0}) * bdata::make({-1.56, -0.52, -0.7, 0.94, 1.28}) *
                         bdata::make({0.0, -0.94, 1.55}),
                     kernel, padding, east, north) {
  const DirectionCosines at = fields_away(east, north);
  const Levels levels = levels_of(plan_of_way(kernel, padding), observed({{at, 1000}}, 0), at);
  // For the factor of two see AliasLevels: it takes four equal copies whose highest sidelobes meet upon one pixel.
  BOOST_TEST(levels.said > levels.measured / 2);
  // The highest sidelobe at a distance or beyond need not lie upon the image: with 3000 random samples sidelobes reach 4 σ,
  // and in the part of the image that counts, its edge or a corner, perhaps 2; so do the largest heights there.
  BOOST_TEST(levels.said < 8 * levels.measured);
}

BOOST_DATA_TEST_CASE(a_copy_upon_the_image_is_as_high_as_said, bdata::make({0.0, 0.3}), north) {
  const DirectionCosines at = fields_away(1.28, north);
  const Levels levels = levels_of(plan_of_way("nearest 1", 1.5), observed({{at, 1000}}, 0), at);
  BOOST_TEST(levels.said < 1.5 * levels.measured);  // it is a point, on which sidelobes of a tenth come in squares
}

BOOST_AUTO_TEST_CASE(of_a_source_in_the_padding_only_sidelobes_are_wrong) {
  const GriddingPlan plan = plan_of_way("nearest 1", 2);
  const ImageGeometry field{4 * geometry.width, 4 * geometry.height, geometry.cell_rad, {}};
  Image point(geometry.width, geometry.height);
  point.at(geometry.height / 2, geometry.width / 2) = 1;
  const AliasLevels without_sidelobes(plan, field, Sidelobes(point));
  BOOST_TEST(without_sidelobes.of(fields_away(0.8, -0.7)) == 0);
  BOOST_TEST(without_sidelobes.of(fields_away(0.3, -1.7)) > 0.01);
}

BOOST_DATA_TEST_CASE(with_a_w_axis_the_alias_is_no_higher_than_said,
                     bdata::make({"linear 2", "least-misfit 4"}) * bdata::make({1.28, -1.75, 0.56}), kernel, east) {
  const ImageGeometry wide{64, 48, 2e-3, {}};
  const DirectionCosines at{east * 64 * 2e-3, 0.1};
  const GriddingPlan plan = plan_of_way(kernel, 1.5, wide, 100);
  VisibilityBlock block = random_samples_with_w(12000, 1, wide.cell_rad, 100, 6);
  const auto exact = predict_sources({{at, 1000}}, block, 2);
  block.visibility.assign(exact.begin(), exact.end());
  const Levels levels = levels_of(plan, block, at);
  BOOST_TEST(levels.said > levels.measured / 2);
}

/// They reach 0.008 rad in the image's corners, and 0.8; at the source eight times that.
BOOST_DATA_TEST_CASE(phases_of_w_that_are_left_out_count_in_the_level,
                     bdata::make({0.6, 1.28, -1.75}) * bdata::make({10.0, 100.0}), east, max_w) {
  const ImageGeometry wide{64, 48, 4e-4, {}};
  const DirectionCosines at{east * 64 * 4e-4, 0.01};
  GriddingRequest request = plan_of_way("least-misfit 7", 2, wide, max_w).request;
  request.gridder = Gridder::standard;
  VisibilityBlock block = random_samples_with_w(3000, 1, wide.cell_rad, max_w, 6);
  const auto exact = predict_sources({{at, 1000}}, block, 2);
  block.visibility.assign(exact.begin(), exact.end());
  const Levels levels = levels_of(plan_gridding(request), block, at);
  BOOST_TEST(levels.said > levels.measured / 2);
  BOOST_TEST(levels.said < 20 * levels.measured);
}

BOOST_DATA_TEST_CASE(rounding_counts_in_the_level, bdata::make({0.53, 1.28}) * bdata::make({0.0, 1.7}), east, north) {
  GriddingRequest request = plan_of_way("least-misfit 10", 2).request;
  request.precision = Precision::single_precision;
  const DirectionCosines at = fields_away(east, north);
  const Levels levels = levels_of(plan_gridding(request), observed({{at, 1000}}, 0), at);
  BOOST_TEST(levels.said > levels.measured / 2);
}

BOOST_AUTO_TEST_CASE(tables_count_in_the_level) {
  GriddingRequest request = plan_of_way("least-misfit 7", 2).request;
  request.lookup = misfit::kernels::TableOptions{100, misfit::kernels::Interpolation::nearest};
  const DirectionCosines at = fields_away(1.28, 0.3);
  const Levels levels = levels_of(plan_gridding(request), observed({{at, 1000}}, 0), at);
  BOOST_TEST(levels.said > levels.measured / 2);
}

BOOST_AUTO_TEST_CASE(sidelobes_are_the_highest_from_a_distance_on) {
  Image psf(40, 60);
  psf.at(30, 20) = 1;
  psf.at(30, 23) = -0.3;
  psf.at(35, 19) = 0.2;
  psf.at(0, 0) = 0.1;
  const Sidelobes sidelobes(psf);
  BOOST_TEST(sidelobes.from(0.9) == 1);
  BOOST_TEST(sidelobes.from(1) == 0.3);
  BOOST_TEST(sidelobes.from(3.5) == 0.3);
  BOOST_TEST(sidelobes.from(4) == 0.2);
  BOOST_TEST(sidelobes.from(6) == 0.1);
  BOOST_TEST(sidelobes.from(1e9) == 0.1);
  BOOST_TEST(sidelobes.far() == 0.1);
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

BOOST_AUTO_TEST_CASE(a_source_at_the_border_of_the_field_is_marked) {
  const std::vector<Component> components{{0, 3, 30, 5}, {0, 30, 50, 4}, {0, 10, 10, 0.6}, {0, 32, 33, 7}};
  const ImageGeometry wide{64, 64, 4 * geometry.cell_rad, {}};
  const AliasLevels aliases(plan_with(geometry, "nearest", 1, 2), wide, Sidelobes(Image(8, 8)));
  const auto sources = sources_outside(components, wide, geometry, aliases, 1);
  BOOST_REQUIRE(sources.size() == 2U);
  for (const OutsideSource& s : sources) BOOST_TEST(s.at_border == (s.source.flux_jy == 5));
}

BOOST_AUTO_TEST_CASE(components_of_either_sign_about_the_brightest_are_one_source_of_its_sign) {
  const std::vector<Component> components{{0, 10, 10, -6}, {0, 11, 10, -2}, {0, 12, 11, 1}, {0, 30, 50, 0.5}};
  const ImageGeometry wide{64, 64, 4 * geometry.cell_rad, {}};
  Image psf(8, 8);
  psf.at(0, 0) = 0.1;
  const AliasLevels aliases(plan_with(geometry, "nearest", 1, 2), wide, Sidelobes(psf));
  const auto sources = sources_outside(components, wide, geometry, aliases, 1);
  BOOST_REQUIRE(sources.size() == 1U);
  BOOST_TEST(sources.front().source.flux_jy == -7);
  BOOST_TEST(sources.front().alias_jy > 0);
  BOOST_TEST(sources.front().source.position.l == wide.l(10));
  BOOST_TEST(sources.front().source.position.m == 0.75 * wide.m(10) + 0.25 * wide.m(11), boost::test_tools::tolerance(1e-12));
}

/// Pixels of the wider field are four of the image's.
BOOST_TEST_DECORATOR(*boost::unit_test::label("sweep"))
BOOST_DATA_TEST_CASE(a_source_is_found_however_close_to_the_image_and_of_either_sign,
                     bdata::make({0.6, 1.0, 1.5, 2.3}) * bdata::make({1000.0, -1000.0}), pixels, flux_jy) {
  const DirectionCosines at{(32 + 4 * pixels) * geometry.cell_rad, 5 * geometry.cell_rad};
  const Found found = search(observed({{at, flux_jy}}, 1), plan_with(geometry, "nearest", 1, 2));
  BOOST_REQUIRE(!found.sources.empty());
  BOOST_TEST(found.sources.front().source.flux_jy == flux_jy, boost::test_tools::tolerance(0.05));
}

BOOST_TEST_DECORATOR(*boost::unit_test::label("sweep"))
BOOST_DATA_TEST_CASE(a_source_between_pixels_is_explained, bdata::make({0.0, 0.25, 0.5}) * bdata::make({0.0, 0.3, 0.5}), east,
                     north) {
  const double cell_rad = 4 * geometry.cell_rad;
  const DirectionCosines at{(25 + east) * cell_rad, (7 + north) * cell_rad};
  const Found found = search(observed({{at, 1000}}, 1), plan_with(geometry, "nearest", 1, 2));
  BOOST_REQUIRE(found.field.geometry.cell_rad == cell_rad);
  BOOST_TEST(found.unexplained.rms_jy < 20);
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
  BOOST_TEST(wide_field(block).geometry.cell_rad == geometry.cell_rad);
  for (double& coordinate : block.uvw_m.edit()) coordinate /= 16;
  const WideField field = wide_field(block);
  BOOST_TEST(field.geometry.cell_rad == 4 * geometry.cell_rad);
  BOOST_TEST(field.geometry.width == geometry.width);
  BOOST_TEST(field.geometry.height == geometry.height);
}

BOOST_AUTO_TEST_CASE(a_field_can_be_imaged_where_a_usable_sample_is_short_enough) {
  VisibilityBlock block = random_samples(500, 1, geometry.cell_rad, 5);
  const ImageGeometry coarse{64, 48, 4 * geometry.cell_rad, {}};
  BOOST_TEST(can_be_imaged(coarse, stored({block})));
  for (std::size_t row = 0; row < 500; ++row) {
    const double turns = speed_of_light_m_s / block.frequency_hz.front() / coarse.cell_rad;
    if (std::max(std::abs(block.uvw_m[3 * row]), std::abs(block.uvw_m[3 * row + 1])) < 0.5 * turns) block.weight[row] = 0;
  }
  BOOST_TEST(!can_be_imaged(coarse, stored({block})));
}

BOOST_AUTO_TEST_SUITE_END()
