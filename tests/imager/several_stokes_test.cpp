#include "tests/imager/several_stokes.h"

#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>

#include "imager/direct/direct_transform.h"
#include "imager/numerics/fft.h"
#include "imager/wide/wide_transform.h"
#include "kernels/catalogue.h"
#include "tests/imager/comparison.h"

BOOST_AUTO_TEST_SUITE(several_stokes)

namespace bdata = boost::unit_test::data;
using namespace misfit;
using namespace misfit::imager;
using namespace misfit::imager::testing;

namespace {

constexpr int kernel_width = 6;
const ImageGeometry centred{40, 36, 0.005, {}}, off{40, 36, 0.005, {}, {0.05, -0.03}};

WideTransformOptions options(const ImageGeometry& geometry, Precision precision, int facets, bool wide) {
  WideTransformOptions o;
  o.geometry = geometry;
  o.nu = o.nv = fast_fft_size(2 * geometry.width / facets);
  o.kernel_u = o.kernel_v = kernels::kernel_family("least-misfit").make(kernel_width, 0.25);
  if (wide) o.kernel_w = o.kernel_u;
  o.facets_l = o.facets_m = facets;
  o.precision = precision;
  o.threads = 2;
  return o;
}

struct Named {
  std::string name;
  std::shared_ptr<const Transform> transform;
  ImageGeometry geometry;
  bool with_w = true;
};
std::ostream& operator<<(std::ostream& out, const Named& named) {
  return out << named.name;
}

std::vector<Named> transforms() {
  std::vector<Named> all;
  for (const ImageGeometry& geometry : {centred, off}) {
    const std::string where = geometry.off_phase_centre() ? ", off centre" : "";
    for (const auto& [precision, name] :
         {std::pair(Precision::single_precision, " single"), {Precision::double_precision, " double"}}) {
      all.push_back({"plane" + (name + where), make_transform(options(geometry, precision, 1, false)), geometry, false});
      all.push_back({"wide" + (name + where), make_transform(options(geometry, precision, 1, true)), geometry});
      all.push_back({"facets" + (name + where), make_transform(options(geometry, precision, 2, true)), geometry});
    }
    all.push_back({"direct" + where, std::make_shared<DirectTransform>(geometry, 2), geometry});
  }
  return all;
}

/// Some samples lie beyond the grid, some at its very edge, some have no weight and are not even numbers.
std::vector<VisibilityBlock> blocks(int others) {
  std::vector<VisibilityBlock> all;
  for (const unsigned seed : {1U, 2U}) {
    VisibilityBlock block = with_others(random_samples_with_w(150, 5, centred.cell_rad, 60, seed, 1.02), others, seed);
    block.uvw_m.edit()[0] = 0.4999999 / centred.cell_rad * speed_of_light_m_s / block.frequency_hz.back();
    for (std::size_t i = 3; i < block.samples(); i += 17) {
      block.weight[i] = 0;
      block.visibility[i] = std::numeric_limits<float>::quiet_NaN();
    }
    all.push_back(std::move(block));
  }
  return all;
}

AdjointResult together(const Transform& transform, const std::vector<VisibilityBlock>& blocks, const AdjointOptions& options) {
  const auto sum = transform.adjoint(options);
  for (const VisibilityBlock& block : blocks) sum->add(block);
  return sum->finish();
}

AdjointResult one_alone(const Transform& transform, const std::vector<VisibilityBlock>& blocks, std::size_t stokes,
                        bool with_psf) {
  std::vector<VisibilityBlock> of_one;
  for (const VisibilityBlock& block : blocks) of_one.push_back(alone(block, stokes));
  return together(transform, of_one, {.with_psf = with_psf});
}

/// Same bits, those of NaN too.
bool same(const Image& a, const Image& b) {
  return std::equal(a.pixel.begin(), a.pixel.end(), b.pixel.begin(), b.pixel.end(),
                    [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); });
}

}  // namespace

