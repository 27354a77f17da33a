#pragma once

#include <cstdint>
#include <vector>

#include "imager/data/visibilities.h"

namespace misfit::imager {

/// How many usable samples lie in each cell of a square of the uv plane; gathered while they stream by. The square reaches
/// `reach_lambda` wavelengths from 0 along either axis; samples beyond are not counted. Adjacent channels whose samples lie
/// no more than a cell apart count in their middle.
class UvCoverage {
 public:
  static constexpr int side = 320;  ///< cells

  /// Without a reach nothing is counted.
  explicit UvCoverage(double reach_lambda = 0);

  void add(const VisibilityBlock& block);
  /// Adds the counts of all other ranks, which have the same reach.
  void add_up(const Ranks& ranks);

  double reach_lambda() const { return reach_lambda_; }
  /// Samples and their mirror images V(−u, −v) = conj V(u, v), row-major [v][u] from −reach_lambda; empty without a reach.
  std::vector<std::uint64_t> counts() const;

 private:
  double reach_lambda_;
  std::vector<std::uint64_t> count_;  ///< [v][u], of the samples as they are stored
};

}  // namespace misfit::imager
