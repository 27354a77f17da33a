#pragma once

#include <casacore/ms/MeasurementSets/MeasurementSet.h>

#include <string>

#include "ms_io/selection.h"

namespace misfit::ms_io {

/// The things in a set that one way to select chooses from, for messages.
struct SelectableThings {
  std::string singular;  ///< "field"; empty where they are not listed
  std::string plural;    ///< "fields"
  std::string list;      ///< "0 'M31', 1 'M33'": at most ten, then the number of the others; empty where there are none
};

/// The things that `kind` chooses from; none for uv distances. Reads their table, or the column of the main table. Throws
/// AipsError where it cannot be read.
SelectableThings selectable_things(const casacore::MeasurementSet& set, const SelectionKind& kind);

/// The things that each expression of `selection` chooses from, as far as they can be read: "scans 3, 5; observations 0".
std::string things_there(const casacore::MeasurementSet& set, const Selection& selection);

/// True if casacore's words say that an expression was understood, and that nothing in the set matches it.
bool says_no_match(const std::string& casacore_words);

}  // namespace misfit::ms_io
