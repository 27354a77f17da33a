#pragma once

#include <string>

#include "imager/data/geometry.h"

namespace misfit::imager {

/// The observation behind an image, as in its header.
struct Observation {
  std::string telescope;
  std::string observer;
  std::string object;    ///< the field's name
  std::string date_obs;  ///< start, UTC, ISO 8601: 2026-01-31T12:00:00.0
  SkyDirection phase_centre;
  double frequency_hz = 0;     ///< middle of the band imaged
  double bandwidth_hz = 0;     ///< from the lower edge of the lowest channel to the upper edge of the highest
  std::string spectral_frame;  ///< FITS SPECSYS: "TOPOCENT", "LSRK", …; empty when unknown
  std::string moving_at = {};  ///< UTC at which the phase centre was there, where the image moves with a target; else empty
};

}  // namespace misfit::imager
