#pragma once

#include <optional>
#include <string>

#include "ms_io/field_times_internal.h"
#include "ms_io/phase_centre_internal.h"
#include "ms_io/selection_internal.h"

namespace misfit::ms_io {

/// Finds where the fields of `selected` are phased to, at each of their times where that moves, and how `selection` leads them
/// to one phase centre: fills the members from `moving` to `remarks`, and the shifts of setups. Where fields have to be shifted
/// to a direction that `selection` does not name, only fills remarks, and returns the direction: the rows are to be selected
/// anew with it. Throws std::runtime_error, which says what would help, where fields have no phase centre in common.
std::optional<imager::SkyDirection> settle_phase_centre(const casacore::MeasurementSet& set, const std::string& path,
                                                        const Selection& selection, SelectedRows& selected);

/// The least motion that is reported, and the most that targets may lie apart: a thousandth of the finest beam.
double noticed_motion_rad(double finest_beam_rad);

/// The centre of an image that moves with a field, at a time.
FieldCentre followed_centre(FieldDirections& fields, const SelectedRows& selected, int field, const Moment& when);

/// Where a field is phased to at its first selected row or, where it moves, in the middle of its rows.
FieldCentre usual_centre(FieldDirections& fields, const casacore::MeasurementSet& set, const SelectedRows& selected, int field);

/// Nearer than this phase centres are meant as one: a thousandth of the finest beam, far below a pixel, and at least 10
/// microarcseconds, by which the same direction differs in the matrices by which programs convert between J2000 and ICRS, or in
/// the digits by which they print it.
double close_centre_rad(double finest_beam_rad);

/// The field of the first selected row.
int first_field(const casacore::MeasurementSet& set, const SelectedRows& selected);

/// The times from the first to the last selected row of any field that moves.
TimeSpan moving_span(const SelectedRows& selected);

/// "1.2 arcsec", for messages.
std::string angle_words(double angle_rad);

}  // namespace misfit::ms_io
