#include "imager/wide/wide_transform.h"

#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>

#include "imager/direct/direct_transform.h"
#include "imager/numerics/fft.h"
#include "imager/plan/gridding_choice.h"
#include "imager/wide/facet.h"
#include "kernels/catalogue.h"
#include "tests/imager/comparison.h"
#include "tests/imager/random_samples.h"

BOOST_AUTO_TEST_SUITE(wide_transform)

namespace bdata = boost::unit_test::data;
using namespace misfit;
using namespace misfit::imager;
using namespace misfit::imager::testing;

namespace {

struct Case {
  ImageGeometry geometry;
  int width = 7;
  double padding = 1.6;
  int facets_l = 1;
  int facets_m = 1;
};

WideTransformOptions options(const Case& c) {
  WideTransformOptions o;
  o.geometry = c.geometry;
  o.facets_l = c.facets_l;
  o.facets_m = c.facets_m;
  const auto fft = [&](int pixels, int facets) {
    return fast_fft_size(std::max(static_cast<int>(c.padding * ((pixels + facets - 1) / facets)), 4 * c.width));
  };
  o.nu = fft(c.geometry.width, c.facets_l);
  o.nv = fft(c.geometry.height, c.facets_m);
  const auto kernel = [&](int pixels, int facets, int n) {
    const double x0 = 0.5 * ((pixels + facets - 1) / facets) / n;
    return kernels::kernel_family("least-misfit").make(c.width, std::clamp(x0, 0.05, 0.49));
  };
  o.kernel_u = kernel(c.geometry.width, c.facets_l, o.nu);
  o.kernel_v = kernel(c.geometry.height, c.facets_m, o.nv);
  o.kernel_w = kernels::kernel_family("least-misfit").make(c.width, 0.5 / 2);
  o.threads = 2;
  return o;
}

AdjointResult adjoint_of(const Transform& transform, const VisibilityBlock& block) {
  const auto sum = transform.adjoint({.with_psf = true});
  sum->add(block);
  return sum->finish();
}

/// Pixels above the horizon.
std::vector<double> seen(const Image& image) {
  std::vector<double> pixels;
  for (const double p : image.pixel)
    if (!std::isnan(p)) pixels.push_back(p);
  return pixels;
}

/// E of the three axes, over the pixels of the largest facet: few are no mean over the field.
double expected_error(const WideTransformOptions& o) {
  const auto largest = [](int pixels, int facets) { return (pixels + facets - 1) / facets; };
  return std::sqrt(axis_misfit(o.kernel_u, largest(o.geometry.width, o.facets_l), o.nu).mean +
                   axis_misfit(o.kernel_v, largest(o.geometry.height, o.facets_m), o.nv).mean + o.kernel_w.misfit.mean);
}
double worst_error(const WideTransformOptions& o) {
  return std::sqrt(o.kernel_u.misfit.worst_mean + o.kernel_v.misfit.worst_mean + o.kernel_w.misfit.worst_mean);
}

/// 20° across with w of several hundred wavelengths: tens of turns at the corners.
const ImageGeometry field{64, 48, 0.0055, {}};
const double most_w = 600;

}  // namespace

BOOST_TEST_DECORATOR(*boost::unit_test::label("sweep"))
BOOST_DATA_TEST_CASE(dirty_image_and_psf_equal_the_direct_transform_within_the_kernel_error,
                     bdata::xrange(2, 15) * bdata::make({1, 2, 3}), width, facets) {
  const WideTransformOptions o = options({field, width, 1.6, facets, 3 - facets / 2});
  const VisibilityBlock block = random_samples_with_w(150, 3, field.cell_rad, most_w, 1);
  const AdjointResult gridded = adjoint_of(*make_wide_transform(o), block);
  const AdjointResult direct = adjoint_of(DirectTransform(field, 2), block);
  constexpr double rounding = 3e-13;  // of phases of some hundred turns
  BOOST_TEST(relative_error(gridded.images[0].pixel, direct.images[0].pixel) < 1.5 * expected_error(o) + rounding);
  BOOST_TEST(relative_error(gridded.psf.pixel, direct.psf.pixel) < 1.5 * worst_error(o) + rounding);
  BOOST_TEST(gridded.sums[0].used == block.samples());
}

