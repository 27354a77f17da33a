#pragma once

#include <memory>
#include <string>

namespace misfit::imager {

/// The voltage of a sort of dishes from a source off axis, over the voltage from the same source on axis: signed, 1 on the
/// axis. A pair of dishes sees the product of its two voltages.
class VoltagePattern {
 public:
  virtual ~VoltagePattern() = default;

  /// The voltage at an angle θ ≤ 90° from the axis, of which `sine` is sin θ; for a pattern that is not round, the root of its
  /// mean power at this θ.
  virtual double voltage(double sine, double frequency_hz) const = 0;
  /// True if it is the same at all position angles.
  virtual bool is_round() const { return true; }
  /// The voltage at a position angle in the dish's own frame, counted from the zenith towards where east is when the zenith is
  /// north.
  virtual double voltage_at(double sine, double /*angle_rad*/, double frequency_hz) const {
    return voltage(sine, frequency_hz);
  }
  /// sin θ of where the main lobe ends: at the first null, or where a formula without a null ends, beyond which the voltage is
  /// 0. 1 where it reaches the horizon.
  virtual double main_lobe_sine(double frequency_hz) const = 0;
  /// sin θ up to which it is known in all directions and has no step: where a formula ends, if it ends in one; else 1.
  virtual double continuous_sine(double /*frequency_hz*/) const { return 1; }
  /// sin θ as small as the pattern's finest details, λ/D of an aperture of diameter D.
  virtual double detail_sine(double frequency_hz) const = 0;
  /// A sentence where it may be wrong by more than a few percent at half power at this frequency; else empty.
  virtual std::string doubt(double frequency_hz) const;
};

/// Sorts of dishes whose patterns are one object are alike.
using Pattern = std::shared_ptr<const VoltagePattern>;

/// θ in arcmin times the frequency in GHz, in which beams are tabulated.
double arcmin_ghz(double sine, double frequency_hz);
/// sin θ of such a product; 1 where θ is 90° or more.
double sine_of_arcmin_ghz(double product, double frequency_hz);

}  // namespace misfit::imager
