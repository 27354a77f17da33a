#include <casacore/measures/Measures/MCDirection.h>
#include <casacore/measures/Measures/MEpoch.h>
#include <casacore/measures/Measures/MeasConvert.h>
#include <casacore/measures/Measures/MeasFrame.h>
#include <casacore/measures/TableMeasures/ScalarMeasColumn.h>
#include <casacore/tables/Tables/ScalarColumn.h>

#include <cmath>
#include <map>
#include <utility>

#include "ms_io/capitals.h"
#include "ms_io/celestial_frame_internal.h"
#include "ms_io/metadata_internal.h"
#include "ms_io/observing_place_internal.h"
#include "ms_io/row_sights_internal.h"
#include "ms_io/table_access_internal.h"

namespace misfit::ms_io {
namespace {

using casacore::MDirection;

/// True if antennas on this MOUNT turn with the zenith. An empty MOUNT counts as alt-azimuth.
bool turns_with_zenith(const std::string& mount) {
  const std::string name = capitals(mount);
  return name.empty() || (name.rfind("ALT-AZ", 0) == 0 && name.find("ROTATOR") == std::string::npos);
}

/// The position angle of one direction seen from another.
double position_angle(const imager::SkyDirection& of, const imager::SkyDirection& from) {
  const double east = of.ra_rad - from.ra_rad;
  return std::atan2(std::cos(of.dec_rad) * std::sin(east), std::sin(of.dec_rad) * std::cos(from.dec_rad) -
                                                               std::cos(of.dec_rad) * std::sin(from.dec_rad) * std::cos(east));
}

/// Where the zenith of a set's place is.
class Zenith {
 public:
  explicit Zenith(const OpenSet& open_set)
      : place_(observing_place(open_set.set, observation_of(open_set.set, open_set.selected.first_row)).position),
        clock_(casacore::ScalarMeasColumn<casacore::MEpoch>(open_set.set, "TIME").getMeasRef()) {}

  imager::SkyDirection at(double time_s, const std::string& frame) const {
    const casacore::MeasFrame here(casacore::MEpoch(casacore::Quantity(time_s, "s"), clock_), place_);
    const MDirection overhead(casacore::Quantity(0, "deg"), casacore::Quantity(90, "deg"),
                              MDirection::Ref(MDirection::AZELGEO, here));
    return sky_direction(MDirection::Convert(overhead, MDirection::Ref(direction_type(frame), here))());
  }

 private:
  casacore::MPosition place_;
  casacore::MEpoch::Ref clock_;
};

constexpr const char* reading = "cannot read ANTENNA, or the times of the rows of ";

}  // namespace

class SightReader::Columns {
 public:
  Columns(const OpenSet& open_set, std::shared_ptr<const SightNumbers> numbers)
      : numbers_(std::move(numbers)),
        zenith_(open_set),
        mount_(casacore::ScalarColumn<casacore::String>(open_set.set.antenna(), "MOUNT").getColumn()),
        antenna_one_(open_set.set, "ANTENNA1"),
        antenna_other_(open_set.set, "ANTENNA2"),
        field_(open_set.set, "FIELD_ID"),
        time_(open_set.set, "TIME") {}

  std::vector<imager::RowSight> sights(const Rows& rows) {
    casacore::Vector<int> one, other, field;
    casacore::Vector<double> time_s;
    read(antenna_one_, rows, one);
    read(antenna_other_, rows, other);
    read(field_, rows, field);
    read(time_, rows, time_s);
    std::vector<imager::RowSight> sights;
    sights.reserve(rows.count());
    for (std::size_t r = 0; r < rows.count(); ++r) {
      const int pointing = numbers_->pointing(rows[r], field(r));
      sights.push_back({antenna(one(r)), antenna(other(r)), pointing, turns(one(r)) ? zenith_rad(time_s(r), pointing) : 0});
    }
    return sights;
  }

 private:
  bool is_listed(int id) const { return id >= 0 && static_cast<std::size_t>(id) < mount_.nelements(); }
  int antenna(int id) const { return is_listed(id) ? numbers_->first_antenna + id : -1; }
  bool turns(int id) const { return is_listed(id) && turns_with_zenith(mount_(static_cast<std::size_t>(id))); }

  float zenith_rad(double time_s, int pointing) {
    const auto from = numbers_->direction.find(pointing);
    if (from == numbers_->direction.end() || !std::isfinite(time_s)) return 0;
    const auto [at, is_new] = known_.insert({{time_s, pointing}, 0.0F});
    if (is_new) at->second = static_cast<float>(position_angle(zenith_.at(time_s, from->second.frame), from->second));
    return at->second;
  }

  std::shared_ptr<const SightNumbers> numbers_;
  Zenith zenith_;
  casacore::Vector<casacore::String> mount_;
  casacore::ScalarColumn<int> antenna_one_, antenna_other_, field_;
  casacore::ScalarColumn<double> time_;
  std::map<std::pair<double, int>, float> known_;
};

SightReader::SightReader(const OpenSet& open_set, std::shared_ptr<const SightNumbers> numbers)
    : columns_(translated(reading + open_set.path, [&] { return std::make_unique<Columns>(open_set, std::move(numbers)); })) {}

SightReader::~SightReader() = default;

std::vector<imager::RowSight> SightReader::sights(const Rows& rows) {
  return columns_->sights(rows);
}

std::vector<float> zenith_turns(const OpenSet& open_set, const imager::SkyDirection& centre) {
  constexpr std::uint64_t piece_rows = 1 << 16;
  SightReader reader(open_set, numbers_by_id(open_set, centre));
  return translated(reading + open_set.path, [&] {
    std::vector<float> turns;
    for (const BlockRows& block : open_set.selected.blocks)
      for (const Rows& piece : pieces(block.runs, piece_rows))
        for (const imager::RowSight& sight : reader.sights(piece)) turns.push_back(sight.zenith_rad);
    return turns;
  });
}

}  // namespace misfit::ms_io