BOOST_TEST_DECORATOR(*boost::unit_test::label("sweep"))
BOOST_DATA_TEST_CASE(predicted_visibilities_equal_the_direct_transform_within_the_kernel_error,
                     bdata::xrange(2, 15) * bdata::make({1, 2}), width, facets) {
  const WideTransformOptions o = options({field, width, 1.6, facets, facets});
  const VisibilityBlock block = random_samples_with_w(200, 2, field.cell_rad, most_w, 2, 2.3);
  const Image model = random_image(field.width, field.height, 3);
  const auto gridded = make_wide_transform(o)->predict(model)->at(block);
  const auto direct = DirectTransform(field, 2).predict(model)->at(block);
  BOOST_TEST(relative_error(gridded, direct) < 1.5 * expected_error(o) + 3e-13);
}

BOOST_DATA_TEST_CASE(full_tiles_are_as_exact_as_sparse_ones, bdata::make({1, 2}) * bdata::make({7, 8}), facets, width) {
  const WideTransformOptions o = options({field, width, 1.6, facets, facets});
  const VisibilityBlock block = random_samples_with_w(3000, 2, field.cell_rad, most_w, 3, 0.5);  // hundreds of runs in a tile
  const auto transform = make_wide_transform(o);
  const AdjointResult gridded = adjoint_of(*transform, block);
  const AdjointResult direct = adjoint_of(DirectTransform(field, 2), block);
  BOOST_TEST(relative_error(gridded.images[0].pixel, direct.images[0].pixel) < 1.5 * expected_error(o) + 3e-13);
  BOOST_TEST(relative_error(gridded.psf.pixel, direct.psf.pixel) < 1.5 * worst_error(o) + 3e-13);
  const Image model = random_image(field.width, field.height, 3);
  BOOST_TEST(relative_error(transform->predict(model)->at(block), DirectTransform(field, 2).predict(model)->at(block)) <
             1.5 * expected_error(o) + 3e-13);
}

BOOST_DATA_TEST_CASE(adjoint_is_the_transpose_of_prediction, bdata::make({1, 2, 5, 8, 14, 20}) * bdata::make({1, 2}), width,
                     facets) {
  const WideTransformOptions o = options({{51, 37, 0.008, {}, {0.1, -0.05}}, width, 1.3, facets, facets});
  const auto transform = make_wide_transform(o);
  VisibilityBlock y = random_samples_with_w(200, 3, o.geometry.cell_rad, 300, 5);
  std::fill(y.weight.begin(), y.weight.end(), 1.0F);
  const Image x = random_image(51, 37, 6);
  const auto ax = transform->predict(x)->at(y);
  const Image aty = adjoint_of(*transform, y).images[0];
  double left = 0;
  for (std::size_t i = 0; i < ax.size(); ++i) left += std::real(ax[i] * std::conj(std::complex<double>(y.visibility[i])));
  double right = 0;
  for (std::size_t i = 0; i < x.pixel.size(); ++i) right += x.pixel[i] * aty.pixel[i];
  BOOST_TEST(std::abs(left - right) < 1e-12 * norm(x.pixel) * norm(aty.pixel));
}

BOOST_DATA_TEST_CASE(the_whole_hemisphere_is_exact_and_nothing_lies_beyond_the_horizon, bdata::make({1, 3, 8}), facets) {
  const ImageGeometry sky{150, 140, 2.1 / 150, {}};
  const WideTransformOptions o = options({sky, 9, 1.6, facets, facets});
  const VisibilityBlock block = random_samples_with_w(200, 1, sky.cell_rad, 30, 7);
  const AdjointResult gridded = adjoint_of(*make_wide_transform(o), block);
  const AdjointResult direct = adjoint_of(DirectTransform(sky, 2), block);
  for (std::size_t i = 0; i < direct.images[0].pixel.size(); ++i)
    BOOST_REQUIRE(std::isnan(gridded.images[0].pixel[i]) == std::isnan(direct.images[0].pixel[i]));
  BOOST_TEST(relative_error(seen(gridded.images[0]), seen(direct.images[0])) < 1.5 * expected_error(o) + 1e-13);
  Image model = random_image(sky.width, sky.height, 8);
  const auto transform = make_wide_transform(o);
  const auto predicted = transform->predict(model)->at(block);
  for (std::size_t i = 0; i < model.pixel.size(); ++i)
    if (std::isnan(direct.images[0].pixel[i])) model.pixel[i] = 1e6;
  BOOST_TEST((transform->predict(model)->at(block) == predicted));
  BOOST_TEST(relative_error(predicted, DirectTransform(sky, 2).predict(model)->at(block)) < 1.5 * expected_error(o) + 1e-13);
}

