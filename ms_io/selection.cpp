#include <casacore/tables/Tables/ArrayColumn.h>
#include <casacore/tables/Tables/ScalarColumn.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "ms_io/field_centres_internal.h"
#include "ms_io/selectable_things_internal.h"
#include "ms_io/selection_internal.h"
#include "ms_io/setup_internal.h"
#include "ms_io/spectral_frame_internal.h"
#include "ms_io/table_access_internal.h"

namespace misfit::ms_io {
namespace {

constexpr std::size_t not_selected = std::numeric_limits<std::size_t>::max();

/// A row of the main table, with the values that order rows of one time. Nothing else decides which row is the first, so that
/// the order of the table does not matter.
struct TimedRow {
  double time_s = 0;  ///< as the set stores it
  int field = 0;
  int data_description = 0;
  std::uint64_t row = 0;

  /// False for rows of some writers, which leave 0 where they flag.
  bool timed() const { return std::isfinite(time_s) && time_s > 0; }

  /// Rows without a time come last.
  bool before(const TimedRow& other) const {
    const auto key = [](const TimedRow& r) {
      return std::tuple(!r.timed(), r.timed() ? r.time_s : 0, r.field, r.data_description, r.row);
    };
    return key(*this) < key(other);
  }
};

/// Sorts rows, met in the order of the table, into blocks of one setup each.
class BlockBuilder {
 public:
  BlockBuilder(const SetupTable& table, const ParsedSelection& parsed, const Selection& selection, const RowUse& use)
      : table_(table), parsed_(parsed), use_(use) {
    result_.by_field = selection.phase_centre || selection.moving == Selection::Moving::about_targets ||
                       selection.spectral_frame == source_frame;
    result_.phase_centre = selection.phase_centre;
    result_.spectral_frame = selection.spectral_frame;
    result_.body_name = selection.body;
  }

  /// `uvw_m` is looked at only where the selection asks for it.
  void add(const TimedRow& at, const double* uvw_m) {
    if (!parsed_.has_field(at.field)) return;
    if (!parsed_.uv.empty() && !has_uv(uvw_m, at.data_description)) return;
    if (!parsed_.has_row(at.row)) return;
    const std::size_t setup = setup_of({at.data_description, result_.by_field ? at.field : 0});
    if (setup == not_selected) return;
    ++result_.rows;
    ++result_.setups[setup].rows_of_field[at.field];
    TimedRow& first = first_of_field_.emplace(at.field, at).first->second;
    if (at.before(first)) first = at;
    if (at.timed() && (!last_timed_ || last_timed_->before(at))) last_timed_ = at;
    BlockRows& block = pending_[setup];
    append(block.runs, at.row);
    if (++block.rows >= rows_per_block_[setup]) flush(setup);
  }

  SelectedRows finish() {
    for (std::size_t s = 0; s < pending_.size(); ++s) flush(s);
    const TimedRow* first = nullptr;
    for (const auto& [field, row] : first_of_field_) {
      result_.first_row_of_field[field] = row.row;
      if (first == nullptr || row.before(*first)) first = &row;
    }
    if (first != nullptr) result_.first_row = first->row;
    if (last_timed_) result_.last_row = last_timed_->row;
    return std::move(result_);
  }

 private:
  bool has_uv(const double* uvw_m, int data_description) {
    if (!std::isfinite(uvw_m[0]) || !std::isfinite(uvw_m[1])) return use_.reading;
    return parsed_.has_uv(uvw_m, parsed_.uv_in_wavelengths() ? reference_frequency_hz(data_description) : 0);
  }

  double reference_frequency_hz(int data_description) {
    const auto known = reference_frequency_hz_.find(data_description);
    if (known != reference_frequency_hz_.end()) return known->second;
    const bool selected = parsed_.has_window(table_.spectral_window(data_description));
    return reference_frequency_hz_[data_description] = selected ? table_.reference_frequency_hz(data_description) : 0;
  }

  /// DATA_DESC_ID, and the field where each is shifted in a way of its own.
  using Key = std::pair<int, int>;

  std::size_t setup_of(const Key& key) {
    if (last_ && key == *last_) return last_setup_;
    last_ = key;
    const auto known = setup_.find(key);
    last_setup_ = known == setup_.end() ? make_setup(key) : known->second;
    return last_setup_;
  }

