#include "imager/pointing/beam_terms.h"

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cmath>

BOOST_AUTO_TEST_SUITE(beam_terms)

using namespace misfit::imager;

namespace {

constexpr int directions = 60;

/// What beams of a shape are in directions, as wide as the wavelength.
template <typename Shape>
ValuesAtFrequency beams(const Shape& shape) {
  return [shape](double hz) {
    std::vector<double> values;
    for (int d = 0; d <= directions; ++d) values.push_back(shape(double(d) / directions * hz / 1e9, hz));
    return values;
  };
}

std::vector<double> frequencies(double low, double high, int count) {
  std::vector<double> all;
  for (int c = 0; c < count; ++c) all.push_back(low + (high - low) * c / std::max(1, count - 1));
  return all;
}

/// How far what follows from a span's terms is from the beams.
double difference(const BeamSpan& span, const ValuesAtFrequency& seen, double hz) {
  std::vector<double> left = seen(hz);
  const std::vector<double> share = span.shares(hz);
  for (std::size_t k = 0; k < span.terms(); ++k)
    for (std::size_t j = 0; j < span.node_hz().size(); ++j) {
      const std::vector<double> node = seen(span.node_hz()[j]);
      for (std::size_t v = 0; v < left.size(); ++v) left[v] -= share[k] * span.of_nodes(k)[j] * node[v];
    }
  return std::abs(*std::max_element(left.begin(), left.end(), [](double a, double b) { return std::abs(a) < std::abs(b); }));
}

double gauss(double x, double) {
  return std::exp(-4 * x * x);
}

}  // namespace

BOOST_AUTO_TEST_CASE(beams_follow_from_their_terms_to_the_tolerance) {
  for (const double tolerance : {1e-3, 1e-6, 1e-9})
    for (const double high : {1.02e9, 1.5e9, 2e9}) {
      const ValuesAtFrequency seen = beams(gauss);
      const std::vector<double> hz = frequencies(1e9, high, 40);
      const std::vector<BeamSpan> spans = beam_spans(hz, seen, tolerance);
      BOOST_TEST(spans.size() == 1U);
      const BeamSpan& span = spans.front();
      BOOST_TEST(span.node_hz().size() == span.terms());
      for (const double at : hz) {
        BOOST_TEST(difference(span, seen, at) < 1.01 * tolerance);
        for (const double share : span.shares(at)) BOOST_TEST(std::abs(share) < 1 + 1e-9);
      }
      for (std::size_t k = 1; k < span.terms(); ++k) BOOST_TEST(span.sizes()[k] < span.sizes()[k - 1]);
      BOOST_TEST(span.sizes().back() < 1e3 * tolerance);                        // no more terms than are of use
      BOOST_TEST(difference(span, seen, (hz[7] + hz[8]) / 2) < 2 * tolerance);  // which it was not made for
    }
}

/// Beams of few parameters have as few terms, however these change with frequency.
BOOST_AUTO_TEST_CASE(polynomials_whose_coefficients_step_have_as_many_terms_as_coefficients) {
  const ValuesAtFrequency seen = beams([](double x, double hz) {
    const double bent = hz < 1.3e9 ? 0.2 : 0.23;
    return 1 - 0.6 * x * x + bent * std::pow(x, 4);
  });
  const std::vector<double> hz = frequencies(1e9, 2e9, 100);
  const std::vector<BeamSpan> spans = beam_spans(hz, seen, 1e-10);
  BOOST_TEST(spans.size() == 1U);
  BOOST_TEST(spans.front().terms() == 3U);
  for (const double at : hz) BOOST_TEST(difference(spans.front(), seen, at) < 1e-10);
}

BOOST_AUTO_TEST_CASE(what_takes_too_many_terms_is_split) {
  const ValuesAtFrequency seen = beams([](double x, double) { return std::cos(20 * x); });
  const std::vector<double> hz = frequencies(1e9, 2e9, 64);
  const std::vector<BeamSpan> spans = beam_spans(hz, seen, 1e-7, 6);
  BOOST_TEST(spans.size() > 1U);
  for (const double at : hz) {
    const auto holds = [at](const BeamSpan& span) { return span.holds(at); };
    BOOST_TEST(std::count_if(spans.begin(), spans.end(), holds) == 1);
    const auto span = std::find_if(spans.begin(), spans.end(), holds);
    BOOST_TEST(span->terms() <= 6U);
    BOOST_TEST(difference(*span, seen, at) < 1e-7);
  }
}

BOOST_AUTO_TEST_CASE(one_frequency_has_the_beam_itself) {
  const BeamSpan span(1.4e9);
  BOOST_TEST(span.terms() == 1U);
  BOOST_TEST(span.shares(1.4e9).front() == 1);
  BOOST_TEST(span.of_nodes(0).front() == 1);
  const std::vector<BeamSpan> spans = beam_spans({1.4e9, 1.4e9}, beams(gauss), 1e-6);
  BOOST_TEST(spans.size() == 1U);
  BOOST_TEST(spans.front().terms() == 1U);
  BOOST_TEST(difference(spans.front(), beams(gauss), 1.4e9) < 1e-12);
}

BOOST_AUTO_TEST_SUITE_END()
