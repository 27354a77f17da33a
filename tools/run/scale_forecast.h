#pragma once

#include <string>
#include <vector>

#include "tools/run/run_plan.h"

namespace misfit::tools {

/// Seconds of a part of a run on several machines: on each of them at the same time, or on rank 0 alone.
struct NodeSeconds {
  double read = 0;
  double gridding = 0;  ///< and degridding, and all else that is done for each sample
  double fft = 0;
  double exchange = 0;  ///< of images, and of the model
  double first = 0;     ///< rank 0's work while others wait: statistics, minor cycles, files

  double total() const { return read + gridding + fft + exchange + first; }
};

/// How a run shares its work among machines.
struct NodeSharing {
  int nodes = 1;
  int facets = 1;  ///< into which the image is cut; nodes over facets share the samples, each group for one facet
};

/// A run on such machines, which are like this one.
struct NodeForecast {
  NodeSharing sharing;
  NodeSeconds image;        ///< dirty image and PSF, or the channels of a cube, with their files
  NodeSeconds cycle;        ///< a major cycle; none without CLEAN
  bool kept = true;         ///< whether a node has room for its samples, and reads them once
  double read_bytes = 0;    ///< that a node reads in a pass
  double image_bytes = 0;   ///< that rank 0 gets from each rank it hears of, for `image`
  double cycle_bytes = 0;   ///< for `cycle`
  double memory_bytes = 0;  ///< of a node at its peak

  const NodeSeconds& shown(bool clean) const { return clean ? cycle : image; }
};

/// Expects the time of a planned run on several machines. Compute and reading are those of TimeForecast; images are summed on
/// their way from node to node, in pieces that follow each other, over a network of the bandwidth given.
class ScaleForecast {
 public:
  /// Kept by reference, but for `work`, the plan's.
  ScaleForecast(const RunScene& scene, const RunPlan& plan, const TimeForecast& forecast, const RunWork& work);

  /// The forecast of misfit as it is: ranks share samples, or the channels of a cube.
  NodeForecast at(int nodes) const;
  /// The forecast if the image were cut into facets besides, in the square number of them that makes the shown part take the
  /// least time.
  NodeForecast best_facets(int nodes) const;
  /// The smallest power of two of nodes for which twice as many are less than 1.25 times as fast.
  int limit() const;
  /// A line for each of 1, 2, 4 … and the nodes asked for; the number beyond which nodes do not help, and why; what facets
  /// would gain.
  std::string table() const;

 private:
  class Facets;

  RunWork work_of_a_node(int nodes) const;
  NodeForecast channel_forecast(int nodes) const;
  NodeForecast facet_forecast(int nodes, const Facets& facets) const;
  NodeSeconds seconds_of(const RunWork& work) const;
  NodeSeconds cycle_seconds(const RunWork& work) const;
  void set_memory(NodeForecast& forecast, double samples) const;
  double taking_in_seconds(double bytes) const;
  double sum_seconds(int nodes, double bytes) const;
  double tree_seconds(int nodes, double bytes) const;
  std::string row(const NodeForecast& forecast) const;
  std::string why(const NodeForecast& forecast) const;

  const RunScene& scene_;
  const RunPlan& plan_;
  const TimeForecast& forecast_;
  RunWork work_;
  bool clean_;
};

}  // namespace misfit::tools