BOOST_DATA_TEST_CASE(the_psf_is_that_of_the_middle_pixel_wherever_it_lies,
                     bdata::make({1, 2, 3}) * bdata::make({0.01, 0.3, -0.75}), facets, offset) {
  const ImageGeometry off{64, 48, 0.0055, {}, {offset, -0.8 * offset}};
  const WideTransformOptions o = options({off, 8, 1.6, facets, 3 - facets / 2});
  const VisibilityBlock block = random_samples_with_w(150, 3, off.cell_rad, most_w, 1);
  const AdjointResult gridded = adjoint_of(*make_wide_transform(o), block);
  const AdjointResult direct = adjoint_of(DirectTransform(off, 2), block);
  BOOST_TEST(relative_error(seen(gridded.images[0]), seen(direct.images[0])) < 1.5 * expected_error(o) + 1e-12);
  BOOST_TEST(relative_error(seen(gridded.psf), seen(direct.psf)) < 1.5 * worst_error(o) + 1e-12);
  const double worst =
      std::sqrt(o.kernel_u.misfit.worst) + std::sqrt(o.kernel_v.misfit.worst) + std::sqrt(o.kernel_w.misfit.worst);
  BOOST_TEST((std::abs(gridded.psf.at(24, 32) / gridded.sums[0].weight - 1) < worst + 1e-12));
}

BOOST_AUTO_TEST_CASE(a_psf_whose_source_is_beyond_the_horizon_is_nan_and_leaves_the_image_alone) {
  const ImageGeometry off{128, 128, 0.0055, {}, {0.9, 0.5}};
  const WideTransformOptions o = options({off, 7, 1.6, 2, 2});
  const VisibilityBlock block = random_samples_with_w(150, 3, off.cell_rad, 50, 1);
  const AdjointResult gridded = adjoint_of(*make_wide_transform(o), block);
  const AdjointResult direct = adjoint_of(DirectTransform(off, 2), block);
  BOOST_TEST_REQUIRE(!seen(direct.images[0]).empty());
  BOOST_TEST(relative_error(seen(gridded.images[0]), seen(direct.images[0])) < 1.5 * expected_error(o) + 1e-12);
  BOOST_TEST(seen(gridded.psf).empty());
}

BOOST_DATA_TEST_CASE(runs_of_thousands_of_channels_over_many_periods_are_as_exact, bdata::make({1.0, 40.0}), reach) {
  const WideTransformOptions o = options({{40, 30, 0.0055, {}}, 7, 1.6, 1, 1});
  VisibilityBlock block = random_samples_with_w(4, 5000, o.geometry.cell_rad, 5, 3, reach);
  for (std::size_t c = 0; c < block.channels(); ++c) block.frequency_hz[c] = 1e9 * (1 + 1e-5 * static_cast<double>(c));
  const auto transform = make_wide_transform(o);
  const Image model = random_image(40, 30, 3);
  const auto direct = DirectTransform(o.geometry, 2).predict(model)->at(block);
  BOOST_TEST(relative_error(transform->predict(model)->at(block), direct) < 1.5 * worst_error(o) + 1e-12);
  if (reach > 1) return;
  const AdjointResult gridded = adjoint_of(*transform, block);
  BOOST_TEST(relative_error(gridded.images[0].pixel, adjoint_of(DirectTransform(o.geometry, 2), block).images[0].pixel) <
             1.5 * worst_error(o) + 1e-12);
}

BOOST_AUTO_TEST_CASE(rows_of_weight_zero_do_not_count_wherever_they_lie) {
  const WideTransformOptions o = options({field, 7, 1.6, 2, 2});
  const VisibilityBlock block = random_samples_with_w(100, 2, field.cell_rad, most_w, 3);
  VisibilityBlock more = block;
  for (const double x : {std::nan(""), 1e300, -1e300}) {
    more.uvw_m.append({x, x, x});
    more.visibility.insert(more.visibility.end(), 2, {std::nanf(""), 0});
    more.weight.insert(more.weight.end(), 2, 0);
  }
  const auto transform = make_wide_transform(o);
  BOOST_TEST((adjoint_of(*transform, more).images[0].pixel == adjoint_of(*transform, block).images[0].pixel));
}

