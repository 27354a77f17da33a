#pragma once

#include <array>
#include <optional>
#include <string>

#include "imager/data/geometry.h"

namespace misfit::ms_io {

/// Which samples of a MeasurementSet are meant, in casacore's MSSelection syntax, as CASA's tasks take it; empty means all. A
/// sample must be in each that is given. As in MSSelection, uv distances are √(u² + v²), those in wavelengths at the
/// REF_FREQUENCY of the spectral window, whatever the channel; where they are not finite, rows are read, to be counted, but no
/// model is written. The ends of ranges of time and uv distance belong to them; times are rounded down to milliseconds. A time
/// without a date has that of the first row that the rest, but for uv_range, selects.
struct Selection {
  std::string field;
  std::string spectral_window;
  std::string time_range = "";
  std::string uv_range = "";
  std::string antenna = "";
  std::string scan = "";
  std::string intent = "";  ///< of STATE's OBS_MODE
  std::string observation = "";
  /// Where the visibilities are phased to; none: where they are, which must be one direction, or one moving field.
  std::optional<imager::SkyDirection> phase_centre = {};
  std::string phase_centre_remark = "";  ///< what users should know of `phase_centre`, in a sentence; mostly empty
  /// What becomes of fields whose phase centres move, without a phase_centre. They stay phased to themselves: what moves along
  /// stands still, unless they turn with the Earth, which is refused. Or to what they follow, offsets of ephemerides undone, or
  /// the Earth. Or they are shifted to where they are in the middle of their rows: the sky stands still. Several
  /// fields that stand still themselves are then shifted to the first, and otherwise refused.
  enum class Moving { about_themselves, about_targets, shifted_to_middle };
  Moving moving = Moving::about_themselves;
  /// FITS SPECSYS of the frame in which frequencies count, see parse_spectral_frame(); empty: that of the data.
  std::string spectral_frame = "";
};

/// One of the ways to select.
struct SelectionKind {
  const char* option;                  ///< its name in CASA's tasks
  std::string Selection::*expression;  ///< where it stands
  const char* expected;                ///< what it may be, for people
};

/// All of them.
extern const std::array<SelectionKind, 8> selection_kinds;

/// What is given, for messages: "--field '3C*' --scan '3~5'"; empty without any.
std::string to_text(const Selection& selection);

}  // namespace misfit::ms_io
