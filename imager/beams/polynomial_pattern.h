#pragma once

#include <string>
#include <vector>

#include "imager/beams/voltage_pattern.h"

namespace misfit::imager {

/// A fit to a beam as it was measured at a frequency: power = 1 + Σ c_k x^(2k), or 1 over this, k = 1 … 4, with x = θ in arcmin
/// times the frequency in GHz.
struct BeamFit {
  double frequency_hz;
  double c[4];
};

/// Fits of one receiver.
struct FittedBand {
  double low_hz, high_hz;     ///< where it observes
  std::vector<BeamFit> fits;  ///< by frequency
};

/// How beams follow at frequencies between those of a band's fits.
enum class BetweenFits {
  nearest,       ///< from the nearest fit
  interpolated,  ///< linearly in frequency, by voltages at the same x; beyond the first and last fit, from that fit
};

/// Beams of a telescope by receiver, as power or its reciprocal was fitted.
struct FittedBeams {
  std::string telescope;
  std::vector<FittedBand> bands;  ///< by frequency
  BetweenFits between = BetweenFits::nearest;
  bool reciprocal = false;
  double farthest = 0;  ///< x beyond which fits do not hold, arcmin · GHz
};

/// Main lobes of fits: each ends where its power is first 0, or least, or `farthest` away; beyond that the voltage is 0. At a
/// frequency of no band the nearest band's beam is taken, with a doubt.
Pattern polynomial_pattern(const FittedBeams& beams);

/// The VLA's since 2010, 224 MHz to 50 GHz (Perley 2016, EVLA Memo 195).
const FittedBeams& vla_beams();
/// The upgraded GMRT's (NCRA 2022, Upgraded GMRT: updated primary-beam shape parameters).
const FittedBeams& gmrt_beams();
/// ATCA's, 1 to 116 GHz (Wieringa & Kesteven 1992, ATNF AT/39.3/024, and later fits that CASA's PBMath has).
const FittedBeams& atca_beams();

}  // namespace misfit::imager
