#include "imager/beams/frequency_nodes.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "imager/numerics/constants.h"

namespace misfit::imager {
namespace {

/// Frequencies with the values at each, of which ranges are looked at.
struct Known {
  std::vector<double> hz;
  std::vector<std::vector<double>> values;
  std::size_t most_nodes;  ///< of a span
};

/// The known frequencies from `begin` on, before `end`.
struct Part {
  std::size_t begin;
  std::size_t end;

  std::size_t count() const { return end - begin; }
};

std::vector<double> chebyshev_points(double low, double high, std::size_t count) {
  std::vector<double> points;
  for (std::size_t k = count; k-- > 0;)
    points.push_back((low + high) / 2 +
                     (high - low) / 2 * std::cos(pi * (static_cast<double>(k) + 0.5) / static_cast<double>(count)));
  return points;
}

bool is_true(const FrequencySpan& span, const Known& known, Part part, const ValuesAtFrequency& values, double tolerance) {
  std::vector<std::vector<double>> at_node;
  for (const double hz : span.node_hz) at_node.push_back(values(hz));
  const auto is_left_out = [&](std::size_t v) {
    const auto is_nan = [v](const std::vector<double>& at) { return std::isnan(at[v]); };
    return std::any_of(at_node.begin(), at_node.end(), is_nan) ||
           std::any_of(known.values.begin() + static_cast<std::ptrdiff_t>(part.begin),
                       known.values.begin() + static_cast<std::ptrdiff_t>(part.end), is_nan);
  };
  for (std::size_t i = part.begin; i < part.end; ++i) {
    const std::vector<double> weight = span.weights(known.hz[i]);
    for (std::size_t v = 0; v < known.values[i].size(); ++v) {
      double sum = 0;
      for (std::size_t k = 0; k < weight.size(); ++k) sum += weight[k] * at_node[k][v];
      if (std::abs(sum - known.values[i][v]) > tolerance && !is_left_out(v)) return false;
    }
  }
  return true;
}

/// The span of a part with the fewest nodes that are enough; without nodes where that takes too many, except for two
/// frequencies or one.
FrequencySpan span_of(const Known& known, Part part, const ValuesAtFrequency& values, double tolerance) {
  FrequencySpan span{known.hz[part.begin], known.hz[part.end - 1], {}};
  for (std::size_t nodes = 1; nodes <= known.most_nodes && nodes < part.count(); ++nodes) {
    span.node_hz = chebyshev_points(span.low_hz, span.high_hz, nodes);
    if (is_true(span, known, part, values, tolerance)) return span;
  }
  span.node_hz.clear();
  if (part.count() <= 2)
    span.node_hz.assign(known.hz.begin() + static_cast<std::ptrdiff_t>(part.begin),
                        known.hz.begin() + static_cast<std::ptrdiff_t>(part.end));
  return span;
}

/// The longest span from `begin` on, looked for by doubling and halving steps.
FrequencySpan longest_span(const Known& known, std::size_t begin, const ValuesAtFrequency& values, double tolerance) {
  FrequencySpan longest = span_of(known, {begin, begin + 1}, values, tolerance);
  std::size_t end = begin + 1;
  bool grows = true;
  for (std::size_t step = 1; step > 0;) {
    const std::size_t farther = std::min(end + step, known.hz.size());
    FrequencySpan next = farther > end ? span_of(known, {begin, farther}, values, tolerance) : FrequencySpan();
    if (!next.node_hz.empty()) {
      longest = std::move(next);
      end = farther;
    } else {
      grows = false;
    }
    step = grows ? 2 * step : step / 2;
  }
  return longest;
}

}  // namespace

std::vector<double> FrequencySpan::weights(double frequency_hz) const {
  std::vector<double> weight(node_hz.size(), 1);
  for (std::size_t k = 0; k < node_hz.size(); ++k)
    for (std::size_t j = 0; j < node_hz.size(); ++j)
      if (j != k) weight[k] *= (frequency_hz - node_hz[j]) / (node_hz[k] - node_hz[j]);
  return weight;
}

std::vector<FrequencySpan> frequency_spans(std::vector<double> frequency_hz, const ValuesAtFrequency& values, double tolerance,
                                           std::size_t most_nodes) {
  if (frequency_hz.empty()) throw std::invalid_argument("no frequency; expected at least one");
  std::sort(frequency_hz.begin(), frequency_hz.end());
  frequency_hz.erase(std::unique(frequency_hz.begin(), frequency_hz.end()), frequency_hz.end());
  Known known{frequency_hz, {}, most_nodes};
  for (const double hz : frequency_hz) known.values.push_back(values(hz));
  std::vector<FrequencySpan> spans;
  for (std::size_t begin = 0; begin < known.hz.size();) {
    spans.push_back(longest_span(known, begin, values, tolerance));
    begin =
        static_cast<std::size_t>(std::upper_bound(known.hz.begin(), known.hz.end(), spans.back().high_hz) - known.hz.begin());
  }
  return spans;
}

}  // namespace misfit::imager
