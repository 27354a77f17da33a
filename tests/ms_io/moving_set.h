#pragma once

#include <boost/test/unit_test.hpp>
#include <cmath>

#include "imager/direct/source_sums.h"
#include "tests/moving_fields.h"
#include "tests/ms_io/small_set.h"

namespace misfit::ms_io::moving_testing {

using namespace misfit::testing;
using namespace misfit::ms_io::testing;
using Moving = Selection::Moving;

constexpr double degree = 3.14159265358979323846 / 180, arcsec = degree / 3600, day_s = 86400, flux_jy = 2;
constexpr SkyPoint about{1.25, -0.5}, source{1.2507, -0.5004};

/// Integrations of ten minutes.
inline SimulatedObservation slow_observation() {
  SimulatedObservation observation = small_observation();
  observation.interval_s = 600;
  for (std::size_t t = 0; t < integrations; ++t) observation.time_mjd_s[t] = 4.9e9 + 600.0 * static_cast<double>(t);
  return observation;
}

/// A field that moves past a source that stands still.
struct MovingSet : SmallSet {
  MovingField moving;

  explicit MovingSet(Path way, const SimulatedObservation& observation = slow_observation())
      : SmallSet(observation), moving(path(), 0, way, about) {
    put_fixed_source(path(), {moving}, source, flux_jy);
  }
};

inline Selection to_direction(const SkyPoint& point, Path way) {
  Selection selection;
  selection.phase_centre = imager::SkyDirection{point.ra_rad, point.dec_rad, frame_of(way)};
  return selection;
}

inline Selection with(Moving moving) {
  Selection selection;
  selection.moving = moving;
  return selection;
}

inline imager::Source source_from(const imager::SkyDirection& centre) {
  return {imager::direction_cosines({source.ra_rad, source.dec_rad, centre.frame}, centre), flux_jy};
}

/// How far the set's visibilities lie from those of a source, as predicted at the coordinates that are handed out.
inline double largest_error_jy(const MeasurementSet& set, const imager::Source& of) {
  double largest = 0;
  std::size_t seen = 0;
  const auto stream = set.open();
  while (const auto block = stream->next()) {
    const auto expected = imager::predict_sources({of}, *block, 1);
    for (std::size_t i = 0; i < expected.size(); ++i)
      largest = std::max(largest, std::abs(expected[i] - std::complex<double>(block->visibility[i])));
    seen += block->rows();
  }
  BOOST_TEST(seen == rows);
  return largest;
}

/// DATA are rounded to single precision, and again once shifted, each by 6e-8; directions of casacore are right to some 1e-12
/// rad, or 1e-10 turns of these 50 m at 0.3 m.
constexpr double roundings_jy = 2.5e-7 * flux_jy;

/// Distance on the sky, of directions in one frame.
inline double apart_rad(const imager::SkyDirection& one, const SkyPoint& other) {
  const imager::DirectionCosines at = imager::direction_cosines({other.ra_rad, other.dec_rad, one.frame}, one);
  return std::hypot(at.l, at.m);
}

/// The row's DATA become those of a source at `at`, seen about a centre in the same frame.
inline void put_point(casacore::MeasurementSet& open, casacore::rownr_t row, const SkyPoint& at,
                      const imager::SkyDirection& centre) {
  const imager::Source of{imager::direction_cosines({at.ra_rad, at.dec_rad, centre.frame}, centre), flux_jy};
  const imager::SampleCoordinates where{casacore::ArrayColumn<double>(open, "UVW")(row).tovector(),
                                        small_observation().frequency_hz};
  const auto values = imager::predict_sources({of}, where, 1);
  casacore::Matrix<casacore::Complex> cell(2, channels);
  for (std::size_t c = 0; c < channels; ++c) cell(0, c) = cell(1, c) = casacore::Complex(values[c]);
  casacore::ArrayColumn<casacore::Complex>(open, "DATA").put(row, cell);
}

inline bool says(const MeasurementSet& set, const std::string& part) {
  for (const std::string& sentence : set.remarks())
    if (contains(sentence, part)) return true;
  return false;
}

}  // namespace misfit::ms_io::moving_testing
