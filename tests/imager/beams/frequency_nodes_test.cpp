#include "imager/beams/frequency_nodes.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <stdexcept>

#include "imager/beams/airy_pattern.h"
#include "imager/beams/telescopes.h"

BOOST_AUTO_TEST_SUITE(frequency_nodes)

using namespace misfit::imager;

namespace {

std::vector<double> channels(double low_hz, double high_hz, int count) {
  std::vector<double> hz;
  for (int c = 0; c < count; ++c) hz.push_back(low_hz + (high_hz - low_hz) * c / std::max(1, count - 1));
  return hz;
}

/// Powers at radii to 1.5 degrees, these or those between.
enum class Radii { these, between };
ValuesAtFrequency powers(const Pattern& pattern, Radii radii = Radii::these) {
  return [pattern, radii](double hz) {
    std::vector<double> values;
    for (int r = 1; r <= 50; ++r) {
      const double sine = 0.026 * (r - (radii == Radii::between ? 0.37 : 0)) / 50;
      values.push_back(sine > pattern->continuous_sine(hz) ? std::nan("") : std::pow(pattern->voltage(sine, hz), 2));
    }
    return values;
  };
}

/// By which values at nodes miss those at any of the frequencies.
double largest_error(const std::vector<FrequencySpan>& spans, const std::vector<double>& frequency_hz,
                     const ValuesAtFrequency& values) {
  double largest = 0;
  for (const double hz : frequency_hz) {
    const auto span = std::find_if(spans.begin(), spans.end(), [hz](const FrequencySpan& s) { return s.holds(hz); });
    BOOST_REQUIRE(span != spans.end());
    const std::vector<double> weight = span->weights(hz), expected = values(hz);
    std::vector<double> sum(expected.size());
    for (std::size_t k = 0; k < weight.size(); ++k) {
      const std::vector<double> at_node = values(span->node_hz[k]);
      for (std::size_t v = 0; v < sum.size(); ++v) sum[v] += weight[k] * at_node[v];
    }
    for (std::size_t v = 0; v < sum.size(); ++v)
      if (!std::isnan(sum[v] - expected[v])) largest = std::max(largest, std::abs(sum[v] - expected[v]));
  }
  return largest;
}

std::size_t nodes(const std::vector<FrequencySpan>& spans) {
  std::size_t count = 0;
  for (const FrequencySpan& span : spans) count += span.node_hz.size();
  return count;
}

}  // namespace

BOOST_AUTO_TEST_CASE(beams_follow_from_a_few_frequencies_to_the_tolerance) {
  const Pattern airy = airy_pattern({25, 2.36}), vla = named_beam("vla", {}).pattern;
  for (const Pattern& pattern : {airy, vla})
    for (const double high_hz : {1.01e9, 1.2e9, 2e9})
      for (const double tolerance : {1e-3, 1e-5, 1e-7}) {
        const std::vector<double> hz = channels(1e9, high_hz, 256);
        const auto spans = frequency_spans(hz, powers(pattern), tolerance);
        BOOST_TEST(largest_error(spans, hz, powers(pattern)) <= tolerance);
        BOOST_TEST(largest_error(spans, hz, powers(pattern, Radii::between)) <= 2 * tolerance);
        // A fit to measured beams changes at once from band to band, every 64 or 128 MHz.
        BOOST_TEST(nodes(spans) <= (pattern == airy ? 24U : 160U));
      }
  const auto narrow = frequency_spans(channels(1e9, 1.01e9, 64), powers(airy), 1e-5);
  BOOST_TEST(nodes(narrow) <= 4U);
}

BOOST_AUTO_TEST_CASE(frequencies_themselves_are_nodes_where_they_are_few) {
  const Pattern airy = airy_pattern({25, 0});
  const auto one = frequency_spans({1.4e9, 1.4e9}, powers(airy), 1e-9);
  BOOST_TEST(one.size() == 1U);
  BOOST_TEST((one.front().node_hz == std::vector<double>{1.4e9}));
  BOOST_TEST((one.front().weights(1.4e9) == std::vector<double>{1}));
  const std::vector<double> apart{3e9, 1e9, 2e9};  // in any order
  const auto spans = frequency_spans(apart, powers(airy), 1e-12);
  BOOST_TEST(largest_error(spans, apart, powers(airy)) < 1e-12);
  BOOST_TEST(nodes(spans) == 3U);
  BOOST_CHECK_THROW(frequency_spans({}, powers(airy), 1e-6), std::invalid_argument);
}

BOOST_AUTO_TEST_SUITE_END()
