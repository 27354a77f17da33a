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
#include "ms_io/field_pointings_internal.h"
#include "ms_io/metadata_internal.h"
#include "ms_io/observing_place_internal.h"
#include "ms_io/row_columns_internal.h"
#include "ms_io/table_access_internal.h"
#include "ms_io/zenith_turns_internal.h"

namespace misfit::ms_io {
namespace {

using casacore::MDirection;

/// An antenna whose MOUNT says nothing counts as one on an alt-azimuth mount.
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

}  // namespace

std::vector<float> zenith_turns(const OpenSet& open_set, const imager::SkyDirection& centre) {
  constexpr std::uint64_t piece_rows = 1 << 16;
  std::map<int, imager::SkyDirection> of_field;
  for (const FieldPointing& pointing : field_pointings(open_set, centre)) of_field.insert({pointing.id, pointing.direction});
  return translated("cannot read ANTENNA, or the times of the rows of " + open_set.path, [&] {
    const Zenith zenith(open_set);
    const casacore::Vector<casacore::String> mount =
        casacore::ScalarColumn<casacore::String>(open_set.set.antenna(), "MOUNT").getColumn();
    const casacore::ScalarColumn<int> antenna(open_set.set, "ANTENNA1"), field(open_set.set, "FIELD_ID");
    const casacore::ScalarColumn<double> time(open_set.set, "TIME");
    casacore::Vector<int> antennas, fields;
    casacore::Vector<double> times;
    std::map<std::pair<double, int>, float> known;
    std::vector<float> turns;
    for (const BlockRows& block : open_set.selected.blocks)
      for (const Rows& piece : pieces(block.runs, piece_rows)) {
        read(antenna, piece, antennas);
        read(field, piece, fields);
        read(time, piece, times);
        for (std::size_t r = 0; r < piece.count(); ++r) {
          const auto from = of_field.find(fields(r));
          const bool turned = antennas(r) >= 0 && static_cast<std::size_t>(antennas(r)) < mount.nelements() &&
                              turns_with_zenith(mount(static_cast<std::size_t>(antennas(r))));
          if (!turned || from == of_field.end()) {
            turns.push_back(0);
            continue;
          }
          const auto [at, is_new] = known.insert({{times(r), fields(r)}, 0.0F});
          if (is_new) at->second = static_cast<float>(position_angle(zenith.at(times(r), from->second.frame), from->second));
          turns.push_back(at->second);
        }
      }
    return turns;
  });
}

}  // namespace misfit::ms_io
