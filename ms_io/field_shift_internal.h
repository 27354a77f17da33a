#pragma once

#include <cmath>
#include <cstddef>
#include <memory>
#include <vector>

#include "imager/data/phase_shift.h"

namespace misfit::ms_io {

/// True if one time comes before another; a time that is no number comes last.
inline bool earlier(double one_s, double other_s) {
  return std::isnan(other_s) ? !std::isnan(one_s) : one_s < other_s;
}

/// The shift of the visibilities of a field to the phase centre of the image: one for all times, or, where either moves, one
/// for each time. Copies share the list.
class FieldShift {
 public:
  /// No shift.
  FieldShift();
  explicit FieldShift(const imager::PhaseShift& always);
  /// A shift at a TIME, as the set stores it.
  struct TimedShift {
    double time_s = 0;
    imager::PhaseShift shift;
  };
  using List = std::vector<TimedShift>;
  /// Shifts at different times, of which one may be no number.
  explicit FieldShift(List list);

  /// True if it depends on time.
  bool moves() const { return table_->moves; }
  /// Appends the shifts of `rows` rows that were observed at time_s[0], time_s[1], …; `time_s` may be null where it does not
  /// move. The shifts live as long as this. Throws std::runtime_error for a time that is not in the list, as no row had it when
  /// the set was opened.
  void append(const double* time_s, std::size_t rows, imager::RowShifts& to) const;

 private:
  struct Table {
    List list;  ///< earliest first; or the one of all times
    bool moves = false;
  };

  std::shared_ptr<const Table> table_;
};

}  // namespace misfit::ms_io
