#include "imager/data/image_statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>
#include <vector>

#include "imager/numerics/parallel.h"

// Highway compiles what stands inside HWY_NAMESPACE once for every instruction set and chooses among them at run time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "imager/data/image_statistics.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace misfit::imager::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Doubles = hn::ScalableTag<double>;
using Vector = hn::Vec<Doubles>;

/// Sums over some of the pixels, in lanes.
struct Sums {
  Vector square, count, least, largest;

  HWY_ATTR HWY_INLINE Sums()
      : square(hn::Zero(Doubles())),
        count(hn::Zero(Doubles())),
        least(hn::Set(Doubles(), std::numeric_limits<double>::infinity())),
        largest(hn::Set(Doubles(), -std::numeric_limits<double>::infinity())) {}
  HWY_ATTR HWY_INLINE void add(Vector pixel) {
    const Doubles d;
    const auto is_number = hn::Eq(pixel, pixel);
    const Vector number = hn::IfThenElseZero(is_number, pixel);
    square = hn::MulAdd(number, number, square);
    count = hn::Add(count, hn::IfThenElseZero(is_number, hn::Set(d, 1.0)));
    least = hn::Min(least, hn::IfThenElse(is_number, pixel, least));
    largest = hn::Max(largest, hn::IfThenElse(is_number, pixel, largest));
  }
  HWY_ATTR HWY_INLINE void join(const Sums& other) {
    square = hn::Add(square, other.square);
    count = hn::Add(count, other.count);
    least = hn::Min(least, other.least);
    largest = hn::Max(largest, other.largest);
  }
  HWY_ATTR ImageStatistics all() const {
    const Doubles d;
    ImageStatistics of;
    of.count = static_cast<std::size_t>(hn::GetLane(hn::SumOfLanes(d, count)));
    if (of.count == 0) return of;
    of.square_sum = hn::GetLane(hn::SumOfLanes(d, square));
    of.least = hn::GetLane(hn::MinOfLanes(d, least));
    of.largest = hn::GetLane(hn::MaxOfLanes(d, largest));
    return of;
  }
};

/// The statistics of an array, which is divided first unless its type is constant; two vectors at a time, so that no addition
/// waits for the one before.
template <typename Pixel>
HWY_ATTR HWY_INLINE ImageStatistics look_at(Pixel* pixel, std::size_t count, double by) {
  const Doubles d;
  const std::size_t lanes = hn::Lanes(d);
  const Vector divisor = hn::Set(d, by);
  const auto take = [&](Pixel* at) HWY_ATTR {
    Vector value = hn::LoadU(d, at);
    if constexpr (!std::is_const_v<Pixel>) {
      value = hn::Div(value, divisor);
      hn::StoreU(value, d, at);
    }
    return value;
  };
  Sums even, odd;
  std::size_t i = 0;
  for (; i + 2 * lanes <= count; i += 2 * lanes) {
    even.add(take(pixel + i));
    odd.add(take(pixel + i + lanes));
  }
  for (std::remove_const_t<Pixel> rest[HWY_MAX_BYTES / sizeof(double)]; i < count; i += lanes) {
    const std::size_t some = std::min(lanes, count - i);
    std::fill_n(rest, lanes, std::numeric_limits<double>::quiet_NaN());
    std::copy_n(pixel + i, some, rest);
    even.add(take(rest));
    if constexpr (!std::is_const_v<Pixel>) std::copy_n(rest, some, pixel + i);
  }
  even.join(odd);
  return even.all();
}

HWY_ATTR ImageStatistics look_at_pixels(const double* pixel, std::size_t count) {
  return look_at(pixel, count, 1);
}
HWY_ATTR ImageStatistics divide_pixels(double* pixel, std::size_t count, double by) {
  return look_at(pixel, count, by);
}

}  // namespace misfit::imager::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace misfit::imager {

HWY_EXPORT(look_at_pixels);
HWY_EXPORT(divide_pixels);

double ImageStatistics::root_mean_square() const {
  return std::sqrt(square_sum / std::max(1.0, static_cast<double>(count)));
}

double ImageStatistics::largest_magnitude() const {
  return std::max(std::abs(least), std::abs(largest));
}

ImageStatistics statistics_of(const Image& image) {
  return HWY_DYNAMIC_DISPATCH(look_at_pixels)(image.pixel.data(), image.pixel.size());
}

ImageStatistics statistics_of(const Image& image, int threads) {
  constexpr std::size_t together = std::size_t{1} << 18;
  const std::size_t pixels = image.pixel.size();
  std::vector<ImageStatistics> part((pixels + together - 1) / together);
  parallel_for(part.size(), threads, [&](std::size_t i) {
    part[i] =
        HWY_DYNAMIC_DISPATCH(look_at_pixels)(image.pixel.data() + i * together, std::min(together, pixels - i * together));
  });
  ImageStatistics all;
  for (const ImageStatistics& some : part) {
    if (some.count == 0) continue;
    all.least = all.count == 0 ? some.least : std::min(all.least, some.least);
    all.largest = all.count == 0 ? some.largest : std::max(all.largest, some.largest);
    all.square_sum += some.square_sum;
    all.count += some.count;
  }
  return all;
}

ImageStatistics divide(Image& image, double by) {
  return HWY_DYNAMIC_DISPATCH(divide_pixels)(image.pixel.data(), image.pixel.size(), by);
}

double root_mean_square(const Image& image) {
  return statistics_of(image).root_mean_square();
}

double largest_magnitude(const Image& image) {
  return statistics_of(image).largest_magnitude();
}

Peak find_peak(const Image& image) {
  return find_peak(image, statistics_of(image));
}

Peak find_peak(const Image& image, const ImageStatistics& statistics) {
  const std::vector<double>& pixel = image.pixel;
  const double peak = statistics.largest_magnitude();
  const auto first = std::find_if(pixel.begin(), pixel.end(), [&](double x) { return std::abs(x) == peak; });
  const auto at = static_cast<int>(first == pixel.end() ? 0 : first - pixel.begin());
  return {at / image.width, at % image.width, pixel[static_cast<std::size_t>(at)]};
}

}  // namespace misfit::imager
#endif  // HWY_ONCE
