#include "tools/run/shared_prediction.h"

#include <atomic>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>
#include <stdexcept>

#include "imager/numerics/parallel.h"
#include "tests/imager/thread_ranks.h"

BOOST_AUTO_TEST_SUITE(shared_prediction)

namespace bdata = boost::unit_test::data;
using namespace misfit;
using namespace misfit::tools;
using imager::testing::ThreadRanks;

namespace {

imager::SampleCoordinates block(std::size_t number) {
  const auto u = static_cast<double>(number);
  return {{u, 2 * u, -u, u + 0.1, 0, 1e-300}, {1e9, 1.5e9 + u}};
}

/// Two of four Stokes parameters, different for each sample.
ms_io::StokesVisibilities predicted(const imager::SampleCoordinates& where) {
  ms_io::StokesVisibilities visibilities;
  for (std::size_t row = 0; row < where.rows(); ++row)
    for (const double hz : where.frequency_hz) {
      visibilities.plane[0].emplace_back(where.uvw_m[3 * row] / 3, hz / 7);
      visibilities.plane[3].emplace_back(where.uvw_m[3 * row + 2], -hz);
    }
  return visibilities;
}

}  // namespace

BOOST_DATA_TEST_CASE(whoever_predicts_a_block_gives_the_same_bits, bdata::make({1, 2, 3, 8}), size) {
  constexpr std::size_t blocks = 50;
  std::vector<ms_io::StokesVisibilities> all(blocks);
  std::vector<std::atomic<int>> asked(static_cast<std::size_t>(size));
  ThreadRanks(size).run([&](const imager::Ranks& ranks) {
    const ms_io::Predict own = [&](const imager::SampleCoordinates& where) {
      ++asked[static_cast<std::size_t>(ranks.rank())];
      return predicted(where);
    };
    SharedPrediction shared(ranks, own);
    if (!ranks.first()) return shared.follow();
    imager::parallel_for(blocks, size, [&](std::size_t i) { all[i] = shared.predict(block(i)); });
    shared.end();
  });
  for (std::size_t i = 0; i < blocks; ++i) BOOST_TEST((all[i].plane == predicted(block(i)).plane));
  int sum = 0;
  for (const auto& times : asked) sum += times;
  BOOST_TEST(sum == static_cast<int>(blocks));
}

BOOST_AUTO_TEST_CASE(one_whose_prediction_fails_leaves_its_turn_to_others) {
  const ms_io::Predict failing = [](const imager::SampleCoordinates&) -> ms_io::StokesVisibilities {
    throw std::runtime_error("no prediction");
  };
  SharedPrediction shared(imager::alone(), failing);
  for (int i = 0; i < 3; ++i) BOOST_CHECK_THROW(shared.predict(block(1)), std::runtime_error);
}

BOOST_AUTO_TEST_SUITE_END()
