#include <algorithm>
#include <array>
#include <cmath>

#include "imager/constants.h"
#include "ms_io/row_columns_internal.h"
#include "ms_io/uvw_scan_internal.h"

namespace misfit::ms_io {
namespace {

/// Rows read at once: many, since so little of each is.
constexpr std::uint64_t piece_rows = 1 << 16;

/// Reads where rows lie, and whether they can be used.
class UvwScan {
 public:
  explicit UvwScan(const casacore::Table& table)
      : antenna1_column_(table, "ANTENNA1"),
        antenna2_column_(table, "ANTENNA2"),
        flag_row_column_(table, "FLAG_ROW"),
        uvw_column_(table, "UVW") {}

  /// Calls visit(uvw_m) for each of `rows` that is wanted.
  template <typename Visit>
  void for_each(const Rows& rows, ReachOf wanted, const Visit& visit) {
    read(antenna1_column_, rows, antenna1_);
    read(antenna2_column_, rows, antenna2_);
    read(flag_row_column_, rows, flag_row_);
    read(uvw_column_, rows, uvw_);
    const double* uvw = uvw_.data();
    for (std::size_t r = 0; r < rows.count(); ++r, uvw += 3) {
      if (wanted == ReachOf::usable && (antenna1_(r) == antenna2_(r) || flag_row_(r))) continue;
      if (std::isfinite(uvw[0]) && std::isfinite(uvw[1]) && std::isfinite(uvw[2])) visit(uvw);
    }
  }

 private:
  casacore::ScalarColumn<int> antenna1_column_, antenna2_column_;
  casacore::ScalarColumn<bool> flag_row_column_;
  casacore::ArrayColumn<double> uvw_column_;
  casacore::Vector<int> antenna1_, antenna2_;  ///< [row]
  casacore::Vector<bool> flag_row_;            ///< [row]
  casacore::Array<double> uvw_;                ///< [row][3]
};

/// Calls visit(setup, uvw_m) for each row that is wanted, and done(setup) after some of them.
template <typename Visit, typename Done>
void scan(const OpenSet& open_set, ReachOf rows, const Visit& visit, const Done& done) {
  translated("cannot read UVW, antennas or FLAG_ROW of " + open_set.path, [&] {
    UvwScan scan(open_set.set);
    for (const BlockRows& block : open_set.selected.blocks)
      for (const Rows& piece : pieces(block.runs, piece_rows)) {
        scan.for_each(piece, rows, [&](const double* uvw_m) { visit(block.setup, uvw_m); });
        done(block.setup);
      }
  });
}

}  // namespace

void visit_uvw(const OpenSet& open_set, const std::function<void(const imager::SampleCoordinates&)>& visit) {
  imager::SampleCoordinates some;
  scan(
      open_set, ReachOf::usable,
      [&](std::size_t, const double* uvw_m) { some.uvw_m.insert(some.uvw_m.end(), uvw_m, uvw_m + 3); },
      [&](std::size_t setup) {
        some.frequency_hz = open_set.selected.setups[setup].frequency_hz;
        visit(some);
        some.uvw_m.clear();
      });
}

imager::UvwReach scan_uvw(const OpenSet& open_set, ReachOf rows) {
  const SelectedRows& selected = open_set.selected;
  std::vector<std::array<double, 3>> reach_m(selected.setups.size(), {0, 0, 0});
  scan(
      open_set, rows,
      [&](std::size_t setup, const double* uvw_m) {
        for (std::size_t axis = 0; axis < 3; ++axis)
          reach_m[setup][axis] = std::max(reach_m[setup][axis], std::abs(uvw_m[axis]));
      },
      [](std::size_t) {});
  imager::UvwReach reach;
  for (std::size_t s = 0; s < reach_m.size(); ++s) {
    const std::vector<double>& frequency_hz = selected.setups[s].frequency_hz;
    const double per_m = *std::max_element(frequency_hz.begin(), frequency_hz.end()) / imager::speed_of_light_m_s;
    reach.max_abs_u = std::max(reach.max_abs_u, reach_m[s][0] * per_m);
    reach.max_abs_v = std::max(reach.max_abs_v, reach_m[s][1] * per_m);
    reach.max_abs_w = std::max(reach.max_abs_w, reach_m[s][2] * per_m);
  }
  return reach;
}

}  // namespace misfit::ms_io
