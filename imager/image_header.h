#pragma once

#include <string>
#include <vector>

#include "imager/geometry.h"
#include "imager/observation.h"
#include "imager/spectral_axis.h"
#include "imager/stokes.h"

namespace misfit::imager {

/// A number for the header, with its comment.
struct HeaderCard {
  std::string keyword;  ///< at most 8 characters
  double value = 0;
  std::string comment;
};

/// What the planes of an image share, and where each lies along frequency and Stokes parameters.
struct ImageHeader {
  ImageGeometry geometry;
  Observation observation;
  SpectralAxis spectral;
  std::vector<Stokes> stokes{Stokes::I};
  std::string unit = "Jy/beam";
  std::vector<HeaderCard> cards;
  std::vector<std::string> history;
};

}  // namespace misfit::imager
