#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "imager/data/geometry.h"

namespace misfit::ms_io {

/// A selecting expression for all sets of an image, or one for each, in the order in which they are named.
class PerSet {
 public:
  PerSet() = default;
  PerSet(std::string of_all) : of_set_{std::move(of_all)} {}
  PerSet(const char* of_all) : of_set_{of_all} {}
  /// One value is for all sets, however many there are.
  explicit PerSet(std::vector<std::string> of_set);

  /// True if the expression is empty for every set, which selects all.
  bool empty() const;
  const std::string& of(std::size_t set) const { return of_set_.size() == 1 ? of_set_.front() : of_set_.at(set); }
  /// As given: one, or one for each set.
  const std::vector<std::string>& values() const { return of_set_; }
  /// True if so many sets can have it: it is one for all, or there is one for each.
  bool fits(std::size_t sets) const { return of_set_.size() == 1 || of_set_.size() == sets; }

 private:
  std::vector<std::string> of_set_{""};
};

/// Which samples of MeasurementSets are meant, in casacore's MSSelection syntax, as CASA's tasks take it; empty means all. A
/// sample must be in each selection that is given. As in MSSelection, uv distances are √(u² + v²), in wavelengths at the
/// REF_FREQUENCY of the spectral window, whatever the channel; where they are not finite, rows are read, to be counted, but no
/// model is written. The ends of ranges of time and uv distance belong to them; times are rounded down to milliseconds. A time
/// without a date has the date of the first row that all other selections, except uv_range, select.
struct Selection {
  PerSet field = {};
  PerSet spectral_window = {};
  PerSet time_range = {};
  PerSet uv_range = {};
  PerSet antenna = {};
  PerSet scan = {};
  PerSet intent = {};  ///< of STATE's OBS_MODE
  PerSet observation = {};
  /// Where the visibilities are phased to; none: they stay where they are, which must be one direction, or one moving field.
  std::optional<imager::SkyDirection> phase_centre = {};
  std::string phase_centre_remark = "";  ///< a sentence for users on `phase_centre`; mostly empty
  /// How fields are phased whose phase centres move, without a phase_centre. about_themselves: as they are; what moves along
  /// stands still, and fields that turn with the Earth are refused. about_targets: to what they follow, the Earth included,
  /// with offsets of ephemerides undone. shifted_to_middle: to where they are in the middle of their rows; the sky stands
  /// still, and several fields that do not move are shifted to the first, which the other ways refuse.
  enum class Moving { about_themselves, about_targets, shifted_to_middle };
  Moving moving = Moving::about_themselves;
  /// The body that all fields follow with about_targets, whether they move or not: the name of a planet, or the path of an
  /// ephemeris; empty: each field follows what it is phased to.
  std::string body = "";
  /// True if a sample of Stokes I with one unusable parallel hand counts by the other, as in CASA's pseudoI.
  bool either_hand = false;
  /// FITS SPECSYS of the frame in which frequencies count, see parse_spectral_frame(), or SOURCE: the frame of the body
  /// followed, or else of the field's ephemeris; empty: the frame of the data.
  std::string spectral_frame = "";
  bool sights = false;  ///< whether blocks tell the sights of their rows, see MeasurementSet::sight_table()
  /// With sights: rows point where POINTING says, on-the-fly scans too, grouped to this tolerance; none: rows point where their
  /// fields do.
  std::optional<double> pointing_tolerance_rad = {};

  /// The selection with the expressions of one of the sets alone.
  Selection of_set(std::size_t set) const;
};

/// One of the ways to select.
struct SelectionKind {
  const char* option;             ///< its name in CASA's tasks
  PerSet Selection::*expression;  ///< where it stands
  const char* expected;           ///< what it may be, for people
};

/// All ways to select.
extern const std::array<SelectionKind, 8> selection_kinds;

/// Throws std::invalid_argument that names the option which has neither one expression nor one for each of so many sets.
void require_one_or_each(const Selection& selection, std::size_t sets);

/// The expressions given, for messages: "--field '3C*' --scan '3~5'"; empty without any.
std::string to_text(const Selection& selection);

}  // namespace misfit::ms_io