BOOST_DATA_TEST_CASE(images_made_at_once_have_the_bits_of_those_made_one_by_one,
                     bdata::make(transforms()) * bdata::make({2, 3, 4}) * bdata::make({false, true}), named, images, with_psf) {
  const auto samples = blocks(images - 1);
  const AdjointResult made = together(*named.transform, samples, {images, with_psf});
  BOOST_REQUIRE(made.images.size() == static_cast<std::size_t>(images));
  for (std::size_t i = 0; i < made.images.size(); ++i) {
    const AdjointResult one = one_alone(*named.transform, samples, i, with_psf);
    BOOST_TEST(same(made.images[i], one.images[0]));
    BOOST_TEST(same(made.psf, one.psf));
    BOOST_TEST(made.sums[i].used == one.sums[0].used);
    BOOST_TEST(made.sums[i].outside_grid == one.sums[0].outside_grid);
    BOOST_TEST(made.sums[i].weight == one.sums[0].weight);
    BOOST_TEST(made.sums[i].weight_abs == one.sums[0].weight_abs);
    BOOST_TEST(made.sums[i].weight2_square == one.sums[0].weight2_square);
  }
  BOOST_TEST(made.sums[0].outside_grid > 0U);
}

BOOST_DATA_TEST_CASE(a_psf_alone_has_the_bits_of_one_made_beside_images, bdata::make(transforms()), named) {
  const auto samples = blocks(1);
  const AdjointResult beside = together(*named.transform, samples, {2, true});
  const AdjointResult made = together(*named.transform, samples, {0, true});
  BOOST_TEST(made.images.empty());
  BOOST_TEST(same(made.psf, beside.psf));
  BOOST_REQUIRE(made.sums.size() == 1U);
  BOOST_TEST(made.sums[0].used == beside.sums[0].used);
  BOOST_TEST(made.sums[0].outside_grid == beside.sums[0].outside_grid);
  BOOST_TEST(made.sums[0].weight == beside.sums[0].weight);
  BOOST_TEST(made.sums[0].weight2_square == beside.sums[0].weight2_square);
  const auto sum = named.transform->adjoint({0, true});
  BOOST_CHECK_THROW(sum->add(samples[0], std::vector<std::complex<double>>(samples[0].samples())), std::invalid_argument);
}

/// Visibilities given in double precision, one set for each image, are imaged as those that blocks carry; the same but for the
/// order of roundings, of single precision where grids are.
BOOST_DATA_TEST_CASE(sets_given_are_imaged_as_those_that_blocks_carry, bdata::make(transforms()), named) {
  const auto samples = blocks(2);
  const AdjointResult carried = together(*named.transform, samples, {.images = 3});
  const auto sum = named.transform->adjoint({.images = 3});
  for (const VisibilityBlock& block : samples) {
    std::vector<std::vector<std::complex<double>>> sets;
    for (std::size_t s = 0; s < 3; ++s) {
      const VisibilityBlock one = alone(block, s);
      sets.emplace_back(one.visibility.begin(), one.visibility.end());
    }
    sum->add(block, sets);
  }
  const AdjointResult given = sum->finish();
  for (std::size_t i = 0; i < 3; ++i) BOOST_TEST(relative_error(given.images[i].pixel, carried.images[i].pixel) < 1e-6);
}

BOOST_DATA_TEST_CASE(every_image_is_the_direct_one_within_the_kernel_error, bdata::make(transforms()), named) {
  const auto samples = blocks(3);
  const AdjointResult made = together(*named.transform, samples, {4, true});
  const AdjointResult direct = together(DirectTransform({named.geometry, named.with_w, 2}), samples, {4, true});
  const kernels::Kernel kernel = kernels::kernel_family("least-misfit").make(kernel_width, 0.25);
  // Three axes add their E, and finite samples stray from the mean by less than half; single precision rounds at 1e-6.
  const double bound = 1.5 * std::sqrt(3 * kernel.misfit.mean) + 1e-6;
  for (std::size_t i = 0; i < 4; ++i) BOOST_TEST(relative_error(made.images[i].pixel, direct.images[i].pixel) < bound);
  BOOST_TEST(relative_error(made.psf.pixel, direct.psf.pixel) < bound);
}

