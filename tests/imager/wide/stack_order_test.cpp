#include "imager/wide/stack_order.h"

#include <algorithm>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <ostream>
#include <random>
#include <vector>

BOOST_AUTO_TEST_SUITE(stack_order)

namespace bdata = boost::unit_test::data;
using namespace misfit::imager;

namespace {

enum class Frequencies { rising, falling, mixed };

std::ostream& operator<<(std::ostream& out, Frequencies frequencies) {
  return out << (frequencies == Frequencies::rising ? "rising" : frequencies == Frequencies::falling ? "falling" : "mixed");
}

VisibilityBlock random_block(std::size_t rows, std::size_t channels, Frequencies frequencies, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  VisibilityBlock block;
  for (std::size_t c = 0; c < channels; ++c) block.frequency_hz.push_back(1e9 + 1e7 * static_cast<double>(c));
  if (frequencies == Frequencies::falling) std::reverse(block.frequency_hz.begin(), block.frequency_hz.end());
  if (frequencies == Frequencies::mixed) std::shuffle(block.frequency_hz.begin(), block.frequency_hz.end(), random);
  for (std::size_t r = 0; r < rows; ++r) {
    const double length_m = std::pow(10, 2 + 2.5 * uniform(random));  // also far beyond the grid
    block.uvw_m.append({length_m * uniform(random), length_m * uniform(random), length_m * uniform(random)});
    for (std::size_t c = 0; c < channels; ++c) block.weight.push_back(random() % 4 == 0 || r % 5 == 1 ? 0.0F : 1.0F);
  }
  return block;
}

}  // namespace

/// Against the place of each sample by itself.
BOOST_DATA_TEST_CASE(every_wanted_sample_lies_in_one_run_of_its_place,
                     bdata::make({1, 2, 3, 16, 64, 3000}) *
                         bdata::make({Frequencies::rising, Frequencies::falling, Frequencies::mixed}) *
                         bdata::make({true, false}),
                     channels, frequencies, weighted) {
  const ImageGeometry geometry{90, 80, 1e-4, {}};
  const StackShape shape{160, 144, 7, 32};
  const StackOrderOptions options{shape, 5, StackScale(shape, split_into_facets(geometry, 2, 1).front(), 300), 2};
  const auto n = static_cast<std::size_t>(channels);
  const VisibilityBlock block = random_block(n > 100 ? 20 : 5000, n, frequencies, 1);
  const StackOrder order = order_for_stack({{&block, weighted ? block.weight.data() : nullptr}}, options);
  std::vector<int> seen(block.samples());
  bool placed = true;
  for (std::size_t tile = 0; tile + 1 < order.begin.size(); ++tile)
    for (std::size_t r = order.begin[tile]; r < order.begin[tile + 1]; ++r) {
      const StackRun& run = order.run[r];
      const StackRow row(&block.uvw_m[std::size_t{3} * run.row], false, options.scale);
      std::vector<double> periods;
      for (std::size_t c = run.first; c < std::size_t{run.first} + run.count; ++c) {
        ++seen[run.row * n + c];
        std::int32_t of_tile = 0, plane = 0, mirrored = -1;
        double period = 0;
        first_taps(row, shape, options.width_w, &block.frequency_hz[c], 1, {&of_tile, &plane, &mirrored, &period});
        periods.push_back(period);
        placed = placed && static_cast<std::size_t>(of_tile) == tile && plane == run.plane &&
                 mirrored == static_cast<std::int32_t>(run.mirrored);
      }
      placed = placed && std::all_of(periods.begin(), periods.end(), [&](double p) { return p == periods.front(); });
      placed = placed && (r == order.begin[tile] || order.run[r - 1].plane <= run.plane);
    }
  BOOST_TEST(placed);
  bool once = true;
  for (std::size_t i = 0; i < seen.size(); ++i) once = once && seen[i] == (weighted && block.weight[i] == 0 ? 0 : 1);
  BOOST_TEST(once);
}

BOOST_AUTO_TEST_SUITE_END()
