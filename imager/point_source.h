#pragma once

#include "imager/geometry.h"

namespace misfit::imager {

/// A source without extent.
struct PointSource {
  DirectionCosines position;  ///< relative to the phase centre
  double flux_jy = 0;
};

}  // namespace misfit::imager
