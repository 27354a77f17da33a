#include <casacore/tables/Tables/ScalarColumn.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>
#include <utility>

#include "ms_io/field_times_internal.h"
#include "ms_io/row_columns_internal.h"
#include "ms_io/table_access_internal.h"

namespace misfit::ms_io {
namespace {

/// Calls visit(rows) for the selected rows, some at a time.
template <typename Visit>
void for_each_piece(const SelectedRows& selected, const Visit& visit) {
  constexpr std::uint64_t piece_rows = 1 << 16;
  for (const BlockRows& block : selected.blocks)
    for (const Rows& piece : pieces(block.runs, piece_rows)) visit(piece);
}

void sort_once(std::vector<double>& times) {
  std::sort(times.begin(), times.end(), earlier);
  times.erase(std::unique(times.begin(), times.end(), [](double a, double b) { return !earlier(a, b); }), times.end());
}

/// Sorts the times of a field's rows.
void sort_out(const std::string& path, int field, FieldTimes& times) {
  sort_once(times.used);
  sort_once(times.idle);
  if (times.used.empty()) std::swap(times.used, times.idle);
  std::vector<double> others;
  std::set_difference(times.idle.begin(), times.idle.end(), times.used.begin(), times.used.end(), std::back_inserter(others),
                      earlier);
  times.idle = std::move(others);
  if (!std::isfinite(times.used.front()) || !std::isfinite(times.used.back()))
    throw std::runtime_error(path + ": field " + std::to_string(field) +
                             " moves, and all of its rows are flagged and have a TIME that is not finite");
}

}  // namespace

std::map<int, FieldTimes> times_of(const casacore::MeasurementSet& set, const std::string& path, const SelectedRows& selected,
                                   const std::set<int>& fields) {
  std::map<int, FieldTimes> times;
  translated("cannot read TIME, FIELD_ID or FLAG_ROW of " + path, [&] {
    const casacore::ScalarColumn<int> field_column(set, "FIELD_ID");
    const casacore::ScalarColumn<double> time_column(set, "TIME");
    const casacore::ScalarColumn<bool> flag_column(set, "FLAG_ROW");
    casacore::Vector<int> field;
    casacore::Vector<double> time_s;
    casacore::Vector<bool> flagged;
    for_each_piece(selected, [&](const Rows& piece) {
      read(field_column, piece, field);
      read(time_column, piece, time_s);
      read(flag_column, piece, flagged);
      for (std::uint64_t r = 0; r < piece.count(); ++r) {
        if (fields.count(field(r)) == 0) continue;
        if (!flagged(r) && !std::isfinite(time_s(r)))
          throw std::runtime_error(path + ": row " + std::to_string(piece[r]) + " has TIME " + std::to_string(time_s(r)) +
                                   ", and its field " + std::to_string(field(r)) + " moves; expected a finite number");
        FieldTimes& of_field = times[field(r)];
        std::vector<double>& some = flagged(r) ? of_field.idle : of_field.used;
        if (some.empty() || some.back() != time_s(r)) some.push_back(time_s(r));
      }
    });
  });
  for (auto& [field, of_field] : times) sort_out(path, field, of_field);
  return times;
}

std::set<int> observations_of(const casacore::MeasurementSet& set, const SelectedRows& selected, std::optional<int> of_field) {
  if (set.observation().nrow() <= 1) return {0};
  const casacore::ScalarColumn<int> observation_column(set, "OBSERVATION_ID"), field_column(set, "FIELD_ID");
  std::set<int> found;
  casacore::Vector<int> observation, field;
  for_each_piece(selected, [&](const Rows& piece) {
    read(observation_column, piece, observation);
    if (of_field) read(field_column, piece, field);
    for (std::uint64_t r = 0; r < piece.count(); ++r)
      if (!of_field || field(r) == *of_field) found.insert(observation(r));
  });
  return found;
}

}  // namespace misfit::ms_io
