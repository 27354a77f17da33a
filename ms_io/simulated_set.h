#pragma once

#include <array>
#include <complex>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "imager/data/geometry.h"
#include "imager/data/visibilities.h"

namespace misfit::ms_io {

/// Where antennas point, and what they are phased to.
struct SimulatedField {
  std::string name = "SIMULATED";
  imager::SkyDirection phase_centre;
};

/// A synthetic observation: one spectral window, linear feeds with correlations XX and YY.
struct SimulatedObservation {
  std::string telescope = "EVLA";
  std::vector<SimulatedField> fields{{}};  ///< of one frame, visited by turns, an integration each
  std::vector<std::string> antenna_name;
  std::vector<std::array<double, 3>> antenna_itrf_m;
  std::vector<double> dish_diameter_m{25};  ///< of the antennas by turns
  std::vector<double> time_mjd_s;           ///< middle of each integration, UTC, seconds as in the column TIME
  double interval_s = 10;
  std::vector<double> frequency_hz;  ///< [channel]
  double channel_width_hz = 0;
  double noise_jy = 0;  ///< standard deviation of real and imaginary part, independent per correlation
  unsigned seed = 1;

  std::size_t field_of(std::size_t integration) const { return integration % fields.size(); }
};

/// UVW in metres [baseline][3] of one integration; baselines run over antenna1 < antenna2, antenna2 fastest.
using BaselineUvw = std::function<std::vector<double>(std::size_t integration)>;
/// Stokes I visibilities [row][channel], Jy, at the coordinates given, of the integration that BaselineUvw was last called for,
/// with the sights of their rows, in which the zenith is 0.
using ExactVisibilities = std::function<std::vector<std::complex<double>>(const imager::SampleCoordinates&)>;

/// Writes a new MeasurementSet at `path`, with all of the required subtables filled. WEIGHT is 1/noise² (1 without noise),
/// SIGMA the noise (1 without). The table is written beside `path` and renamed when complete. `progress(done, total)` is
/// called after every integration, and counts them. Throws std::runtime_error when `path` exists or cannot be written, and
/// std::invalid_argument when the observation is incomplete or a function returns the wrong number of values.
void write_simulated_set(const std::string& path, const SimulatedObservation& observation, const BaselineUvw& uvw,
                         const ExactVisibilities& visibilities, const std::function<void(std::size_t, std::size_t)>& progress);

}  // namespace misfit::ms_io
