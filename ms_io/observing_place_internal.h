#pragma once

#include <casacore/measures/Measures/MPosition.h>
#include <casacore/ms/MeasurementSets/MeasurementSet.h>

#include <optional>
#include <set>
#include <string>

namespace misfit::ms_io {

/// The place from which a set was observed. An antenna has a place if its POSITION, in ITRF, is about an Earth's radius from
/// the Earth's middle. It is not where POSITION is relative to the array's centre, in another unit than it states, or no
/// number.
struct ObservingPlace {
  /// The telescope's position, as casacore knows it by its whole name or another one, such as VLA for EVLA, unless it lies
  /// farther from the antennas with a place than these from each other, and than 50 km; else the median of these antennas; else
  /// the middle of the Earth. It does not depend on the order of antennas. Where OBSERVATION names several telescopes, a name
  /// that is known decides, and otherwise the antennas in rows of the observation.
  casacore::MPosition position;
  std::string doubt;         ///< why `position` is the middle of the Earth, in words that follow "since"; else empty
  std::string dispute;       ///< a sentence where the telescope stands elsewhere by its name; else empty
  bool of_antennas = false;  ///< whether `position` is their median
};

/// The place of the telescope of a row of OBSERVATION; a telescope without a name where there is no such row.
ObservingPlace observing_place(const casacore::MeasurementSet& set, int observation);

/// POSITION of an antenna that has a place, else the telescope's place; nothing where that is in doubt.
std::optional<casacore::MPosition> antenna_place(const casacore::MeasurementSet& set, int antenna,
                                                 const ObservingPlace& telescope);

/// True if observations were made within a kilometre of each other.
bool in_one_place(const casacore::MeasurementSet& set, const std::set<int>& observations);

}  // namespace misfit::ms_io
