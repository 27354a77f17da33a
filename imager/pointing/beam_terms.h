#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <vector>

#include "imager/beams/frequency_nodes.h"

namespace misfit::imager {

/// A span of frequencies over which beams are B(θ, ν) = Σ_k s_k(ν) t_k(θ): few terms t_k, of which each is a sum of the beams
/// at a few of the frequencies, its nodes. Terms come by what they explain of all beams, and fall fast; shares |s_k| are 1 at
/// most at the frequencies that the span was made for. Those that come late need be known, in parts of themselves, the less
/// exactly.
class BeamSpan {
 public:
  /// Makes the span of one frequency alone, whose one term is the beam.
  explicit BeamSpan(double frequency_hz);

  bool holds(double frequency_hz) const { return frequency_hz >= low_hz_ && frequency_hz <= high_hz_; }
  std::size_t terms() const { return of_nodes_.size(); }
  const std::vector<double>& node_hz() const { return node_hz_; }
  /// By how much the beam at each node counts in a term.
  const std::vector<double>& of_nodes(std::size_t term) const { return of_nodes_[term]; }
  /// [term]: the RMS of its values.
  const std::vector<double>& sizes() const { return sizes_; }
  /// [term]: s_k at one of the frequencies that the span was made for; at others what fits the beams there best.
  std::vector<double> shares(double frequency_hz) const;

 private:
  friend class SpanMaker;
  BeamSpan() = default;

  double low_hz_ = 0;
  double high_hz_ = 0;
  std::vector<double> node_hz_;
  std::vector<std::vector<double>> of_nodes_;  ///< [term][node]
  std::vector<double> sizes_;
  ValuesAtFrequency seen_;
  std::vector<std::vector<double>> share_of_seen_;  ///< [term][value]: by how much it counts in a share
  std::map<double, std::vector<double>> share_;     ///< at the frequencies that the span was made for
};

/// Terms that a span has at most.
inline constexpr std::size_t most_terms_of_a_span = 16;

/// The fewest spans that were found, of `most_terms` terms at most each, by which `seen` follows at all of these frequencies to
/// `tolerance`: what beams are in directions enough, always the same. Nodes are found one by one, each where what the others
/// explain leaves most; terms are the principal components of what they span.
std::vector<BeamSpan> beam_spans(std::vector<double> frequency_hz, const ValuesAtFrequency& seen, double tolerance,
                                 std::size_t most_terms = most_terms_of_a_span);

}  // namespace misfit::imager
