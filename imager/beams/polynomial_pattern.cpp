#include "imager/beams/polynomial_pattern.h"

#include <algorithm>
#include <cmath>

namespace misfit::imager {
namespace {

class PolynomialPattern : public VoltagePattern {
 public:
  explicit PolynomialPattern(const FittedBeams& beams) : beams_(beams) {
    for (const FittedBand& band : beams.bands) {
      std::vector<double>& ends = ends_.emplace_back();
      for (const BeamFit& fit : band.fits) ends.push_back(end_of(fit));
    }
  }

  double voltage(double sine, double frequency_hz) const override {
    const double x = arcmin_ghz(sine, frequency_hz);
    const Fits at = fits_at(frequency_hz);
    return (1 - at.part) * voltage_of(at.band, at.one, x) + at.part * voltage_of(at.band, at.other, x);
  }
  double main_lobe_sine(double frequency_hz) const override {
    const Fits at = fits_at(frequency_hz);
    return sine_of_arcmin_ghz(std::max(ends_[at.band][at.one], ends_[at.band][at.other]), frequency_hz);
  }
  double continuous_sine(double frequency_hz) const override {
    const Fits at = fits_at(frequency_hz);
    return sine_of_arcmin_ghz(std::min(ends_[at.band][at.one], ends_[at.band][at.other]), frequency_hz);
  }
  double detail_sine(double frequency_hz) const override { return main_lobe_sine(frequency_hz) / 2; }

  std::string doubt(double frequency_hz) const override {
    for (const FittedBand& band : beams_.bands)
      if (frequency_hz >= band.low_hz && frequency_hz <= band.high_hz) return "";
    return "the beam of " + beams_.telescope + " was not fitted at " + std::to_string(std::lround(frequency_hz / 1e6)) +
           " MHz: it is taken to scale with frequency from the nearest band that was";
  }

 private:
  /// Two fits of a band, and the weight of the second.
  struct Fits {
    std::size_t band, one, other;
    double part;
  };

  double power(const BeamFit& fit, double x) const {
    const double square = x * x;
    const double sum = 1 + square * (fit.c[0] + square * (fit.c[1] + square * (fit.c[2] + square * fit.c[3])));
    return beams_.reciprocal ? 1 / sum : sum;
  }

  double end_of(const BeamFit& fit) const {
    constexpr double step = 1.0 / 64;
    double x = step;
    while (x + step <= beams_.farthest && power(fit, x + step) > 0 && power(fit, x + step) < power(fit, x)) x += step;
    return x;
  }

  double voltage_of(std::size_t band, std::size_t fit, double x) const {
    return x <= ends_[band][fit] ? std::sqrt(power(beams_.bands[band].fits[fit], x)) : 0;
  }

  /// The factor by which a frequency lies outside a band; 1 within it.
  static double away(const FittedBand& band, double frequency_hz) {
    return std::max({1.0, band.low_hz / frequency_hz, frequency_hz / band.high_hz});
  }

  Fits fits_at(double frequency_hz) const {
    const auto& bands = beams_.bands;
    const auto nearer = [=](const FittedBand& a, const FittedBand& b) { return away(a, frequency_hz) < away(b, frequency_hz); };
    const auto band = std::min_element(bands.begin(), bands.end(), nearer);
    const std::vector<BeamFit>& fits = band->fits;
    const auto above = std::find_if(fits.begin(), fits.end(), [=](const BeamFit& f) { return f.frequency_hz > frequency_hz; });
    const auto at = static_cast<std::size_t>(band - bands.begin());
    if (above == fits.begin()) return {at, 0, 0, 0};
    const auto below = static_cast<std::size_t>(above - fits.begin()) - 1;
    if (above == fits.end()) return {at, below, below, 0};
    const double part = (frequency_hz - fits[below].frequency_hz) / (fits[below + 1].frequency_hz - fits[below].frequency_hz);
    if (beams_.between == BetweenFits::interpolated) return {at, below, below + 1, part};
    const std::size_t nearest = part < 0.5 ? below : below + 1;
    return {at, nearest, nearest, 0};
  }

  const FittedBeams& beams_;
  std::vector<std::vector<double>> ends_;  ///< [band][fit], x
};

}  // namespace

Pattern polynomial_pattern(const FittedBeams& beams) {
  return std::make_shared<PolynomialPattern>(beams);
}

}  // namespace misfit::imager
