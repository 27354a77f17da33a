#include "ms_io/stokes.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <stdexcept>

namespace misfit::ms_io {

BOOST_AUTO_TEST_SUITE(stokes)

BOOST_AUTO_TEST_CASE(stokes_i_is_found_in_linear_circular_and_stokes_products) {
  const auto indices = [](const std::vector<int>& types) {
    const StokesI recipe = stokes_i(types);
    return std::vector<std::size_t>{recipe.correlations, recipe.first, recipe.second};
  };
  BOOST_TEST(indices({9, 12}) == (std::vector<std::size_t>{2, 0, 1}), boost::test_tools::per_element());
  BOOST_TEST(indices({12, 9}) == (std::vector<std::size_t>{2, 1, 0}), boost::test_tools::per_element());
  BOOST_TEST(indices({9, 10, 11, 12}) == (std::vector<std::size_t>{4, 0, 3}), boost::test_tools::per_element());
  BOOST_TEST(indices({5, 8, 6, 7}) == (std::vector<std::size_t>{4, 0, 1}), boost::test_tools::per_element());
  BOOST_TEST(indices({1, 2, 3, 4}) == (std::vector<std::size_t>{4, 0, 0}), boost::test_tools::per_element());
  BOOST_TEST(indices({1}) == (std::vector<std::size_t>{1, 0, 0}), boost::test_tools::per_element());
}

BOOST_AUTO_TEST_CASE(one_hand_alone_does_not_make_stokes_i) {
  for (const std::vector<int>& types : std::vector<std::vector<int>>{{9}, {12}, {10}, {5, 6}, {9, 8}, {2, 3}, {}}) {
    BOOST_CHECK_THROW(stokes_i(types), std::runtime_error);
  }
}

BOOST_AUTO_TEST_CASE(vectorised_stokes_i_equals_its_definition) {
  // Random mixtures of usable and unusable samples, for lengths that do and do not fill vector registers.
  std::mt19937 generator(7);
  constexpr float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  const auto number = [&] {
    const auto kind = generator() % 12;
    return kind == 0 ? nan : kind == 1 ? inf : kind == 2 ? 0.0F : kind == 3 ? -1.0F : 1 + static_cast<float>(generator() % 100);
  };
  for (const StokesI& recipe : {StokesI{1, 0, 0}, StokesI{2, 0, 1}, StokesI{2, 1, 0}, StokesI{3, 0, 2}, StokesI{4, 0, 3}}) {
    for (const bool per_channel : {false, true}) {
      for (std::size_t channels = 1; channels < 40; ++channels) {
        const std::size_t n = channels * recipe.correlations;
        std::vector<std::complex<float>> data(n), visibility(channels);
        std::vector<float> weight(n), formed_weight(channels);
        const std::unique_ptr<bool[]> flag(new bool[n]);
        for (std::size_t i = 0; i < n; ++i) {
          data[i] = {number(), number()};
          weight[i] = number();
          flag[i] = generator() % 8 == 0;
        }
        imager::SampleCounts counts, expected;
        form_stokes_i(recipe, {data.data(), flag.get(), weight.data(), per_channel, true, channels},
                      {visibility.data(), formed_weight.data()}, counts);
        for (std::size_t c = 0; c < channels; ++c) {
          const std::size_t a = c * recipe.correlations + recipe.first, b = c * recipe.correlations + recipe.second;
          const float wa = per_channel ? weight[a] : weight[recipe.first];
          const float wb = per_channel ? weight[b] : weight[recipe.second];
          const float sum = data[a].real() + data[a].imag() + data[b].real() + data[b].imag() + wa + wb;
          std::complex<float> v = 0;
          double w = 0;
          if (flag[a] || flag[b]) {
            ++expected.flagged;
          } else if (!std::isfinite(sum)) {
            ++expected.nonfinite;
          } else if (!(wa > 0 && wb > 0)) {
            ++expected.zero_weight;
          } else {
            ++expected.used;
            v = (data[a] + data[b]) / 2.0F;
            w = a == b ? wa : 1 / (1 / static_cast<double>(wa) + 1 / static_cast<double>(wb));
          }
          BOOST_TEST(visibility[c] == v);
          BOOST_TEST(std::abs(formed_weight[c] - w) <= 3e-7 * w);  // four roundings of 2^-24 each
        }
        BOOST_TEST(counts.flagged == expected.flagged);
        BOOST_TEST(counts.nonfinite == expected.nonfinite);
        BOOST_TEST(counts.zero_weight == expected.zero_weight);
        BOOST_TEST(counts.used == expected.used);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(extreme_values_do_not_overflow) {
  constexpr float huge = std::numeric_limits<float>::max();
  const std::vector<std::complex<float>> data = {{huge, -huge}, {huge, -huge}};
  const std::vector<float> weight = {huge, huge};
  const bool flag[] = {false, false};
  std::complex<float> visibility;
  float formed_weight = 0;
  imager::SampleCounts counts;
  form_stokes_i({2, 0, 1}, {data.data(), flag, weight.data(), false, true, 1}, {&visibility, &formed_weight}, counts);
  BOOST_TEST(visibility == data[0]);
  BOOST_TEST(formed_weight == huge / 2);
  BOOST_TEST(counts.used == 1U);
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace misfit::ms_io
