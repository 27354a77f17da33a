#pragma once

#include <array>
#include <complex>
#include <vector>

#include "imager/data/geometry.h"
#include "imager/data/phase.h"
#include "imager/data/visibilities.h"

namespace misfit::imager {

/// The unit vectors along u, v and w of a phase centre: to its east, to its north, and towards it. In the equatorial Cartesian
/// coordinates of its frame, x towards right ascension 0 and z towards the north pole.
struct UvwAxes {
  using Vector = std::array<double, 3>;
  Vector u{}, v{}, w{};
};

UvwAxes uvw_axes(const SkyDirection& phase_centre);

/// Rows of a block that follow one another.
struct RowRun {
  std::size_t first = 0;
  std::size_t count = 0;
};

/// The shift of visibilities from one phase centre to another. The baseline b = u e_u + v e_v + w e_w stays as it is and is
/// only seen along other axes; the delay that is taken out changes from b·e_w to b·e_w', so that V' = V exp(2πi(w − w'))
/// without any approximation (Thompson, Moran & Swenson 2017, section 3.1). Both give the same image, seen from different
/// centres.
class PhaseShift {
 public:
  /// No shift.
  PhaseShift() = default;
  PhaseShift(const UvwAxes& from, const UvwAxes& to);

  /// True if it changes nothing.
  bool none() const { return none_; }
  /// Turns UVW [row][3], metres, to the new axes.
  void rotate(std::vector<double>& uvw_m) const { rotate(uvw_m, {0, uvw_m.size() / 3}); }
  void rotate(std::vector<double>& uvw_m, RowRun rows) const;
  /// Shifts the block to the new phase centre. The phasors are right to double precision.
  void apply(VisibilityBlock& block) const { apply(block, {0, block.rows()}); }
  void apply(VisibilityBlock& block, RowRun rows) const;
  /// Visibilities [row][channel] of the new phase centre become those of the old one, where their UVW are `old`.
  void undo(const SampleCoordinates& old, std::vector<std::complex<double>>& visibilities) const {
    undo(old, visibilities, {0, old.rows()});
  }
  void undo(const SampleCoordinates& old, std::vector<std::complex<double>>& visibilities, RowRun rows) const;

 private:
  /// How visibilities turn.
  struct Turn {
    double sign = 1;
    RowRun rows;
  };

  /// Multiplies each visibility [row][channel] of the rows by exp(2πi sign (w' − w)).
  template <typename T>
  void turn(const SampleCoordinates& old, const Turn& how, std::complex<T>* visibilities) const;

  bool none_ = true;
  std::array<UvwAxes::Vector, 3> rotation_{};  ///< the new axes as the old ones see them
  PhasePosition to_;                           ///< the new centre as the old one sees it
};

/// The phase shifts of all rows of a block, each for a run of rows; where a phase centre moves, for the rows of one time.
class RowShifts {
 public:
  /// Gives `rows` further rows this shift, which must outlive this object.
  void append(const PhaseShift& shift, std::size_t rows);

  /// See PhaseShift.
  void rotate(std::vector<double>& uvw_m) const;
  void apply(VisibilityBlock& block) const;
  void undo(const SampleCoordinates& old, std::vector<std::complex<double>>& visibilities) const;

 private:
  struct Run {
    const PhaseShift* shift;
    RowRun rows;
  };

  std::vector<Run> runs_;
};

}  // namespace misfit::imager
