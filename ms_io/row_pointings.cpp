#include <casacore/tables/Tables/ScalarColumn.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "ms_io/field_centres_internal.h"
#include "ms_io/field_pointings_internal.h"
#include "ms_io/metadata_internal.h"
#include "ms_io/pointing_table_internal.h"
#include "ms_io/row_columns_internal.h"
#include "ms_io/row_pointings_internal.h"

namespace misfit::ms_io {
namespace {

/// A unit vector.
using Towards = std::array<double, 3>;

Towards towards(const imager::SkyDirection& sky) {
  return {std::cos(sky.dec_rad) * std::cos(sky.ra_rad), std::cos(sky.dec_rad) * std::sin(sky.ra_rad), std::sin(sky.dec_rad)};
}

double chord(const Towards& a, const Towards& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

Towards mean_of(const Towards& a, const Towards& b) {
  const Towards sum{a[0] + b[0], a[1] + b[1], a[2] + b[2]};
  const double length = std::hypot(sum[0], sum[1], sum[2]);
  return {sum[0] / length, sum[1] / length, sum[2] / length};
}

imager::SkyDirection sky_of(const Towards& t, const std::string& frame) {
  const double ra_rad = std::atan2(t[1], t[0]);
  return {ra_rad < 0 ? ra_rad + 2 * M_PI : ra_rad, std::atan2(t[2], std::hypot(t[0], t[1])), frame};
}

/// The selected rows of the main table, ascending.
std::vector<Run> rows_in_order(const SelectedRows& selected) {
  std::vector<Run> all, joined;
  for (const BlockRows& block : selected.blocks) all.insert(all.end(), block.runs.begin(), block.runs.end());
  std::sort(all.begin(), all.end(), [](const Run& a, const Run& b) { return a.first < b.first; });
  for (const Run& run : all) append(joined, run.first, run.count);
  return joined;
}

/// The columns of a row.
struct ObservedRow {
  int antenna_one = 0;
  int antenna_other = 0;
  int field = 0;
  RowTime when;
};

/// Groups rows, met in the order of the table.
class Grouping {
 public:
  Grouping(const OpenSet& open_set, const imager::SkyDirection& centre, double tolerance_rad)
      : view_(open_set, centre),
        table_(open_set),
        frame_(centre.frame),
        antennas_(open_set.set.antenna().nrow()),
        tolerance_(2 * std::sin(tolerance_rad / 2)),
        seen_(antennas_) {}

  /// The pointing of the row before; -1 where none had one.
  int before() const { return last_; }
  bool has(int antenna) const { return antenna >= 0 && static_cast<casacore::rownr_t>(antenna) < antennas_; }

  int number_of(const ObservedRow& row) {
    if (row.when != when_) {
      when_ = row.when;
      std::fill(seen_.begin(), seen_.end(), std::nullopt);
    }
    const Towards one = seen(row.antenna_one), other = seen(row.antenna_other), mean = mean_of(one, other);
    if (const double apart = chord(one, other); apart > tolerance_) {
      ++apart_rows_;
      farthest_ = std::max(farthest_, apart);
    }
    const auto is_near = [&](const Towards& pointing) { return chord(pointing, mean) <= tolerance_; };
    if (last_ >= 0 && is_near(known_[static_cast<std::size_t>(last_)])) return last_;
    const auto first = std::find_if(known_.begin(), known_.end(), is_near);
    last_ = static_cast<int>(first - known_.begin());
    if (first == known_.end()) found(row, mean);
    return last_;
  }

  std::vector<FieldPointing> take() { return std::move(pointings_); }

  std::string remark(const std::string& path) const {
    if (apart_rows_ == 0) return "";
    const auto angle = [](double chord) { return angle_words(2 * std::asin(chord / 2)); };
    return "antennas of " + std::to_string(apart_rows_) + " rows of " + path + " pointed up to " + angle(farthest_) +
           " apart, more than the tolerance of " + angle(tolerance_) +
           ": each row counts as seen from the middle between its two antennas' directions";
  }

 private:
  const Towards& seen(int antenna) {
    std::optional<Towards>& known = seen_[static_cast<std::size_t>(antenna)];
    if (!known) known = towards(view_.seen(table_.at(antenna, when_), when_.time_s));
    return *known;
  }

  void found(const ObservedRow& row, const Towards& mean) {
    known_.push_back(mean);
    pointings_.push_back(view_.pointing(row.field, sky_of(mean, frame_), row.when.time_s));
  }

  ImageView view_;
  PointingTable table_;
  std::string frame_;
  casacore::rownr_t antennas_;
  double tolerance_;  ///< as a chord
  RowTime when_;
  std::vector<std::optional<Towards>> seen_;  ///< [antenna] at that time; none where it was not asked for
  std::vector<Towards> known_;                ///< [pointing]
  std::vector<FieldPointing> pointings_;
  int last_ = -1;
  std::uint64_t apart_rows_ = 0;
  double farthest_ = 0;  ///< chord
};

/// Calls visit(row's number, row, whether it can be used) for selected rows.
template <typename Visit>
void for_each_row(const OpenSet& open_set, const Visit& visit) {
  constexpr std::uint64_t piece_rows = 1 << 16;
  const casacore::ScalarColumn<int> one_column(open_set.set, "ANTENNA1"), other_column(open_set.set, "ANTENNA2"),
      field_column(open_set.set, "FIELD_ID");
  const casacore::ScalarColumn<double> time_column(open_set.set, "TIME"), interval_column(open_set.set, "INTERVAL");
  const casacore::ScalarColumn<bool> flag_column(open_set.set, "FLAG_ROW");
  casacore::Vector<int> one, other, field;
  casacore::Vector<double> time_s, interval_s;
  casacore::Vector<bool> flagged;
  for (const Rows& piece : pieces(rows_in_order(open_set.selected), piece_rows)) {
    read(one_column, piece, one);
    read(other_column, piece, other);
    read(field_column, piece, field);
    read(time_column, piece, time_s);
    read(interval_column, piece, interval_s);
    read(flag_column, piece, flagged);
    for (std::uint64_t r = 0; r < piece.count(); ++r) {
      const double length_s = std::isfinite(interval_s(r)) ? interval_s(r) : 0;
      visit(piece[r], ObservedRow{one(r), other(r), field(r), {time_s(r), length_s}},
            one(r) != other(r) && !flagged(r) && std::isfinite(time_s(r)));
    }
  }
}

}  // namespace

RowPointings row_pointings(const OpenSet& open_set, const imager::SkyDirection& centre, double tolerance_rad) {
  if (!(tolerance_rad > 0 && std::isfinite(tolerance_rad)))
    throw std::invalid_argument("tolerance of pointings " + std::to_string(tolerance_rad) + " rad; expected a positive number");
  RowPointings result;
  Grouping grouping(open_set, centre, tolerance_rad);
  translated("cannot read antennas, fields or times of " + open_set.path, [&] {
    for_each_row(open_set, [&](std::uint64_t number, const ObservedRow& row, bool usable) {
      usable = usable && grouping.has(row.antenna_one) && grouping.has(row.antenna_other);
      const int pointing = usable ? grouping.number_of(row) : grouping.before();
      if (result.rows.empty() || result.rows.back().pointing != pointing) result.rows.push_back({number, pointing});
    });
  });
  result.pointings = grouping.take();
  result.remark = grouping.remark(open_set.path);
  return result;
}

}  // namespace misfit::ms_io
