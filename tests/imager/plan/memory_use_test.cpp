#include "imager/plan/memory_use.h"

#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>

#include "imager/coplanar/half_grid.h"
#include "imager/plan/gridding_plan.h"

BOOST_AUTO_TEST_SUITE(memory_use)

namespace bdata = boost::unit_test::data;
using namespace misfit::imager;

namespace {

MemoryDemand demand() {
  return {.transform = {8e9, 4e9, 1e7}, .pixels = 1e8, .rows = 1e6, .samples = 1e8, .block_samples = 1e6};
}

double peak(const MemoryDemand& demand, const StreamingOptions& streaming) {
  return peak_memory(demand, streaming).total();
}

}  // namespace

BOOST_AUTO_TEST_CASE(the_total_is_the_sum_of_its_parts) {
  const MemoryUse use{"", 1, 20, 300, 4000, 50000, 600000};
  BOOST_TEST(use.total() == 654321);
}

BOOST_AUTO_TEST_CASE(visibilities_kept_count_for_as_much_as_they_are) {
  MemoryDemand d = demand();
  d.block_samples = 0;
  BOOST_TEST(peak(d, {true, 2}) - peak(d, {false, 2}) == 1e8 * 12 + 1e6 * 24);
  BOOST_TEST(peak_memory(d, {false, 2}).visibilities == 0);
}

BOOST_AUTO_TEST_CASE(less_read_ahead_takes_less) {
  MemoryDemand d = demand();
  d.block_samples = 1e8;  // so that the blocks decide
  d.samples = 4e8;
  for (const std::size_t ahead : {0, 1, 2}) BOOST_TEST(peak(d, {false, ahead}) < peak(d, {false, ahead + 1}));
}

BOOST_AUTO_TEST_CASE(blocks_read_at_once_stand_beside_each_other_with_one_weight_for_all_their_stokes_parameters) {
  MemoryDemand d = demand();
  d.transform = {1e6, 5e5, 1e3};
  d.pixels = 1e4;
  d.stokes = 4;
  const double one = peak(d, {false, 2}), kept = peak(d, {true, 2});
  d.read_at_once = 8 * d.block_samples;
  BOOST_TEST(peak(d, {false, 2}) == one + 7 * d.block_samples * (4 * 8 + 4));
  BOOST_TEST(peak(d, {true, 2}) == kept);
}

BOOST_AUTO_TEST_CASE(blocks_that_a_prediction_gathers_count_where_they_are_not_kept) {
  MemoryDemand d = demand();
  d.transform = {1e6, 5e5, 1e3};
  d.pixels = 1e4;
  d.clean_scales = 1;
  const double kept = peak(d, {true, 2}), read_again = peak(d, {false, 2});
  const double handed_out = d.block_samples * 16;  // their visibilities, which the transform counts where it gathers
  d.transform.gathered = 3 * d.block_samples;
  BOOST_TEST(peak(d, {true, 2}) == kept - handed_out);
  BOOST_TEST(peak(d, {false, 2}) == read_again - handed_out + 3 * d.block_samples * (12 + 24 * d.rows / d.samples));
}

/// Grids of what is predicted and imaged, and spectral PSFs, which minor cycles keep transformed.
BOOST_AUTO_TEST_CASE(further_taylor_terms_have_grids_and_images_of_their_own) {
  MemoryDemand d = demand();
  d.clean_scales = 1;
  for (const int terms : {2, 3}) {
    MemoryDemand more = d;
    more.terms = terms;
    const double further = terms - 1;
    BOOST_TEST(peak(more, {true, 2}) >= peak(d, {true, 2}) + further * 2 * d.transform.visibilities);
    more.transform = d.transform = {1e6, 5e5, 1e3};  // so that images decide
    BOOST_TEST(peak(more, {true, 2}) >= peak(d, {true, 2}) + (3 * further + 1.25 * 2 * further) * d.pixels * 8);
    d = demand();
    d.clean_scales = 1;
  }
}

