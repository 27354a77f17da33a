#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include "ms_io/field_shift_internal.h"

namespace misfit::ms_io {

FieldShift::FieldShift() : FieldShift(imager::PhaseShift()) {}

FieldShift::FieldShift(const imager::PhaseShift& always) : table_(std::make_shared<const Table>(Table{{{0, always}}, false})) {}

FieldShift::FieldShift(List list) {
  std::sort(list.begin(), list.end(), [](const auto& a, const auto& b) { return earlier(a.time_s, b.time_s); });
  table_ = std::make_shared<const Table>(Table{std::move(list), true});
}

void FieldShift::append(const double* time_s, std::size_t rows, imager::RowShifts& to) const {
  const List& list = table_->list;
  if (!moves()) return to.append(list.front().shift, rows);
  for (std::size_t r = 0; r < rows; ++r) {
    const auto found = std::lower_bound(list.begin(), list.end(), time_s[r],
                                        [](const TimedShift& one, double other_s) { return earlier(one.time_s, other_s); });
    if (found == list.end() || earlier(time_s[r], found->time_s))
      throw std::runtime_error("a row has TIME " + std::to_string(time_s[r]) +
                               " s, which no row had when its MeasurementSet was opened");
    to.append(found->shift, 1);
  }
}

}  // namespace misfit::ms_io
