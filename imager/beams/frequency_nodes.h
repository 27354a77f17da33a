#pragma once

#include <functional>
#include <vector>

namespace misfit::imager {

/// A span of frequencies in which a smooth function follows, by a polynomial, from its values at a few nodes.
struct FrequencySpan {
  double low_hz = 0;
  double high_hz = 0;
  std::vector<double> node_hz;  ///< ascending

  /// True where the nodes are all the frequencies that the span was made for.
  bool is_exact() const { return node_hz.front() == low_hz && node_hz.back() == high_hz; }
  bool holds(double frequency_hz) const { return frequency_hz >= low_hz && frequency_hz <= high_hz; }
  /// The weight of the value at each node at a frequency: Lagrange's formula.
  std::vector<double> weights(double frequency_hz) const;
};

/// Values at a frequency, always of the same number. A value that is NaN at a frequency of a span is ignored in this span.
using ValuesAtFrequency = std::function<std::vector<double>(double frequency_hz)>;

/// The fewest spans and nodes found from which `values` follow at all of these frequencies, in any order, to `tolerance`:
/// Chebyshev's points of ever shorter spans, or the frequencies themselves where they are few. Values may step between two
/// spans. The more nodes a span may have, the fewer spans there are.
std::vector<FrequencySpan> frequency_spans(std::vector<double> frequency_hz, const ValuesAtFrequency& values, double tolerance,
                                           std::size_t most_nodes = 12);

}  // namespace misfit::imager
