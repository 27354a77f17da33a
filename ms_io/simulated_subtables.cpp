#include <casacore/casa/Arrays/ArrayMath.h>
#include <casacore/casa/BasicSL/Constants.h>
#include <casacore/measures/Measures/MFrequency.h>
#include <casacore/measures/Measures/Stokes.h>
#include <casacore/ms/MeasurementSets/MSColumns.h>

#include <cmath>

#include "ms_io/simulated_subtables_internal.h"

namespace misfit::ms_io {
namespace {

using casacore::Matrix;
using casacore::Vector;

/// First and last instant, MJD seconds.
Vector<double> time_range(const SimulatedObservation& observation) {
  const double half = observation.interval_s / 2;
  return Vector<double>(std::vector<double>{observation.time_mjd_s.front() - half, observation.time_mjd_s.back() + half});
}

void fill_antennas(casacore::MSAntenna& table, const SimulatedObservation& observation) {
  table.addRow(observation.antenna_name.size());
  casacore::MSAntennaColumns columns(table);
  for (std::size_t a = 0; a < observation.antenna_name.size(); ++a) {
    const std::array<double, 3>& position = observation.antenna_itrf_m[a];
    columns.name().put(a, observation.antenna_name[a]);
    columns.station().put(a, observation.antenna_name[a]);
    columns.type().put(a, "GROUND-BASED");
    columns.mount().put(a, "ALT-AZ");
    columns.position().put(a, Vector<double>(std::vector<double>(position.begin(), position.end())));
    columns.offset().put(a, Vector<double>(3, 0.0));
    columns.dishDiameter().put(a, observation.dish_diameter_m[a % observation.dish_diameter_m.size()]);
    columns.flagRow().put(a, false);
  }
}

void fill_feeds(casacore::MSFeed& table, const SimulatedObservation& observation) {
  table.addRow(observation.antenna_name.size());
  casacore::MSFeedColumns columns(table);
  const Vector<double> range = time_range(observation);
  Matrix<casacore::Complex> response(2, 2, casacore::Complex(0));
  response.diagonal() = casacore::Complex(1);
  for (std::size_t a = 0; a < observation.antenna_name.size(); ++a) {
    columns.antennaId().put(a, static_cast<int>(a));
    columns.feedId().put(a, 0);
    columns.spectralWindowId().put(a, -1);
    columns.beamId().put(a, -1);
    columns.time().put(a, (range(0) + range(1)) / 2);
    columns.interval().put(a, range(1) - range(0));
    columns.numReceptors().put(a, 2);
    columns.beamOffset().put(a, Matrix<double>(2, 2, 0.0));
    columns.polarizationType().put(a, Vector<casacore::String>(std::vector<casacore::String>{"X", "Y"}));
    columns.polResponse().put(a, response);
    columns.position().put(a, Vector<double>(3, 0.0));
    columns.receptorAngle().put(a, Vector<double>(2, 0.0));
  }
}

void fill_fields(casacore::MSField& table, const SimulatedObservation& observation) {
  casacore::MSFieldColumns columns(table);
  const std::string& frame = observation.fields.front().phase_centre.frame;
  columns.setDirectionRef(frame == "ICRS"  ? casacore::MDirection::ICRS
                          : frame == "FK4" ? casacore::MDirection::B1950
                                           : casacore::MDirection::J2000);
  table.addRow(observation.fields.size());  // only now: the frame of a column with rows is fixed
  for (std::size_t f = 0; f < observation.fields.size(); ++f) {
    const SimulatedField& field = observation.fields[f];
    Matrix<double> direction(2, 1);
    direction(0, 0) = field.phase_centre.ra_rad;
    direction(1, 0) = field.phase_centre.dec_rad;
    columns.name().put(f, field.name);
    columns.code().put(f, "");
    columns.time().put(f, observation.time_mjd_s.front());
    columns.numPoly().put(f, 0);
    columns.phaseDir().put(f, direction);
    columns.delayDir().put(f, direction);
    columns.referenceDir().put(f, direction);
    columns.sourceId().put(f, -1);
    columns.flagRow().put(f, false);
  }
}

void fill_spectral_window(casacore::MSSpectralWindow& table, const SimulatedObservation& observation) {
  table.addRow(1);
  casacore::MSSpWindowColumns columns(table);
  const Vector<double> frequency(observation.frequency_hz);
  const Vector<double> width(frequency.nelements(), observation.channel_width_hz);
  columns.name().put(0, "SIMULATED");
  columns.numChan().put(0, static_cast<int>(frequency.nelements()));
  columns.measFreqRef().put(0, casacore::MFrequency::TOPO);
  columns.refFrequency().put(0, frequency(0));
  columns.chanFreq().put(0, frequency);
  columns.chanWidth().put(0, width);
  columns.effectiveBW().put(0, casacore::abs(width));
  columns.resolution().put(0, casacore::abs(width));
  columns.totalBandwidth().put(0, casacore::sum(casacore::abs(width)));
  columns.netSideband().put(0, 1);
  columns.ifConvChain().put(0, 0);
  columns.freqGroup().put(0, 0);
  columns.freqGroupName().put(0, "");
  columns.flagRow().put(0, false);
}

void fill_polarization(casacore::MSPolarization& table) {
  table.addRow(1);
  casacore::MSPolarizationColumns columns(table);
  Matrix<int> product(2, 2, 0);
  product.column(1) = 1;
  columns.numCorr().put(0, 2);
  columns.corrType().put(0, Vector<int>(std::vector<int>{casacore::Stokes::XX, casacore::Stokes::YY}));
  columns.corrProduct().put(0, product);
  columns.flagRow().put(0, false);
}

void fill_observation(casacore::MSObservation& table, const SimulatedObservation& observation) {
  table.addRow(1);
  casacore::MSObservationColumns columns(table);
  const Vector<double> range = time_range(observation);
  columns.telescopeName().put(0, observation.telescope);
  columns.observer().put(0, "misfit");
  columns.project().put(0, "simulation");
  columns.scheduleType().put(0, "");
  columns.schedule().put(0, Vector<casacore::String>());
  columns.log().put(0, Vector<casacore::String>());
  columns.timeRange().put(0, range);
  columns.releaseDate().put(0, range(1));
  columns.flagRow().put(0, false);
}

void fill_state_and_processor(casacore::MeasurementSet& set) {
  set.state().addRow(1);
  casacore::MSStateColumns state(set.state());
  state.sig().put(0, true);
  state.ref().put(0, false);
  state.cal().put(0, 0.0);
  state.load().put(0, 0.0);
  state.subScan().put(0, 0);
  state.obsMode().put(0, "OBSERVE_TARGET#ON_SOURCE");
  state.flagRow().put(0, false);
  set.processor().addRow(1);
  casacore::MSProcessorColumns processor(set.processor());
  processor.type().put(0, "CORRELATOR");
  processor.subType().put(0, "SIMULATED");
  processor.typeId().put(0, -1);
  processor.modeId().put(0, -1);
  processor.flagRow().put(0, false);
}

}  // namespace

void fill_subtables(casacore::MeasurementSet& set, const SimulatedObservation& observation) {
  fill_antennas(set.antenna(), observation);
  fill_feeds(set.feed(), observation);
  fill_fields(set.field(), observation);
  fill_spectral_window(set.spectralWindow(), observation);
  fill_polarization(set.polarization());
  fill_observation(set.observation(), observation);
  fill_state_and_processor(set);
  set.dataDescription().addRow(1);
  casacore::MSDataDescColumns description(set.dataDescription());
  description.spectralWindowId().put(0, 0);
  description.polarizationId().put(0, 0);
  description.flagRow().put(0, false);
}

}  // namespace misfit::ms_io
