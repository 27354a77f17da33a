#pragma once

#include <casacore/measures/Measures/MDirection.h>
#include <casacore/measures/Measures/MEpoch.h>
#include <casacore/measures/Measures/MeasFrame.h>
#include <casacore/ms/MeasurementSets/MSFieldColumns.h>
#include <casacore/ms/MeasurementSets/MeasurementSet.h>

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "imager/data/geometry.h"
#include "ms_io/body_internal.h"

namespace misfit::ms_io {

/// Where a field is phased to.
struct FieldCentre {
  int field = 0;
  std::string name;
  imager::SkyDirection direction;
  casacore::MEpoch observed;  ///< at which B1950 is taken: it turns against the other frames, by 0.1 arcsec in 30 years
};

/// How a direction of FIELD depends on time: not at all; by a polynomial, an ephemeris or a frame of date, so that it follows a
/// target; or by a frame that turns with the Earth.
enum class Motion { none, target, earth };

/// When a field is looked at.
struct Moment {
  double time_s = 0;      ///< as TIME stores it
  std::uint64_t row = 0;  ///< of the field: it is seen from this row's telescope
};

/// The directions of a set's fields at any time, in J2000 where their own frame is not J2000, ICRS or B1950. All functions
/// throw std::runtime_error that names the field where there is none of that number, or its direction cannot be found.
class FieldDirections {
 public:
  /// Images of the fields move with `body`, or else with what each field follows.
  FieldDirections(const casacore::MeasurementSet& set, const std::string& path, std::shared_ptr<const Body> body = nullptr);

  /// The motion of PHASE_DIR.
  Motion motion(int field) const;
  /// The motion of REFERENCE_DIR.
  Motion pointing_motion(int field) const;
  /// True if its direction is a polynomial of time, which is meant for the time of its rows.
  bool goes_by_rates(int field) const { return has_rates(columns_.phaseDir(), row_of(field)); }
  /// How far a TIME lies from the origin of the field's rates; 0 without rates.
  double since_origin_s(int field, double time_s) const;
  /// Where the field is phased to: PHASE_DIR, which is an offset where the field has an ephemeris.
  FieldCentre centre(int field, const Moment& when);
  /// Where the body is, as seen from the field's telescope; without a body, the field's ephemeris without the offset of
  /// PHASE_DIR or, where it has none, centre().
  FieldCentre target(int field, const Moment& when);
  /// The velocity of the body, or else of the field's ephemeris, and its frame, see Body. Both throw where there is neither.
  double recession_m_s(int field, double time_s);
  casacore::MFrequency::Types velocity_frame(int field);
  /// True if the field's own frame is that of a planet, so that it depends on the place of its telescope.
  bool is_phased_to_body(int field) const;
  /// Why the place of the field's telescope is not known, see ObservingPlace; empty where it is.
  std::string place_doubt(const Moment& when) { return place_of(when).doubt; }
  /// Where the antennas of the field point: REFERENCE_DIR, taken as PHASE_DIR is.
  imager::SkyDirection pointing(int field, const Moment& when);

  /// "3 (M51)".
  std::string label(int field) const;
  /// "3 (M51) of a.ms".
  std::string full_label(int field) const { return label(field) + " of " + path_; }
  std::string name(int field) const;
  /// TIME as casacore has it.
  casacore::MEpoch epoch(double time_s) const { return {casacore::MVEpoch(casacore::Quantity(time_s, "s")), time_reference_}; }
  /// The TIME that the set would store.
  double time_s(const casacore::MEpoch& epoch) const;

 private:
  /// From where a row was observed, and when it was asked for.
  struct Place {
    casacore::MeasFrame frame;
    std::string doubt;  ///< see ObservingPlace
  };

  casacore::rownr_t row_of(int field) const;
  bool has_ephemeris(casacore::rownr_t row) const;
  bool has_rates(const casacore::ArrayColumn<double>& cells, casacore::rownr_t row) const;
  Motion motion(casacore::rownr_t row, const casacore::ArrayColumn<double>& cells,
                const casacore::ArrayMeasColumn<casacore::MDirection>& column) const;
  void require_directions(const casacore::ArrayColumn<double>& cells, casacore::rownr_t row) const;
  double field_time_s(double time_s) const;
  const Ephemeris* ephemeris_of(casacore::rownr_t row);
  const Ephemeris& ephemeris_with_velocities(int field);
  casacore::MDirection on_ephemeris(const Ephemeris& ephemeris, const casacore::MDirection& offset, const Moment& when) const;
  FieldCentre seen(int field, const casacore::MDirection& direction, const Moment& when);
  casacore::MDirection equatorial(const casacore::MDirection& direction, const Moment& when);
  Place& place_of(const Moment& when);

  const casacore::MeasurementSet& set_;
  std::string path_;
  std::shared_ptr<const Body> body_;  ///< null: each field follows its own
  casacore::MSField plain_;           ///< without ephemerides
  casacore::MSFieldColumns columns_;
  std::vector<int> ephemeris_id_;          ///< [field]; empty: none has one
  casacore::MEpoch::Ref time_reference_;   ///< of TIME
  std::map<int, Ephemeris> ephemerides_;   ///< by EPHEMERIS_ID
  std::map<std::uint64_t, Place> places_;  ///< by the row
};

/// The phase centre of `field` at the time of `row`. Throws what FieldDirections does.
FieldCentre field_centre(const casacore::MeasurementSet& set, const std::string& path, int field, std::uint64_t row);

}  // namespace misfit::ms_io
