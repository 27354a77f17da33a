#include <casacore/measures/Measures/MCEpoch.h>
#include <casacore/measures/Measures/MeasConvert.h>
#include <casacore/measures/Measures/MeasTable.h>

#include <cmath>
#include <sstream>

#include "ms_io/field_doubts_internal.h"
#include "ms_io/metadata_internal.h"
#include "ms_io/observing_place_internal.h"

namespace misfit::ms_io {
namespace {

/// True if casacore knows the Earth's rotation. Without tables of the IERS it takes UTC for UT1, which differ by up to 0.9 s:
/// 13.5 arcsec at the equator.
bool rotation_is_known(const casacore::MEpoch& when) {
  return casacore::MeasTable::dUT1(casacore::MEpoch::Convert(when, casacore::MEpoch::UTC)().get("d").getValue()) != 0;
}

std::vector<std::string> doubts_of_rotation(const casacore::MeasurementSet& set, const std::string& field,
                                            const casacore::MEpoch& when, int observation) {
  std::vector<std::string> doubts;
  const std::string turns = "the frame of field " + field + " turns with the Earth, ";
  const ObservingPlace place = observing_place(set, observation);
  if (!place.dispute.empty()) doubts.push_back(turns + "and " + place.dispute);
  if (place.of_antennas && place.dispute.empty())
    doubts.push_back(turns + "and is taken to be that of the middle of its antennas, since casacore does not know '" +
                     telescope_name(set, observation) + "'");
  if (!rotation_is_known(when))
    doubts.push_back(turns +
                     "whose rotation casacore has no IERS table of at that time: directions on the sky may be wrong by "
                     "13 arcsec, the same way in all programs that lack the table");
  return doubts;
}

std::string doubt_of_rates(const std::string& field, double since_origin_s) {
  constexpr double year_s = 365.25 * 86400;
  if (std::abs(since_origin_s) < year_s) return "";
  std::ostringstream doubt;
  doubt.precision(3);
  doubt << "field " << field << " moves by NUM_POLY's rates from where it was at FIELD's TIME, "
        << std::abs(since_origin_s) / year_s << " years " << (since_origin_s > 0 ? "before" : "after")
        << " its rows: it is far from there unless that TIME is meant; 0 means that it was never filled";
  return doubt.str();
}

}  // namespace

std::vector<std::string> doubts_of_motion(const casacore::MeasurementSet& set, const FieldDirections& fields, int field,
                                          const Moment& first) {
  std::vector<std::string> doubts;
  if (fields.motion(field) == Motion::earth)
    doubts = doubts_of_rotation(set, fields.full_label(field), fields.epoch(first.time_s), observation_of(set, first.row));
  if (std::string doubt = doubt_of_rates(fields.full_label(field), fields.since_origin_s(field, first.time_s)); !doubt.empty())
    doubts.push_back(std::move(doubt));
  return doubts;
}

}  // namespace misfit::ms_io
