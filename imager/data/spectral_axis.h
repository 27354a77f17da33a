#pragma once

#include <cmath>
#include <string>

#include "imager/data/observation.h"

namespace misfit::imager {

/// The frequencies of an image's planes: plane k is centred on reference_hz + k · increment_hz and |increment_hz| wide.
struct SpectralAxis {
  double reference_hz = 0;       ///< centre of plane 0
  double increment_hz = 0;       ///< negative where frequency falls from plane to plane
  int channels = 1;              ///< planes
  std::string frame;             ///< in which these are frequencies, as FITS SPECSYS: "TOPOCENT", "LSRK", …; empty = unknown
  double rest_frequency_hz = 0;  ///< of the line; 0 = none was named

  double frequency_hz(int plane) const { return reference_hz + plane * increment_hz; }
  double width_hz() const { return std::abs(increment_hz); }
  /// The increment that files state: 1 Hz where the planes have no width, since none of 0 makes an axis.
  double step_hz() const { return increment_hz != 0 ? increment_hz : 1; }
  /// The fractional plane at a frequency; plane k reaches from k − 0.5 to k + 0.5.
  double plane_of(double hz) const { return (hz - reference_hz) / increment_hz; }
};

/// The one plane of an image of the whole band.
inline SpectralAxis whole_band(const Observation& observation) {
  return {observation.frequency_hz, observation.bandwidth_hz, 1, observation.spectral_frame, 0};
}

}  // namespace misfit::imager
