#pragma once

#include <string>
#include <vector>

#include "imager/data/geometry.h"
#include "imager/data/observation.h"
#include "imager/data/spectral_axis.h"
#include "imager/data/stokes.h"

namespace misfit::imager {

/// A number for the header, with its comment.
struct HeaderCard {
  std::string keyword;  ///< at most 8 characters
  double value = 0;
  std::string comment;
};

/// The term of a spectrum's polynomial that an image belongs to.
struct TaylorTerm {
  int order = 0;
  int terms = 1;  ///< of the polynomial; 1: the image is not one of several terms

  bool several() const { return terms > 1; }
};

/// FITS keywords of a Taylor term, the same in CASA's miscinfo; both stand where there are several terms.
inline constexpr const char* taylor_order_key = "TAYTERM";
inline constexpr const char* taylor_terms_key = "NTERMS";

/// Keyword of a mosaic's model whose pixels are the sky times its primary beam: 1.
inline constexpr const char* flat_noise_key = "FLATNOIS";

/// The Taylor term that a header states, by numbers that may be anything: none where it does not state several terms.
inline TaylorTerm stated_taylor_term(double order, double terms) {
  constexpr double most = 1000;
  if (!(order >= 0 && order < most && terms > 1 && terms < most)) return {};
  return {static_cast<int>(order), static_cast<int>(terms)};
}

/// The data that the planes of an image share, and the frequency and Stokes parameter of each.
struct ImageHeader {
  ImageGeometry geometry;
  Observation observation;
  SpectralAxis spectral;
  std::vector<Stokes> stokes{Stokes::I};
  std::string unit = "Jy/beam";
  std::vector<HeaderCard> cards;
  std::vector<std::string> history;
  std::string quantity = "Intensity";  ///< FITS BTYPE, by the name that casacore has for it where it has one
  TaylorTerm taylor = {};
  bool flat_noise = false;  ///< of a mosaic's model: whether its pixels are the sky times the mosaic's primary beam
};

}  // namespace misfit::imager
