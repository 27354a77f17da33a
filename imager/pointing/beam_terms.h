#pragma once

#include <cstddef>
#include <vector>

#include "imager/beams/frequency_nodes.h"

namespace misfit::imager {

/// A span of frequencies over which a beam is B(θ, ν) = Σ_k T_k(x) t_k(θ), with Chebyshev's polynomials T_k of x, which is −1
/// at the lowest frequency and 1 at the highest. It is the polynomial through the beams at the span's nodes. Its terms t_k fall
/// fast with k, and |T_k| ≤ 1: those of high k need be known, in parts of themselves, the less exactly.
class BeamSpan : public FrequencySpan {
 public:
  explicit BeamSpan(FrequencySpan span);

  std::size_t terms() const { return node_hz.size(); }
  /// T_k at a frequency, of the first `count` terms.
  std::vector<double> shares(double frequency_hz, std::size_t count) const;
  /// By how much the beam at each node counts in a term.
  const std::vector<double>& of_nodes(std::size_t term) const { return of_nodes_[term]; }

 private:
  double position(double frequency_hz) const;

  std::vector<std::vector<double>> of_nodes_;  ///< [term][node]
};

}  // namespace misfit::imager
