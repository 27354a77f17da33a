#pragma once

#include <vector>

#include "imager/data/geometry.h"
#include "imager/data/image.h"

namespace misfit::imager {

/// A dish as its beam shows it: a circular aperture, uniformly lit, but for a dark disc in its middle.
struct Dish {
  double diameter_m = 0;  ///< effective: with which the beam is as wide as it is seen to be
  double blockage_m = 0;  ///< of the disc; 0: none
};

inline bool operator==(const Dish& a, const Dish& b) {
  return a.diameter_m == b.diameter_m && a.blockage_m == b.blockage_m;
}

/// The voltage that a source off axis gives, relative to the same on axis: the transform of the lit ring (Born & Wolf 1999,
/// Principles of Optics, section 8.6.2; Thompson, Moran & Swenson 2017, Interferometry and Synthesis in Radio Astronomy),
///
///     V(x) = (2 J₁(x)/x − b² 2 J₁(bx)/(bx)) / (1 − b²),   x = π D sin θ / λ,   b = blockage / D.
///
/// Without blockage V² is the Airy disc: ½ at 0.514 497 λ/D, 0 at 1.219 670 λ/D. `sin_per_wavelength` is sin θ / λ, 1/m.
/// CASA (PBMath1DAiry) takes J₁ of x/b there, not of bx, which makes beams wider: of ALMA's dishes by 0.9 % at half power.
double voltage_pattern(const Dish& dish, double sin_per_wavelength);

/// sin θ / λ, 1/m, at which the voltage is first 0: 1.219 670/D of an open dish, nearer where there is a blockage.
double first_null_per_m(const Dish& dish);

/// What part of an image pairs of two dishes make at a frequency.
struct BeamShare {
  Dish one;
  Dish other;
  double frequency_hz = 0;
  double weight = 0;  ///< Σ of the image's weights over their samples, in any unit
};

/// Vₒₙₑ Vₒₜₕₑᵣ of the two at an angle θ ≤ 90° from the axis, of which `sine` is sin θ.
double power(const BeamShare& share, double sine);

/// The power that an array sees of a source off axis, relative to the same on axis: the mean of Vₒₙₑ Vₒₜₕₑᵣ over all that make
/// the image, by their weights. A source's dirty image is its flux times this, and so is what CLEAN finds. The same at all
/// position angles.
class PrimaryBeam {
 public:
  /// Shares of frequencies less than `apart` of themselves from each other may be taken together, at their mean, which changes
  /// the main lobe by less than 1e-6 where that is a thousandth. Throws std::invalid_argument where the weights do not add up
  /// to more than 0, a frequency is not positive, or a dish is none: 0 ≤ blockage < diameter.
  explicit PrimaryBeam(const std::vector<BeamShare>& shares, double apart = 1e-3);

  /// At an angle θ ≤ 90° from the axis, of which `sine` is sin θ.
  double power(double sine) const;
  /// sin θ of where it first falls to `level`, which is above 0 and below 1; 1 where it does not.
  double sine_at(double level) const;
  /// The whole angle between its half-power points; 180° where there are none.
  double half_power_width_rad() const;
  /// sin θ beyond which no dish's main lobe reaches at any frequency: the widest first null; 1 where one has none.
  double main_lobe_sine() const;
  /// The step of tables in sin θ, of which the narrowest main lobe has 60.
  double step() const { return 0.02 * narrowest_; }

  const std::vector<BeamShare>& shares() const { return shares_; }  ///< as taken together; the weights add up to 1

 private:
  std::vector<BeamShare> shares_;
  double narrowest_ = 0;  ///< λ/D of the largest dish at the highest frequency
};

/// How a primary beam lies on an image.
struct BeamOnImage {
  DirectionCosines pointing = {};  ///< of its axis, from the phase centre
  double limit = 0.2;              ///< pixels where it is lower have no value; above 0 and below 1
  int threads = 1;
};

/// Throws std::invalid_argument unless its limit is above 0 and below 1.
void require_limit(const BeamOnImage& view);

/// The beam in each pixel, by the true angle between it and the axis. NaN beyond where it first falls to the limit, sidelobes
/// included, whose shape no simple model has, and beyond the horizon. Right to 1e-9.
Image primary_beam_image(const PrimaryBeam& beam, const ImageGeometry& geometry, const BeamOnImage& view);

/// The image with each pixel divided by the beam's; NaN where that is.
Image corrected(const Image& image, const Image& beam);

}  // namespace misfit::imager
