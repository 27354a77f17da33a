#pragma once

#include <cstddef>
#include <vector>

#include "imager/clean/active_pixels.h"
#include "imager/clean/minor_cycle.h"
#include "imager/clean/psf_core.h"
#include "imager/data/image.h"
#include "imager/taylor/taylor_basis.h"

namespace misfit::imager {

/// What spectral PSFs make of Taylor terms at one scale of components: their basis, and the cores of S = L⁻¹ P L⁻ᵀ.
struct TermCores {
  /// Of PSFs P_k [k], convolved twice with the scale. They reach as far as pays for the spectral norm of S, as PsfCore has it.
  TermCores(const std::vector<const Image*>& psf, int threads);

  const PsfCore& at(std::size_t a, std::size_t b) const { return core[a < b ? b * (b + 1) / 2 + a : a * (a + 1) / 2 + b]; }

  TaylorBasis basis;
  int reach = 0;
  double largest_outside = 0;  ///< of the norm of S
  std::vector<PsfCore> core;   ///< of S_ab at a(a+1)/2 + b, b ≤ a
};

/// ActivePixels of several Taylor terms: the brightest pixels, in |y| of TaylorBasis, and their y. Since |S y| ≤ ‖S‖ |y|, what
/// they miss of components of brightness |y| is at most the sum of these × TermCores::largest_outside.
class ActiveTerms {
 public:
  /// The pixels of `brightness` above the active_level of a search down to `stop_jy`; NaN is left out. `residual` [term].
  ActiveTerms(const Image& brightness, const std::vector<const Image*>& residual, const TermCores& cores, double stop_jy,
              std::size_t most);

  /// No pixel left out is brighter.
  double level_jy() const { return level_jy_; }

  struct Bright {
    int row = 0;
    int column = 0;
    double brightness_jy = 0;  ///< |y|
    TaylorValues y{};
  };
  /// The brightest, the first in row-major order among equals; of brightness 0 where there are none.
  Bright peak() const;
  /// Takes off them what a component of coordinates `y` at a pixel makes of them.
  void subtract(int row, int column, const TaylorValues& y);

 private:
  /// Those of one row: from first to the next row's.
  struct Row {
    std::size_t first = 0;
    float peak = -1;  ///< largest |y|²; −1 where there are none
  };
  void find_peak_of(std::size_t row);

  const TermCores& cores_;
  double level_jy_;
  std::vector<Row> row_;  ///< one more than rows
  std::vector<int> column_;
  std::vector<std::vector<float>> y_;  ///< [term][pixel]
  std::vector<float> square_;          ///< |y|² [pixel]
};

/// As find_among of ActivePixels, by their brightness: each component takes `gain` times the principal solution of the
/// brightest pixel.
void find_among(ActiveTerms& active, const TermCores& cores, const ActiveSearch& search, const MinorCycleWatch& watch,
                MinorCycleReport& report);

}  // namespace misfit::imager
