#pragma once

#include <casacore/measures/Measures/MPosition.h>
#include <casacore/ms/MeasurementSets/MeasurementSet.h>

#include <optional>
#include <set>
#include <string>

namespace misfit::ms_io {

/// From where a set was observed. Antennas stand where POSITION is some Earth's radius from its middle, in ITRF, which it is
/// not where it is relative to the array's centre, in another unit than it states, or no number.
struct ObservingPlace {
  /// Of the telescope, as casacore knows it by its whole name or another one, such as VLA for EVLA, unless it lies farther from
  /// the antennas that stand than these from each other, and than 50 km; else the median of these antennas; else the middle of
  /// the Earth. It does not depend on the order of antennas. Where OBSERVATION names several telescopes, a name that is known
  /// decides, and otherwise antennas count that are in rows of the observation.
  casacore::MPosition position;
  std::string doubt;         ///< why `position` is the middle of the Earth, in words that follow "since"; else empty
  std::string dispute;       ///< that the telescope stands elsewhere by its name, in a sentence; else empty
  bool of_antennas = false;  ///< whether `position` is their median
};

/// Of the telescope of a row of OBSERVATION; of none by name where there is no such row.
ObservingPlace observing_place(const casacore::MeasurementSet& set, int observation);

/// POSITION of an antenna where it stands there, else the telescope's place; nothing where that is in doubt.
std::optional<casacore::MPosition> antenna_place(const casacore::MeasurementSet& set, int antenna,
                                                 const ObservingPlace& telescope);

/// Whether observations were made within a kilometre of each other.
bool in_one_place(const casacore::MeasurementSet& set, const std::set<int>& observations);

}  // namespace misfit::ms_io
