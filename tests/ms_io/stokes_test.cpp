#include "ms_io/stokes.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <stdexcept>

namespace misfit::ms_io {

BOOST_AUTO_TEST_SUITE(stokes)

namespace {

using imager::parse_stokes;
using imager::Stokes;

using Complex = std::complex<double>;

/// What a feed pair measures of a source (I, Q, U, V): the definitions in stokes.h.
Complex correlation(Stokes type, const std::array<Complex, 4>& s) {
  const Complex i(0, 1);
  switch (type) {
    case Stokes::XX:
      return s[0] + s[1];
    case Stokes::XY:
      return s[2] + i * s[3];
    case Stokes::YX:
      return s[2] - i * s[3];
    case Stokes::YY:
      return s[0] - s[1];
    case Stokes::RR:
      return s[0] + s[3];
    case Stokes::RL:
      return s[1] + i * s[2];
    case Stokes::LR:
      return s[1] - i * s[2];
    case Stokes::LL:
      return s[0] - s[3];
    default:
      return s[static_cast<std::size_t>(type) - 1];
  }
}

/// What a recipe makes of the correlations of one channel, with weight 1 each unless given.
struct Formed {
  std::vector<std::complex<float>> visibility;
  float weight = 0;
  imager::SampleCounts counts;

  Formed(const StokesRecipe& recipe, const std::vector<std::complex<float>>& data, std::vector<float> weights = {})
      : visibility(recipe.terms.size()) {
    if (weights.empty()) weights.assign(data.size(), 1);
    const std::unique_ptr<bool[]> flag(new bool[data.size()]());
    StokesSamples out;
    for (std::size_t s = 0; s < visibility.size(); ++s) out.visibility[s] = &visibility[s];
    out.weight = &weight;
    form_stokes(recipe, {data.data(), flag.get(), weights.data(), false, true, 1}, out, counts);
  }
};

std::string refusal(const std::vector<int>& types, const std::string& wanted) {
  try {
    stokes_recipe(types, parse_stokes(wanted));
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

const std::vector<std::vector<int>> linear_orders = {{9, 10, 11, 12}, {12, 11, 10, 9}, {9, 12, 10, 11}};
const std::vector<std::vector<int>> circular_orders = {{5, 6, 7, 8}, {5, 8, 7, 6}, {8, 5, 6, 7}};

}  // namespace

BOOST_AUTO_TEST_CASE(what_is_formed_is_what_the_feeds_measured_in_any_order) {
  const std::array<Complex, 4> source = {Complex(4, 0.5), {1, -2}, {-0.25, 3}, {0.75, 1.5}};  // exact in single precision
  std::vector<std::vector<int>> orders = linear_orders;
  orders.insert(orders.end(), circular_orders.begin(), circular_orders.end());
  orders.push_back({1, 2, 3, 4});
  orders.push_back({4, 1, 3, 2});
  for (const std::vector<int>& types : orders) {
    std::vector<std::complex<float>> data;
    std::vector<Stokes> stored;
    for (const int type : types) {
      stored.push_back(static_cast<Stokes>(type));
      data.emplace_back(correlation(stored.back(), source));
    }
    for (const char* wanted : {"I", "Q", "U", "V", "IQUV", "IV", "QU"}) {
      const Formed formed(stokes_recipe(types, parse_stokes(wanted)), data);
      for (std::size_t s = 0; s < formed.visibility.size(); ++s)
        BOOST_TEST(formed.visibility[s] == std::complex<float>(correlation(parse_stokes(wanted)[s], source)));
      BOOST_TEST(formed.counts.used == 1U);
    }
    for (std::size_t k = 0; k < stored.size(); ++k)
      BOOST_TEST(Formed(stokes_recipe(types, {stored[k]}), data).visibility[0] == data[k]);
  }
}

BOOST_AUTO_TEST_CASE(only_correlations_that_are_needed_take_part) {
  const auto used = [](const std::vector<int>& types, const char* wanted) {
    return stokes_recipe(types, parse_stokes(wanted)).used;
  };
  using Indices = std::vector<std::size_t>;
  BOOST_TEST((used({9, 10, 11, 12}, "I") == Indices{0, 3}));
  BOOST_TEST((used({9, 10, 11, 12}, "QI") == Indices{0, 3}));
  BOOST_TEST((used({9, 10, 11, 12}, "V") == Indices{1, 2}));
  BOOST_TEST((used({5, 8, 6, 7}, "V") == Indices{0, 1}));
  BOOST_TEST((used({5, 8, 6, 7}, "IQUV") == Indices{0, 1, 2, 3}));
  BOOST_TEST((used({5, 8, 6, 7}, "LL") == Indices{1}));
  BOOST_TEST((used({1, 9, 12}, "I") == Indices{0}));
  BOOST_TEST((used({9}, "XX") == Indices{0}));
}

BOOST_AUTO_TEST_CASE(weights_are_a_quarter_of_the_inverse_mean_variance) {
  // Of what is formed from correlations of variance 1/w: |½|² (1/w_1 + 1/w_2) for a Stokes parameter of two.
  const std::vector<float> w = {1, 2, 5, 7};
  const std::vector<int> types = {9, 10, 11, 12};
  const auto weight = [&](const char* wanted) {
    return Formed(stokes_recipe(types, parse_stokes(wanted)), {1, 1, 1, 1}, w).weight;
  };
  const double in_i = (1 / 1.0 + 1 / 7.0) / 4, in_u = (1 / 2.0 + 1 / 5.0) / 4;
  constexpr double rounding = 4e-7;  // of some operations in single precision, 6e-8 each
  for (const auto& [wanted, variance] : std::vector<std::pair<const char*, double>>{
           {"I", in_i}, {"IQ", in_i}, {"UV", in_u}, {"IQUV", (in_i + in_u) / 2}, {"YX", 1 / 5.0}, {"XXYY", (1 + 1 / 7.0) / 2}})
    BOOST_TEST(std::abs(weight(wanted) * 4 * variance - 1) < rounding);
  BOOST_TEST(Formed(stokes_recipe({1}, {Stokes::I}), {3}, {2}).weight == 0.5F);
}

BOOST_AUTO_TEST_CASE(what_cannot_be_formed_is_refused_with_the_correlations_there_are) {
  for (const std::vector<int>& types : std::vector<std::vector<int>>{{9}, {12}, {10}, {5, 6}, {9, 8}, {2, 3}, {}})
    BOOST_TEST(!refusal(types, "I").empty());
  BOOST_TEST(refusal({10, 9}, "I") ==
             "Stokes I cannot be formed from correlations XY, XX; it needs XX and YY, RR and LL, or I");
  BOOST_TEST(refusal({9, 12}, "IQUV") ==
             "Stokes U cannot be formed from correlations XX, YY; it needs XY and YX, RL and LR, or U");
  BOOST_TEST(refusal({5, 8}, "XX") == "correlation XX is not among RR, LL");
  BOOST_TEST(refusal({}, "RR") == "correlation RR is not among (none)");
  BOOST_TEST(refusal({9, 12}, "QI").empty());
}

BOOST_AUTO_TEST_CASE(vectorised_forming_equals_its_definition) {
  // Random mixtures of usable and unusable samples, for lengths that do and do not fill vector registers.
  std::mt19937 generator(7);
  constexpr float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  const auto number = [&] {
    const auto kind = generator() % 12;
    return kind == 0 ? nan : kind == 1 ? inf : kind == 2 ? 0.0F : kind == 3 ? -1.0F : 1 + static_cast<float>(generator() % 100);
  };
  const std::vector<std::pair<std::vector<int>, const char*>> cases = {
      {{1}, "I"},          {{9, 12}, "I"},         {{12, 9}, "IQ"},           {{9, 10, 12}, "I"},
      {{8, 5, 6}, "V"},    {{9, 10, 11, 12}, "I"}, {{9, 10, 11, 12}, "IQUV"}, {{9, 10, 11, 12}, "V"},
      {{5, 6, 7, 8}, "U"}, {{5, 8, 6, 7}, "IQUV"}, {{5, 8, 6, 7}, "RRLL"},    {{5, 8, 6, 7}, "LR"}};
  for (const auto& [types, wanted] : cases)
    for (const bool per_channel : {false, true})
      for (std::size_t channels = 1; channels < 600; channels = channels < 40 ? channels + 1 : channels * 2 + 1) {
        const StokesRecipe recipe = stokes_recipe(types, parse_stokes(wanted));
        const std::size_t stride = types.size(), n = channels * stride;
        std::vector<std::complex<float>> data(n);
        std::vector<std::vector<std::complex<float>>> visibility(recipe.terms.size(),
                                                                 std::vector<std::complex<float>>(channels));
        std::vector<float> weight(n), formed_weight(channels);
        const std::unique_ptr<bool[]> flag(new bool[n]);
        for (std::size_t i = 0; i < n; ++i) {
          data[i] = {number(), number()};
          weight[i] = number();
          flag[i] = generator() % 8 == 0;
        }
        imager::SampleCounts counts, expected;
        StokesSamples out;
        for (std::size_t s = 0; s < visibility.size(); ++s) out.visibility[s] = visibility[s].data();
        out.weight = formed_weight.data();
        form_stokes(recipe, {data.data(), flag.get(), weight.data(), per_channel, true, channels}, out, counts);
        std::size_t wrong = 0;
        for (std::size_t c = 0; c < channels; ++c) {
          bool flagged = false, finite = true, weighted = true;
          double variance = 0;
          for (std::size_t i = 0; i < recipe.used.size(); ++i) {
            const std::size_t at = c * stride + recipe.used[i];
            const float w = per_channel ? weight[at] : weight[recipe.used[i]];
            flagged = flagged || flag[at];
            finite = finite && std::isfinite(data[at].real() + data[at].imag() + w);
            weighted = weighted && w > 0;
            variance += recipe.share[i] / double{w};
          }
          const bool used = !flagged && finite && weighted;
          ++(flagged ? expected.flagged : !finite ? expected.nonfinite : !weighted ? expected.zero_weight : expected.used);
          const double w = used ? 1 / variance : 0;
          wrong += !(std::abs(formed_weight[c] - w) <= 5e-7 * w);  // eight roundings of 2^-24 each
          for (std::size_t s = 0; s < visibility.size(); ++s) {
            std::complex<double> v = 0;
            for (std::size_t i = 0; used && i < recipe.used.size(); ++i)
              v += std::complex<double>(recipe.terms[s][i]) * std::complex<double>(data[c * stride + recipe.used[i]]);
            wrong += visibility[s][c] != std::complex<float>(v);  // small whole numbers: exact
          }
        }
        BOOST_TEST(wrong == 0U);
        BOOST_TEST(counts.flagged == expected.flagged);
        BOOST_TEST(counts.nonfinite == expected.nonfinite);
        BOOST_TEST(counts.zero_weight == expected.zero_weight);
        BOOST_TEST(counts.used == expected.used);
      }
}

BOOST_AUTO_TEST_CASE(extreme_values_do_not_overflow) {
  constexpr float huge = std::numeric_limits<float>::max();
  const std::vector<std::complex<float>> data = {{huge, -huge}, {huge, -huge}};
  const Formed formed(stokes_recipe({9, 12}, {Stokes::I}), data, {huge, huge});
  BOOST_TEST(formed.visibility[0] == data[0]);
  BOOST_TEST(formed.weight == huge / 2);
  BOOST_TEST(formed.counts.used == 1U);
}

BOOST_AUTO_TEST_CASE(either_hand_alone_makes_stokes_i) {
  for (const std::vector<int>& types : std::vector<std::vector<int>>{{9, 10, 11, 12}, {12, 9}, {5, 8}, {8, 7, 6, 5}}) {
    const StokesRecipe recipe = stokes_recipe(types, {Stokes::I}, Hands::either);
    BOOST_TEST_REQUIRE(recipe.used.size() == 2U);
    constexpr std::size_t states = 4;  // usable, flagged, not finite, without weight
    for (std::size_t one = 0; one < states; ++one)
      for (std::size_t other = 0; other < states; ++other)
        for (const bool per_channel : {false, true}) {
          const std::size_t n = types.size();
          std::vector<std::complex<float>> data(n, {7, 7});
          std::vector<float> weights(n, 0);  // crossed hands are not looked at
          const std::unique_ptr<bool[]> flag(new bool[n]());
          std::fill_n(flag.get(), n, true);
          const std::array<std::complex<float>, 2> values{{{3, 1}, {1, -2}}};
          for (std::size_t h = 0; h < 2; ++h) {
            const std::size_t k = recipe.used[h], state = h == 0 ? one : other;
            data[k] = state == 2 ? std::complex<float>(1, std::numeric_limits<float>::infinity()) : values[h];
            weights[k] = state == 3 ? 0.0F : h == 0 ? 2.0F : 6.0F;
            flag[k] = state == 1;
          }
          std::complex<float> visibility;
          float weight = -1;
          StokesSamples out;
          out.visibility[0] = &visibility;
          out.weight = &weight;
          imager::SampleCounts counts;
          form_stokes(recipe, {data.data(), flag.get(), weights.data(), per_channel, true, 1}, out, counts);
          BOOST_TEST_CONTEXT(one << " and " << other) {
            // 1/(4 σ²) with σ² of I: 1/(1/w + 1/w') of both, w/4 of one.
            const std::complex<float> expected = one == 0 && other == 0 ? std::complex<float>(2, -0.5F)
                                                 : one == 0             ? values[0]
                                                 : other == 0           ? values[1]
                                                                        : std::complex<float>(0);
            BOOST_TEST(visibility == expected);
            BOOST_TEST(weight == (one == 0 && other == 0 ? 1.5F : one == 0 ? 0.5F : other == 0 ? 1.5F : 0.0F));
            BOOST_TEST(counts.used == (one == 0 || other == 0 ? 1U : 0U));
            BOOST_TEST(counts.used + counts.flagged + counts.nonfinite + counts.zero_weight == 1U);
          }
        }
  }
}

BOOST_AUTO_TEST_CASE(of_one_hand_that_is_stored_either_is_that) {
  for (const int type : {5, 8, 9, 12}) {
    const Formed formed(stokes_recipe({type}, {Stokes::I}, Hands::either), {{3, -1}}, {2});
    BOOST_TEST(formed.visibility[0] == std::complex<float>(3, -1));
    BOOST_TEST(formed.weight == 0.5F);
  }
  BOOST_CHECK_THROW(stokes_recipe({10, 11}, {Stokes::I}, Hands::either), std::runtime_error);
  const Formed stored(stokes_recipe({1}, {Stokes::I}, Hands::either), {{3, -1}}, {2});
  BOOST_TEST(stored.weight == 0.5F);
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace misfit::ms_io
