#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include "ms_io/field_shift_internal.h"

namespace misfit::ms_io {

FieldShift::FieldShift() : FieldShift(imager::PhaseShift()) {}

FieldShift::FieldShift(const imager::PhaseShift& always) : FieldShift({}, {always}) {}

FieldShift::FieldShift(std::vector<double> time_s, std::vector<imager::PhaseShift> shift)
    : table_(std::make_shared<const Table>(Table{std::move(time_s), std::move(shift)})) {}

void FieldShift::append(const double* time_s, std::size_t rows, imager::RowShifts& to) const {
  const auto& [times, shifts] = *table_;
  if (times.empty()) return to.append(shifts.front(), rows);
  for (std::size_t r = 0; r < rows; ++r) {
    const auto found = std::lower_bound(times.begin(), times.end(), time_s[r]);
    if (found == times.end() || *found != time_s[r])
      throw std::runtime_error("a row has TIME " + std::to_string(time_s[r]) +
                               " s, which no row had when its MeasurementSet was opened");
    to.append(shifts[static_cast<std::size_t>(found - times.begin())], 1);
  }
}

}  // namespace misfit::ms_io