BOOST_DATA_TEST_CASE(w_of_any_kind_is_as_exact, bdata::make({0, 1, 2, 3, 4}), kind) {
  const WideTransformOptions o = options({field, 9, 1.6, 2, 2});
  VisibilityBlock block = random_samples_with_w(kind == 4 ? 1 : 100, 2, field.cell_rad, most_w, 11);
  for (std::size_t row = 0; row < block.rows(); ++row) {
    double& w = block.uvw_m.edit()[3 * row + 2];
    const double values[] = {0, 500, -500, row % 2 == 0 ? 1e5 : -3, w};
    w = values[kind];
  }
  const AdjointResult gridded = adjoint_of(*make_wide_transform(o), block);
  const AdjointResult direct = adjoint_of(DirectTransform(field, 2), block);
  // One w, or a few, are no average over positions within a cell; rounding of phases of 10⁴ turns.
  BOOST_TEST(relative_error(gridded.images[0].pixel, direct.images[0].pixel) <
             1.5 * worst_error(o) + (kind == 3 ? 1e-10 : 1e-13));
}

BOOST_DATA_TEST_CASE(shapes_odd_thin_and_tiny_are_as_exact, bdata::make({331, 7, 1, 1, 64}) ^ bdata::make({17, 50, 1, 40, 1}),
                     width, height) {
  const Case c{{width, height, 0.003, {}, {0.3, 0.2}}, 9, 2.0};
  const WideTransformOptions o = options(c);
  const VisibilityBlock block = random_samples_with_w(60, 2, 0.003, 100, 4);
  const AdjointResult gridded = adjoint_of(*make_wide_transform(o), block);
  const AdjointResult direct = adjoint_of(DirectTransform(c.geometry, 1), block);
  const double bound =
      std::sqrt(o.kernel_u.misfit.worst) + std::sqrt(o.kernel_v.misfit.worst) + std::sqrt(o.kernel_w.misfit.worst);
  const double data = std::sqrt(direct.sums[0].weight2_square * static_cast<double>(c.geometry.pixels()));
  BOOST_TEST(distance(gridded.images[0].pixel, direct.images[0].pixel) < 3 * bound * data);
}

BOOST_DATA_TEST_CASE(result_does_not_depend_on_threads, bdata::make({true, false}), single) {
  WideTransformOptions o = options({field, 6, 1.5, 2, 1});
  o.precision = single ? Precision::single_precision : Precision::double_precision;
  const VisibilityBlock block = random_samples_with_w(3000, 4, field.cell_rad, most_w, 7);
  const Image model = random_image(field.width, field.height, 8);
  o.threads = 1;
  const AdjointResult one = adjoint_of(*make_wide_transform(o), block);
  const auto predicted = make_wide_transform(o)->predict(model)->at(block);
  for (const int threads : {2, 3, 7}) {
    o.threads = threads;
    const AdjointResult many = adjoint_of(*make_wide_transform(o), block);
    BOOST_TEST((many.images[0].pixel == one.images[0].pixel));
    BOOST_TEST((many.psf.pixel == one.psf.pixel));
    BOOST_TEST((make_wide_transform(o)->predict(model)->at(block) == predicted));
  }
}

BOOST_AUTO_TEST_CASE(little_memory_changes_nothing_but_rounding) {
  const ImageGeometry tall{48, 200, 0.002, {}};  // several rows of tiles
  WideTransformOptions o = options({tall, 8, 1.5});
  const VisibilityBlock a = random_samples_with_w(300, 4, tall.cell_rad, most_w, 7);
  const VisibilityBlock b = random_samples_with_w(200, 1, tall.cell_rad, most_w, 8);
  const auto image_of = [&] {
    const auto transform = make_wide_transform(o);
    const auto sum = transform->adjoint({.with_psf = true});
    sum->add(a);
    sum->add(b);
    return sum->finish().images[0].pixel;
  };
  const auto predicted = [&] { return make_wide_transform(o)->predict(random_image(tall.width, tall.height, 9))->at(a); };
  const std::vector<double> roomy = image_of();
  const auto roomily_predicted = predicted();
  o.stack_bytes = 1;  // one pair of planes at a time, in bands of one row of tiles
  o.samples_at_once = 1;
  BOOST_TEST(relative_error(image_of(), roomy) < 1e-13);
  BOOST_TEST(relative_error(predicted(), roomily_predicted) < 1e-13);
}

BOOST_AUTO_TEST_SUITE_END()
