#pragma once

#include <algorithm>
#include <cmath>
#include <string>

#include "imager/data/observation.h"

namespace misfit::imager {

/// A range of frequencies between two edges.
struct FrequencyBand {
  double low_hz = 0;
  double high_hz = 0;

  double width_hz() const { return high_hz - low_hz; }
  double middle_hz() const { return 0.5 * (low_hz + high_hz); }
};

/// The frequencies of an image's planes. Plane k is centred on reference_hz + k · increment_hz and |increment_hz| wide. Or
/// planes are evenly spaced in wavelength, which is so in optical velocity c (ν₀/ν − 1): plane k is centred on
/// reference_hz / (1 − k · increment_hz / reference_hz), and reaches half-way to its neighbours.
struct SpectralAxis {
  double reference_hz = 0;       ///< centre of plane 0
  double increment_hz = 0;       ///< from plane 0 on, its slope there; negative where frequency falls from plane to plane
  int channels = 1;              ///< planes
  std::string frame;             ///< in which these are frequencies, as FITS SPECSYS: "TOPOCENT", "LSRK", …; empty = unknown
  double rest_frequency_hz = 0;  ///< of the line; 0 = none was named
  bool in_wavelength = false;    ///< whether planes are evenly spaced in wavelength

  double frequency_hz(double plane) const {
    return in_wavelength ? reference_hz / (1 - plane * increment_hz / reference_hz) : reference_hz + plane * increment_hz;
  }
  double width_hz(int plane = 0) const { return in_wavelength ? planes(plane, 1).width_hz() : std::abs(increment_hz); }
  /// The increment that files state: 1 Hz where the planes have no width, since an increment of 0 makes no axis.
  double step_hz() const { return increment_hz != 0 ? increment_hz : 1; }
  /// The fractional plane at a frequency; plane k reaches from k − 0.5 to k + 0.5.
  double plane_of(double hz) const { return (hz - reference_hz) / increment_hz * (in_wavelength ? reference_hz / hz : 1); }
  /// The frequencies that `count` planes cover together.
  FrequencyBand planes(int first, int count) const {
    const double one = frequency_hz(first - 0.5), other = frequency_hz(first + count - 0.5);
    return {std::min(one, other), std::max(one, other)};
  }
  FrequencyBand band() const { return planes(0, channels); }
};

/// The one plane of an image of the whole band.
inline SpectralAxis whole_band(const Observation& observation) {
  return {observation.frequency_hz, observation.bandwidth_hz, 1, observation.spectral_frame, 0, false};
}

}  // namespace misfit::imager
