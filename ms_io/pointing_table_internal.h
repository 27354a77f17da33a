#pragma once

#include <casacore/measures/Measures/MDirection.h>

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ms_io/visibility_reader_internal.h"

namespace misfit::ms_io {

/// TIME and INTERVAL of a row, as the set stores them.
struct RowTime {
  double time_s = 0;
  double interval_s = 0;

  bool operator!=(const RowTime& other) const { return time_s != other.time_s || interval_s != other.interval_s; }
};

/// Where the antennas of a set pointed in the course of time, as its table POINTING says. An entry may be a polynomial in time.
/// If not, and its INTERVAL is longer than one and a half of the row's, it is a place where the antenna stayed for that
/// INTERVAL; else it is a sample of the antenna's way, and between two such samples the antenna goes straight on the sphere of
/// their frame. Entries are known to reach as far from their TIME as the longer of their INTERVAL and the row's, and anywhere
/// where their INTERVAL is not positive.
class PointingTable {
 public:
  /// Throws std::runtime_error where the set has no POINTING table, it has no rows, or it cannot be read.
  explicit PointingTable(const OpenSet& open_set);
  ~PointingTable();

  /// The direction, in one of the frames of in_frame(). Throws std::runtime_error where the antenna has no entry, or none that
  /// reaches the row, or where its frame turns with the Earth and it is not known where the antenna stands.
  imager::SkyDirection at(int antenna, const RowTime& when);

 private:
  struct Course;
  struct Entry;
  class Places;

  void read();
  std::string label(int antenna) const;
  [[noreturn]] void refuse(const std::string& lack) const;

  const OpenSet& open_set_;
  std::map<int, std::vector<Entry>> of_antenna_;  ///< earliest first
  std::uint64_t strange_ = 0;                     ///< entries of antennas that ANTENNA lacks
  std::unique_ptr<Places> places_;
};

}  // namespace misfit::ms_io