  std::size_t make_setup(const Key& key) {
    std::size_t& index = setup_[key] = not_selected;
    if (!parsed_.has_window(table_.spectral_window(key.first))) return index;
    index = result_.setups.size();
    result_.setups.push_back(table_.setup(key.first, parsed_));
    result_.setups.back().field = key.second;
    result_.setups.back().place = parsed_.place_of(result_.setups.back().spectral_window);
    rows_per_block_.push_back(std::max<std::uint64_t>(1, use_.block_samples / result_.setups.back().frequency_hz.size()));
    pending_.push_back({index, {}, 0});
    return index;
  }

  void flush(std::size_t setup) {
    BlockRows& block = pending_[setup];
    if (block.rows == 0) return;
    result_.samples += block.rows * result_.setups[setup].frequency_hz.size();
    result_.blocks.push_back(std::move(block));
    block = {setup, {}, 0};
  }

  const SetupTable& table_;
  const ParsedSelection& parsed_;
  RowUse use_;
  SelectedRows result_;
  std::map<int, TimedRow> first_of_field_;
  std::optional<TimedRow> last_timed_;
  std::map<Key, std::size_t> setup_;
  std::map<int, double> reference_frequency_hz_;  ///< by DATA_DESC_ID
  std::vector<BlockRows> pending_;                ///< [setup]
  std::vector<std::uint64_t> rows_per_block_;
  std::optional<Key> last_;
  std::size_t last_setup_ = 0;
};

}  // namespace

void append(std::vector<Run>& runs, std::uint64_t first, std::uint64_t count) {
  if (runs.empty() || runs.back().first + runs.back().count != first) {
    runs.push_back({first, count});
  } else {
    runs.back().count += count;
  }
}

namespace {

/// The rows of the selection, wherever they are phased to.
SelectedRows find_rows(const casacore::MeasurementSet& set, const std::string& path, const Selection& selection,
                       const RowUse& use) {
  const SetupTable table(set, path);
  const ParsedSelection parsed = parse_selection(set, path, selection);
  BlockBuilder builder(table, parsed, selection, use);
  constexpr std::uint64_t rows_at_once = 1 << 20;
  for (std::uint64_t first = 0; first < set.nrow(); first += rows_at_once) {
    const std::uint64_t count = std::min<std::uint64_t>(rows_at_once, set.nrow() - first);
    const casacore::Slicer rows(casacore::IPosition(1, static_cast<ssize_t>(first)),
                                casacore::IPosition(1, static_cast<ssize_t>(count)));
    const auto ids = [&](const char* column) {
      return translated("cannot read " + std::string(column) + " of " + path,
                        [&] { return casacore::ScalarColumn<int>(set, column).getColumnRange(rows).tovector(); });
    };
    const std::vector<int> description = ids("DATA_DESC_ID"), field = ids("FIELD_ID");
    const std::vector<double> time_s = translated("cannot read TIME of " + path, [&] {
      return casacore::ScalarColumn<double>(set, "TIME").getColumnRange(rows).tovector();
    });
    casacore::Array<double> uvw;
    if (!parsed.uv.empty()) {
      uvw = translated("cannot read UVW of " + path,
                       [&] { return casacore::ArrayColumn<double>(set, "UVW").getColumnRange(rows); });
    }
    translated("cannot select rows of " + path, [&] {
      for (std::uint64_t r = 0; r < count; ++r)
        builder.add({time_s[r], field[r], description[r], first + r}, uvw.empty() ? nullptr : uvw.data() + 3 * r);
    });
  }
  SelectedRows selected = builder.finish();
  if (selected.rows > 0) return selected;
  const std::string given = to_text(selection);
  const std::string rows = std::to_string(set.nrow()) + " rows";
  const std::string there = things_there(set, selection);
  throw std::runtime_error(
      path + (given.empty() ? " has " + rows + ", and none can be taken" : ": " + given + " selects none of its " + rows) +
      "; expected at least one" + (there.empty() ? "" : "; the set has " + there));
}

}  // namespace

SelectedRows select_rows(const casacore::MeasurementSet& set, const std::string& path, const Selection& selection,
                         const RowUse& use) {
  SelectedRows selected = find_rows(set, path, selection, use);
  const std::optional<imager::SkyDirection> centre = settle_phase_centre(set, path, selection, selected);
  if (!centre) return selected;
  Selection shifted = selection;
  shifted.phase_centre = centre;
  SelectedRows again = select_rows(set, path, shifted, use);
  for (const std::string& remark : again.remarks)
    if (std::find(selected.remarks.begin(), selected.remarks.end(), remark) == selected.remarks.end())
      selected.remarks.push_back(remark);
  again.remarks = std::move(selected.remarks);
  return again;
}

}  // namespace misfit::ms_io
