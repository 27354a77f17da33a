#include "imager/beams/tapered_pattern.h"

#include <algorithm>
#include <cmath>

#include "imager/numerics/constants.h"

namespace misfit::imager {
namespace {

class CosineTapered : public VoltagePattern {
 public:
  explicit CosineTapered(double width) : width_(width) {}

  /// By the distance d from x = ½, where both cosine and denominator are 0: sin(πd) / (4d (1 + d)).
  double voltage(double sine, double frequency_hz) const override {
    const double d = widths * arcmin_ghz(sine, frequency_hz) / width_ - 0.5, turned = pi * d;
    const double sinc = std::abs(turned) < 1e-4 ? 1 - turned * turned / 6 : std::sin(turned) / turned;
    return pi / 4 * sinc / (1 + d);
  }
  double main_lobe_sine(double frequency_hz) const override { return sine_of_arcmin_ghz(1.5 / widths * width_, frequency_hz); }
  double detail_sine(double frequency_hz) const override { return sine_of_arcmin_ghz(width_ / widths, frequency_hz); }

 private:
  static constexpr double widths = 1.189;
  double width_;  ///< arcmin · GHz
};

class CosineCubed : public VoltagePattern {
 public:
  CosineCubed(double beta_low, double beta_high, double change_hz)
      : low_(in_rad(beta_low)), high_(in_rad(beta_high)), change_hz_(change_hz) {}

  double voltage(double sine, double frequency_hz) const override {
    const double phase = scale(frequency_hz) * arcmin_ghz(sine, frequency_hz);
    return phase < pi / 2 ? std::pow(std::cos(phase), 3) : 0;
  }
  double main_lobe_sine(double frequency_hz) const override {
    return sine_of_arcmin_ghz(pi / 2 / scale(frequency_hz), frequency_hz);
  }
  double detail_sine(double frequency_hz) const override { return main_lobe_sine(frequency_hz) / 2; }

 private:
  /// From degrees for each degree and MHz to radians for each arcmin and GHz.
  static double in_rad(double beta) { return beta * 1000 / 60 * pi / 180; }
  double scale(double frequency_hz) const { return frequency_hz < change_hz_ ? low_ : high_; }

  double low_;
  double high_;
  double change_hz_;
};

class Gaussian : public VoltagePattern {
 public:
  Gaussian(double widths, double diameter_m) : per_wavelength_(widths / diameter_m) {}

  double voltage(double sine, double frequency_hz) const override {
    const double theta = std::asin(std::min(1.0, sine)) / width_rad(frequency_hz);
    return theta < end_widths() ? std::exp2(-2 * theta * theta) : 0;
  }
  double main_lobe_sine(double frequency_hz) const override {
    return std::sin(std::min(pi / 2, end_widths() * width_rad(frequency_hz)));
  }
  double continuous_sine(double frequency_hz) const override { return main_lobe_sine(frequency_hz); }
  double detail_sine(double frequency_hz) const override { return std::min(1.0, width_rad(frequency_hz)); }

 private:
  double width_rad(double frequency_hz) const { return per_wavelength_ * speed_of_light_m_s / frequency_hz; }
  static double end_widths() { return std::sqrt(std::log2(1000.0)) / 2; }

  double per_wavelength_;  ///< 1/m
};

}  // namespace

Pattern cosine_tapered_pattern(double width_arcmin_ghz) {
  return std::make_shared<CosineTapered>(width_arcmin_ghz);
}

Pattern cosine_cubed_pattern(double beta_low, double beta_high, double change_hz) {
  return std::make_shared<CosineCubed>(beta_low, beta_high, change_hz);
}

Pattern gaussian_pattern(double widths, double diameter_m) {
  return std::make_shared<Gaussian>(widths, diameter_m);
}

}  // namespace misfit::imager
