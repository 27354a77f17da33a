#pragma once

#include "imager/data/ranks.h"

namespace CLI {
class App;
}

namespace misfit::tools {

/// The machines, not there, that --dry-run makes a forecast for.
struct ScaleOptions {
  int nodes = 0;            ///< machines, a rank on each; 0: nothing is told of any
  double visibilities = 0;  ///< as if the data had so many samples; 0: those that they have
  double network_gb_s = 0;  ///< 10^9 bytes that a node sends, or gets, in a second; 0: of a network of 100 Gbit/s

  double network_bytes_s() const { return network_gb_s > 0 ? network_gb_s * 1e9 : 12.5e9; }
  /// The samples that are planned for over those there are.
  double enlarged(double samples) const { return visibilities > 0 ? visibilities / samples : 1; }
};

void declare(CLI::App& command, ScaleOptions& options);

/// Throws std::invalid_argument that names the option, its value and what was expected.
void check(const ScaleOptions& options, bool dry_run);

/// Throws where the run itself is of several ranks, whose shares are not the nodes' shares.
void check(const ScaleOptions& options, const imager::Ranks& ranks);

}  // namespace misfit::tools
