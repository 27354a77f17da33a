#pragma once

#include <cmath>
#include <type_traits>

namespace misfit::imager {

/// The unit, a power of 2, in which a grid of `Real` holds its sums, so that they stay within the range of single precision
/// whatever the size of the data: a weight of 1e30 and a visibility of 1e9 Jy are 1e39, which no float holds. It is 1 unless
/// the data are extreme, and always in double precision. Sums in another unit have the same bits.
template <typename Real>
class SumUnit {
 public:
  /// Makes ready for terms whose magnitudes add up to `size`. Returns the factor that the sums so far are to be multiplied by.
  double make_room(double size) {
    total_ += size;
    if (!std::is_same_v<Real, float> || !(total_ > 0) || !std::isfinite(total_)) return 1;
    // Floats go from 2⁻¹²⁶ to 2¹²⁸. Kernel and FFT take some of that above; below it is the number of terms and faint taps.
    constexpr int most = 80, least = -60;
    const int before = exponent_, size_now = std::ilogb(total_);
    if (size_now - before <= most && size_now - before >= least) return 1;
    exponent_ = size_now;
    return std::ldexp(1.0, before - exponent_);
  }
  double unit() const { return std::ldexp(1.0, exponent_); }
  double per_unit() const { return std::ldexp(1.0, -exponent_); }

 private:
  double total_ = 0;
  int exponent_ = 0;
};

}  // namespace misfit::imager