BOOST_AUTO_TEST_CASE(a_block_holds_no_more_samples_than_there_are) {
  MemoryDemand d = demand();
  d.block_samples = 2 * d.samples;
  MemoryDemand whole = demand();
  whole.block_samples = whole.samples;
  BOOST_TEST(peak(d, {false, 2}) == peak(whole, {false, 2}));
}

BOOST_AUTO_TEST_CASE(large_grids_and_large_images_each_have_their_moment) {
  MemoryDemand d = demand();
  BOOST_TEST(peak_memory(d, {}).when == "the dirty image is made");
  d.transform = {1e6, 5e5, 1e3};
  d.samples = 1e6;
  BOOST_TEST(peak_memory(d, {}).when == "the pictures are drawn");
  d.clean_scales = 1;
  BOOST_TEST(peak_memory(d, {}).when == "the minor cycles run");
  d.transform.visibilities = 3 * 8 * d.pixels;
  BOOST_TEST(peak_memory(d, {}).when == "the residual is gridded");
  d.transform.fft = d.transform.visibilities;
  BOOST_TEST(peak_memory(d, {}).when == "the residual image is made");
}

BOOST_AUTO_TEST_CASE(cleaning_and_verifying_never_take_less) {
  for (const double grid : {1e5, 1e8, 1e10}) {
    MemoryDemand d = demand();
    d.transform.visibilities = grid;
    const double plain = peak(d, {});
    d.verify = true;
    BOOST_TEST(peak(d, {}) >= plain);
    d.clean_scales = 1;
    BOOST_TEST(peak(d, {}) >= plain);
  }
}

BOOST_AUTO_TEST_CASE(a_density_of_samples_counts_while_it_is_made_and_its_factors_while_samples_are_read_again) {
  MemoryDemand d = demand();
  const double kept = peak(d, {true, 2}), read_again = peak(d, {false, 2});
  d.density = true;
  BOOST_TEST(peak(d, {true, 2}) == kept);
  BOOST_TEST(peak(d, {false, 2}) == read_again + 4 * d.pixels / 2);  // in single precision for half the plane
  d.transform = {1e6, 5e5, 1e3};
  d.samples = d.block_samples = 1e9;  // so that its runs decide
  BOOST_TEST(peak_memory(d, {}).when == "the weights are made");
}

BOOST_AUTO_TEST_CASE(densities_of_pointings_take_no_more_than_planes_or_than_samples_touch) {
  MemoryDemand d = demand();
  const double without = peak(d, {false, 2});
  d.density = true;
  d.pointings = 2;
  BOOST_TEST(peak(d, {false, 2}) == without + 4 * 2 * d.pixels / 2);
  d.pointings = 1000;
  BOOST_TEST(peak(d, {false, 2}) == without + 4 * 3 * d.samples);
}

BOOST_AUTO_TEST_CASE(a_wider_field_counts_beside_the_images_that_stay_while_it_is_searched) {
  MemoryDemand d = demand();
  const double without = peak(d, {});
  d.wider = WiderDemand{{1e6, 5e5, 1e3}, 1e4};
  BOOST_TEST(peak(d, {}) == without);  // small beside the image
  d.wider = WiderDemand{{1e6, 5e5, 1e3}, 1e9};
  BOOST_TEST(peak_memory(d, {}).when == "the wider field is cleaned");
  d.wider = WiderDemand{{2e11, 1e11, 1e7}, 1e9};
  BOOST_TEST(peak_memory(d, {}).when == "the wider field's residual is made");
  BOOST_TEST(peak(d, {}) > 4e11 + 2 * 8 * d.pixels);
}

BOOST_DATA_TEST_CASE(the_coplanar_transform_counts_the_planes_of_its_grid, bdata::make({1e-3, 1e-6}), accuracy) {
  GriddingRequest request;
  request.geometry = {500, 300, 1e-6, {}};
  request.accuracy = accuracy;
  const CoplanarOptions options = plan_gridding(request).options;
  const TransformMemory memory = memory_of(options);
  const double real_bytes = options.precision == Precision::single_precision ? 4 : 8;
  BOOST_TEST(memory.psf > 0.5 * options.nu * options.nv * real_bytes);
  constexpr double tile = 32;  // whole tiles, with one more for the taps that leave the last
  BOOST_TEST(memory.psf < (options.nu + 3 * tile) * (0.5 * options.nv + 3 * tile) * real_bytes);
  BOOST_TEST(memory.visibilities == 2 * memory.psf);
  BOOST_TEST(memory.other_stokes == 0);
  BOOST_TEST(memory_of(options, 4).other_stokes == 3 * memory.visibilities);
}

