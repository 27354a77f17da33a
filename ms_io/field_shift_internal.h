#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "imager/data/phase_shift.h"

namespace misfit::ms_io {

/// The way of the visibilities of a field to the phase centre of the image: one at all times, or, where either moves, one at
/// each time. Copies share the list.
class FieldShift {
 public:
  /// None.
  FieldShift();
  explicit FieldShift(const imager::PhaseShift& always);
  /// shift[i] at time_s[i], TIME as the set stores it; ascending.
  FieldShift(std::vector<double> time_s, std::vector<imager::PhaseShift> shift);

  /// Whether it depends on time.
  bool moves() const { return !table_->time_s.empty(); }
  /// Appends those of `rows` rows that were observed at time_s[0], time_s[1], …; null where it does not move. Throws
  /// std::runtime_error for a time that is not in the list, which the set had not when it was opened. They live as long as
  /// this.
  void append(const double* time_s, std::size_t rows, imager::RowShifts& to) const;

 private:
  struct Table {
    std::vector<double> time_s;
    std::vector<imager::PhaseShift> shift;  ///< [time], or one
  };

  std::shared_ptr<const Table> table_;
};

}  // namespace misfit::ms_io
