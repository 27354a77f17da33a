#pragma once

#include <cstddef>
#include <vector>

#include "imager/clean/minor_cycle.h"
#include "imager/clean/psf_core.h"
#include "imager/data/image.h"
#include "imager/data/noise.h"

namespace misfit::imager {

/// The level for a search down to `stop_jy` among pixels of a residual, where sidelobes outside the core of the PSF are up to
/// `largest_outside`: half of that (fainter pixels hardly rise above it before all are chosen anew), what these sidelobes make
/// of the peak, or, a 4096th of the peak higher at most, above which no more than `most` pixels lie; the highest of these.
double active_level(const Image& residual, double stop_jy, double largest_outside, std::size_t most);

/// The brightest pixels of a residual, from which alone components are taken, and only as far as the core of the PSF reaches
/// (Clark 1980, A&A 89, 377). What they miss of a component is at most its flux × PsfCore::largest_outside().
class ActivePixels {
 public:
  /// The pixels of `residual` above the active_level of a search down to `stop_jy`. NaN is left out. `core` must outlive this.
  ActivePixels(const Image& residual, double stop_jy, const PsfCore& core, std::size_t most = fit_a_cache);

  static constexpr std::size_t fit_a_cache = 65536;

  const PsfCore& core() const { return core_; }
  /// No pixel left out is brighter.
  double level_jy() const { return level_jy_; }
  /// The brightest, the first in row-major order among equals; of value 0 where there are none.
  Peak peak() const;
  /// Takes factor × the PSF's core at a pixel off them.
  void subtract(int row, int column, float factor);

 private:
  /// Those of one row: from first to the next row's.
  struct Row {
    std::size_t first = 0;
    float peak = -1;  ///< largest magnitude; −1 where there are none
  };
  void find_peak_of(std::size_t row);

  const PsfCore& core_;
  double level_jy_ = 0;
  std::vector<Row> row_;  ///< one more than rows
  std::vector<int> column_;
  std::vector<float> value_;
};

struct ActiveSearch {
  double gain = 0.1;
  double stop_jy = 0;      ///< ends when no pixel exceeds it
  int scale = 0;           ///< of the components
  double flux_per_jy = 1;  ///< of a component, by what it takes off its pixel in Jy/beam
};

/// Finds components, one at least, until no active pixel exceeds stop_jy, or what the others may have become by now: level_jy()
/// and the largest sidelobe outside the core times all that was taken. Also ends when the peak has grown to
/// minor_cycle_divergence times the first, and at the limits that `watch` knows.
void find_among(ActivePixels& active, const ActiveSearch& search, const MinorCycleWatch& watch, MinorCycleReport& report);

}  // namespace misfit::imager