BOOST_DATA_TEST_CASE(crowded_tiles_add_their_sums_in_double_precision_and_no_more_than_all_tiles, bdata::make({true, false}),
                     single) {
  GriddingRequest request;
  request.geometry = {500, 300, 1e-6, {}};
  request.accuracy = 1e-3;
  request.precision = single ? Precision::single_precision : Precision::double_precision;
  const CoplanarOptions options = plan_gridding(request).options;
  const double none = memory_of(options).psf, some = memory_of(options, 1, 1e6).psf, all = memory_of(options, 1, 1e12).psf;
  if (!single) {
    BOOST_TEST(all == none);
  } else {
    // A buffer holds a tile of 32 × 32 cells with its margin, at most 20, for each 2¹⁵ samples.
    BOOST_TEST(some - none >= 1e6 / 32768 * 8 * 32 * 32);
    BOOST_TEST(some - none <= 1e6 / 32768 * 8 * 52 * 52);
    BOOST_TEST(all <= 8 * none);  // doubles for floats, and (52/32)² of margins
  }
  BOOST_TEST(memory_of(options, 1, 1e6).visibilities == 2 * some);
}

BOOST_DATA_TEST_CASE(further_stokes_parameters_add_their_grids_blocks_and_images, bdata::make({0.0, 1e5}), max_abs_w) {
  GriddingRequest request;
  request.geometry = {2000, 2000, 1e-5, {}};
  request.samples = 10000000;
  request.max_abs_w = max_abs_w;
  const TransformMemory one = memory_of(plan_gridding(request));
  request.stokes = 3;
  const TransformMemory three = memory_of(plan_gridding(request));
  BOOST_TEST(one.other_stokes == 0);
  BOOST_TEST(three.visibilities <= one.visibilities);  // of w planes fewer stand in memory at a time
  // A grid and, where w planes share stack_bytes, an image and what is gathered for each.
  BOOST_TEST(three.other_stokes >= 2 * 8. * 2000 * 2000);
  BOOST_TEST(three.other_stokes <= 2 * three.visibilities);
  // With a w axis more grids may mean smaller facets, of fewer planes.
  if (max_abs_w == 0) BOOST_TEST(three.visibilities + three.other_stokes >= one.visibilities);
  BOOST_TEST(three.visibilities + three.other_stokes <= 3 * one.visibilities);
  MemoryDemand d = demand();
  d.transform = {8e9, 4e9, 1e7};
  const double alone = peak(d, {false, 0});
  d.transform.other_stokes = 1e10;
  BOOST_TEST(peak(d, {false, 0}) == alone + 1e10);
  d.stokes = 3;
  d.block_samples = 0;
  BOOST_TEST(peak(d, {true, 0}) - peak(d, {false, 0}) == 1e8 * (3 * 8 + 4) + 1e6 * 24);
}

BOOST_AUTO_TEST_CASE(many_stokes_parameters_have_the_moment_of_their_last_image) {
  MemoryDemand d = demand();
  d.transform = {1e6, 5e5, 1e3};
  d.stokes = 4;
  const double least = peak(MemoryDemand{}, {}), image = 8 * d.pixels;  // of the program alone
  d.samples = d.rows = 0;
  const double drawn = peak(d, {}) - least;
  BOOST_TEST(drawn >= 5 * image);
  BOOST_TEST(drawn <= 6 * image);  // and one to find medians
  d.clean_scales = 1;
  const double cleaned = peak(d, {}) - least;
  BOOST_TEST(cleaned >= 13 * image);  // three of each, and the PSF
  BOOST_TEST(cleaned <= 16 * image);  // medians, what the allocator keeps, and PSF cores
}

BOOST_AUTO_TEST_SUITE_END()
