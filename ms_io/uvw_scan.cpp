#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "imager/numerics/constants.h"
#include "ms_io/row_columns_internal.h"
#include "ms_io/uvw_scan_internal.h"

namespace misfit::ms_io {
namespace {

/// Rows read at once: many, since so little of each is.
constexpr std::uint64_t piece_rows = 1 << 16;

/// Reads the UVW of rows, and whether they can be used.
class UvwScan {
 public:
  explicit UvwScan(const casacore::Table& table)
      : antenna1_column_(table, "ANTENNA1"),
        antenna2_column_(table, "ANTENNA2"),
        flag_row_column_(table, "FLAG_ROW"),
        time_column_(table, "TIME"),
        uvw_column_(table, "UVW") {}

  /// Calls visit(uvw_m, row's place among `rows`) for each of `rows` that is wanted.
  template <typename Visit>
  void for_each(const Rows& rows, ReachOf wanted, const Visit& visit) {
    read(antenna1_column_, rows, antenna1_);
    read(antenna2_column_, rows, antenna2_);
    read(flag_row_column_, rows, flag_row_);
    read(uvw_column_, rows, uvw_);
    const double* uvw = uvw_.data();
    for (std::size_t r = 0; r < rows.count(); ++r, uvw += 3) {
      if (wanted == ReachOf::usable && (antenna1_(r) == antenna2_(r) || flag_row_(r))) continue;
      if (std::isfinite(uvw[0]) && std::isfinite(uvw[1]) && std::isfinite(uvw[2])) visit(uvw, r);
    }
  }

  /// TIME of `rows`.
  const double* times_s(const Rows& rows) {
    read(time_column_, rows, time_s_);
    return time_s_.data();
  }

 private:
  casacore::ScalarColumn<int> antenna1_column_, antenna2_column_;
  casacore::ScalarColumn<bool> flag_row_column_;
  casacore::ScalarColumn<double> time_column_;
  casacore::ArrayColumn<double> uvw_column_;
  casacore::Vector<int> antenna1_, antenna2_;  ///< [row]
  casacore::Vector<bool> flag_row_;            ///< [row]
  casacore::Vector<double> time_s_;            ///< [row]
  casacore::Array<double> uvw_;                ///< [row][3]
};

/// Calls visit(setup, coordinates) for groups of the wanted rows, with UVW about the image's phase centre.
template <typename Visit>
void scan(const OpenSet& open_set, ReachOf wanted, const Visit& visit) {
  imager::SampleCoordinates some;
  UvwScan scan = translated("cannot read UVW, antennas or FLAG_ROW of " + open_set.path, [&] { return UvwScan(open_set.set); });
  for (const BlockRows& block : open_set.selected.blocks) {
    const Setup& setup = open_set.selected.setups[block.setup];
    some.frequency_hz = setup.frequency_hz;
    for (const Rows& piece : pieces(block.runs, piece_rows)) {
      some.uvw_m.edit().clear();
      imager::RowShifts shifts;
      const double* const time_s = setup.shift.moves()
                                       ? translated("cannot read TIME of " + open_set.path, [&] { return scan.times_s(piece); })
                                       : nullptr;
      translated("cannot read UVW, antennas or FLAG_ROW of " + open_set.path, [&] {
        scan.for_each(piece, wanted, [&](const double* uvw_m, std::size_t row) {
          some.uvw_m.append(uvw_m, uvw_m + 3);
          if (time_s != nullptr) setup.shift.append(time_s + row, 1, shifts);
        });
      });
      if (time_s == nullptr) setup.shift.append(nullptr, some.rows(), shifts);
      shifts.rotate(some.uvw_m.edit());
      visit(some);
    }
  }
}

}  // namespace

void visit_uvw(const OpenSet& open_set, const std::function<void(const imager::SampleCoordinates&)>& visit) {
  scan(open_set, ReachOf::usable, visit);
}

void SetReach::join(const SetReach& other) {
  max_abs_u = std::max(max_abs_u, other.max_abs_u);
  max_abs_v = std::max(max_abs_v, other.max_abs_v);
  max_abs_w = std::max(max_abs_w, other.max_abs_w);
  shortest_m = std::min(shortest_m, other.shortest_m);
  longest_m = std::max(longest_m, other.longest_m);
  shortest_lambda = std::min(shortest_lambda, other.shortest_lambda);
  longest_lambda = std::max(longest_lambda, other.longest_lambda);
}

SetReach scan_uvw(const OpenSet& open_set, ReachOf rows) {
  SetReach all;
  scan(open_set, rows, [&](const imager::SampleCoordinates& some) {
    if (some.rows() == 0) return;
    std::array<double, 3> reach_m{0, 0, 0};
    double shortest_square = std::numeric_limits<double>::infinity(), longest_square = 0;  // m²
    for (std::size_t row = 0; row < some.rows(); ++row) {
      const double* const uvw_m = some.uvw_m.data() + 3 * row;
      for (std::size_t axis = 0; axis < 3; ++axis) reach_m[axis] = std::max(reach_m[axis], std::abs(uvw_m[axis]));
      const double square = uvw_m[0] * uvw_m[0] + uvw_m[1] * uvw_m[1];
      shortest_square = std::min(shortest_square, square);
      longest_square = std::max(longest_square, square);
    }
    const auto [lowest_hz, highest_hz] = std::minmax_element(some.frequency_hz.begin(), some.frequency_hz.end());
    const double per_m = *highest_hz / imager::speed_of_light_m_s;
    SetReach one;
    one.max_abs_u = reach_m[0] * per_m;
    one.max_abs_v = reach_m[1] * per_m;
    one.max_abs_w = reach_m[2] * per_m;
    one.shortest_m = std::sqrt(shortest_square);
    one.longest_m = std::sqrt(longest_square);
    one.shortest_lambda = one.shortest_m * *lowest_hz / imager::speed_of_light_m_s;
    one.longest_lambda = one.longest_m * per_m;
    all.join(one);
  });
  return all;
}

double finest_beam_rad(const casacore::MeasurementSet& set, const std::string& path, const SelectedRows& selected) {
  double longest = 0;
  translated("cannot read UVW, antennas or FLAG_ROW of " + path, [&] {
    UvwScan scan(set);
    for (const BlockRows& block : selected.blocks) {
      const std::vector<double>& hz = selected.setups[block.setup].frequency_hz;
      const double per_m = *std::max_element(hz.begin(), hz.end()) / imager::speed_of_light_m_s;
      for (const Rows& piece : pieces(block.runs, piece_rows))
        scan.for_each(piece, ReachOf::usable, [&](const double* uvw_m, std::size_t) {
          longest = std::max(longest, std::hypot(uvw_m[0], uvw_m[1], uvw_m[2]) * per_m);
        });
    }
  });
  return longest > 0 ? 1 / longest : 0;
}

}  // namespace misfit::ms_io
