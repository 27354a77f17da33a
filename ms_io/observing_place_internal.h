#pragma once

#include <casacore/measures/Measures/MPosition.h>
#include <casacore/measures/Measures/MeasFrame.h>
#include <casacore/ms/MeasurementSets/MeasurementSet.h>

#include <cstdint>
#include <string>

namespace misfit::ms_io {

/// From where a set was observed.
struct ObservingPlace {
  /// Of the telescope, as casacore knows it by its name; else of the first antenna that does not stand far below the Earth's
  /// surface, as antennas do whose POSITION is relative to the array's centre; else of the telescope by another name, such as
  /// VLA for EVLA; else of the first antenna.
  casacore::MPosition position;
  std::string doubt;  ///< why `position` is none, in words that follow "since"; else empty
};

/// Of the row's telescope.
ObservingPlace observing_place(const casacore::MeasurementSet& set, std::uint64_t row);

/// When and from where the row was observed.
casacore::MeasFrame frame_of(const casacore::MeasurementSet& set, std::uint64_t row);

/// The diagonal of the least box that holds all antennas, so that no baseline is longer; 0 without antennas.
double largest_baseline_m(const casacore::MeasurementSet& set);

}  // namespace misfit::ms_io
