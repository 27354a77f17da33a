#pragma once

#include <cmath>
#include <cstddef>
#include <memory>
#include <vector>

#include "imager/data/phase_shift.h"

namespace misfit::ms_io {

/// Whether one time comes before another; none does after one that is no number.
inline bool earlier(double one_s, double other_s) {
  return std::isnan(other_s) ? !std::isnan(one_s) : one_s < other_s;
}

/// The way of the visibilities of a field to the phase centre of the image: one at all times, or, where either moves, one at
/// each time. Copies share the list.
class FieldShift {
 public:
  /// None.
  FieldShift();
  explicit FieldShift(const imager::PhaseShift& always);
  /// At a TIME, as the set stores it.
  struct TimedShift {
    double time_s = 0;
    imager::PhaseShift shift;
  };
  using List = std::vector<TimedShift>;
  /// At different times, of which one may be no number.
  explicit FieldShift(List list);

  /// Whether it depends on time.
  bool moves() const { return table_->moves; }
  /// Appends those of `rows` rows that were observed at time_s[0], time_s[1], …; null where it does not move. Throws
  /// std::runtime_error for a time that is not in the list, which the set had not when it was opened. They live as long as
  /// this.
  void append(const double* time_s, std::size_t rows, imager::RowShifts& to) const;

 private:
  struct Table {
    List list;  ///< earliest first; or the one of all times
    bool moves = false;
  };

  std::shared_ptr<const Table> table_;
};

}  // namespace misfit::ms_io
