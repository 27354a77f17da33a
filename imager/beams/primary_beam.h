#pragma once

#include <vector>

#include "imager/beams/voltage_pattern.h"
#include "imager/data/geometry.h"
#include "imager/data/image.h"

namespace misfit::imager {

/// The part of an image that pairs of two dishes make at a frequency.
struct BeamShare {
  Pattern one;
  Pattern other;
  double frequency_hz = 0;
  double weight = 0;    ///< Σ of the image's weights over their samples, in any unit
  double turn_rad = 0;  ///< where the zenith is, from north through east, for patterns that are not round
};

/// Vₒₙₑ Vₒₜₕₑᵣ of the two at an angle θ ≤ 90° from the axis, of which `sine` is sin θ; for patterns that are not round, the
/// mean over position angles.
double power(const BeamShare& share, double sine);

/// The power that an array sees of a source off axis, relative to the same on axis: the mean of Vₒₙₑ Vₒₜₕₑᵣ over all pairs that
/// make the image, by their weights. A source's dirty image is its flux times this, and so are its CLEAN components. Patterns
/// that are not round are turned as the zenith was.
class PrimaryBeam {
 public:
  /// Shares of frequencies less than `apart` of themselves from each other may be taken together, at their mean, which changes
  /// the main lobe by less than 1e-6 where that is a thousandth; where patterns are not round, eight times as far, which
  /// changes it by less than 1e-4. Throws std::invalid_argument where the weights do not add up to more than 0, or a frequency
  /// is not positive.
  explicit PrimaryBeam(const std::vector<BeamShare>& shares, double apart = 1e-3);

  bool is_round() const;
  /// The power at an angle θ ≤ 90° from the axis, of which `sine` is sin θ; the mean over position angles.
  double power(double sine) const;
  /// sin θ of where it first falls to `level`, which is above 0 and below 1; 1 where it does not.
  double sine_at(double level) const;
  /// The whole angle between its half-power points; 180° where there are none.
  double half_power_width_rad() const;
  /// sin θ beyond which no dish's main lobe reaches at any frequency.
  double main_lobe_sine() const;
  /// The step of tables in sin θ, of which the narrowest main lobe has about 60.
  double step() const { return 0.02 * narrowest_; }

  /// sin θ up to which all patterns that are not round are known in all directions.
  double known_sine() const;

  const std::vector<BeamShare>& shares() const { return shares_; }  ///< taken together; the weights add up to 1
  double apart() const { return apart_; }

 private:
  double apart_;
  std::vector<BeamShare> shares_;
  double narrowest_ = 1;  ///< sin θ of the finest details of all patterns
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
/// included, whose shape no simple model has, and beyond the horizon. Right to 1e-9; to 1e-5 for patterns that are not round.
Image primary_beam_image(const PrimaryBeam& beam, const ImageGeometry& geometry, const BeamOnImage& view);

/// The image with each pixel divided by the beam's; NaN where the beam is.
Image corrected(const Image& image, const Image& beam);

}  // namespace misfit::imager