BOOST_DATA_TEST_CASE(planes_held_a_few_at_a_time_change_no_more_than_the_order_of_sums, bdata::make({1, 2}), facets) {
  WideTransformOptions o = options(centred, Precision::double_precision, facets, true);
  o.stack_bytes = 4 << 20;
  const auto samples = blocks(3);
  const auto transform = make_transform(o);
  const AdjointResult made = together(*transform, samples, {4, true});
  // A few hundred planes at most, each added with the rounding of doubles.
  for (std::size_t i = 0; i < 4; ++i)
    BOOST_TEST(relative_error(made.images[i].pixel, one_alone(*transform, samples, i, false).images[0].pixel) < 1e-13);
}

BOOST_DATA_TEST_CASE(bits_do_not_depend_on_the_number_of_threads, bdata::make({false, true}), wide) {
  WideTransformOptions o = options(off, Precision::single_precision, 2, wide);
  if (!wide) o.nu = o.nv = fast_fft_size(2 * off.width);
  const auto samples = blocks(3);
  o.threads = 1;
  const AdjointResult one = together(*make_transform(o), samples, {4, true});
  for (const int threads : {2, 5}) {
    o.threads = threads;
    const AdjointResult many = together(*make_transform(o), samples, {4, true});
    for (std::size_t i = 0; i < 4; ++i) BOOST_TEST(same(many.images[i], one.images[i]));
    BOOST_TEST(same(many.psf, one.psf));
  }
}

BOOST_DATA_TEST_CASE(crowded_tiles_and_extreme_sizes_keep_the_bits_of_each_image, bdata::make({false, true}), wide) {
  // More samples of one tile than single precision adds up, and visibilities that take units of their own.
  VisibilityBlock block = with_others(random_samples(10000, 4, centred.cell_rad, 5, 0.1), 2, 6);
  for (std::size_t i = block.samples(); i < 2 * block.samples(); ++i) block.visibility[i] *= 1e30F;
  const auto transform = make_transform(options(centred, Precision::single_precision, 1, wide));
  const AdjointResult made = together(*transform, {block, block}, {3, true});
  for (std::size_t i = 0; i < 3; ++i)
    BOOST_TEST(same(made.images[i], one_alone(*transform, {block, block}, i, false).images[0]));
}

BOOST_DATA_TEST_CASE(a_wrong_number_of_visibilities_is_refused, bdata::make(transforms()), named) {
  const VisibilityBlock two = with_others(random_samples(5, 1, centred.cell_rad, 1), 1, 2);
  const auto sum = named.transform->adjoint({.images = 3});
  BOOST_CHECK_EXCEPTION(sum->add(two), std::invalid_argument, [](const std::exception& error) {
    return std::string(error.what()).find("2 Stokes parameters for 3 images") != std::string::npos;
  });
  BOOST_CHECK_THROW(sum->add(two, std::vector<std::complex<double>>(5)), std::invalid_argument);
  VisibilityBlock fewer = two;
  fewer.visibility.pop_back();
  BOOST_CHECK_THROW(named.transform->adjoint({.images = 2})->add(fewer), std::invalid_argument);
  for (const int images : {0, most_stokes + 1})
    BOOST_CHECK_THROW(named.transform->adjoint({.images = images}), std::invalid_argument);
}

BOOST_DATA_TEST_CASE(one_image_is_of_the_blocks_own_stokes_parameter, bdata::make(transforms()), named) {
  const auto samples = blocks(1);
  BOOST_TEST(same(together(*named.transform, samples, {}).images[0], one_alone(*named.transform, samples, 0, false).images[0]));
}

BOOST_AUTO_TEST_SUITE_END()
