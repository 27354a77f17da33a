#include "imager/mosaic/band_limited_image.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <stdexcept>
#include <string>

#include "imager/numerics/big_array.h"
#include "imager/numerics/constants.h"
#include "imager/numerics/fft.h"
#include "imager/numerics/parallel.h"
#include "kernels/catalogue.h"

namespace misfit::imager {
namespace {

using Complex = std::complex<double>;

constexpr int taps = 8;
constexpr int finer = 2;                       // pixels of the fine plane for one of the image
constexpr double pass = 0.4, stop = 0.6;       // cycles a pixel
constexpr int gap = BandLimitedImage::margin;  // pixels on either side that keep the borders of the DFT's repeated images apart

/// The least-misfit function for the part of the fine plane's spectrum that the image's spectrum fills.
const kernels::Kernel& interpolator() {
  static const kernels::Kernel kernel = kernels::kernel_family("least-misfit").make(taps, stop / finer);
  return kernel;
}

/// The roll-off g at a frequency in cycles a pixel.
double passed(double frequency) {
  const double t = std::clamp((std::abs(frequency) - pass) / (stop - pass), 0.0, 1.0);
  return 0.5 * (1 + std::cos(pi * t));
}

/// The transforms along one axis, from pixels to twice as many.
struct Axis {
  explicit Axis(int pixels)
      : length(fast_fft_size(pixels + 2 * gap)), last(static_cast<int>(stop * length)), coarse(length), fine(finer * length) {
    const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(last + 1, 0, last) / (finer * length);
    const Eigen::VectorXd correction = kernels::optimal_correction(interpolator().polynomial, x);
    for (int k = 0; k <= last; ++k) transfer.push_back(correction[k] * passed(static_cast<double>(k) / length) / length);
  }

  int length;                    ///< of the image's DFT
  int last;                      ///< the highest frequency that passes
  std::vector<double> transfer;  ///< [0 … last], of ±k: roll-off times correction over the length
  Fft<double> coarse, fine;
};

/// Calls body(begin, end) for consecutive pieces of [0, count), shared among threads.
template <typename Body>
void in_pieces(int count, int together, int threads, const Body& body) {
  parallel_for(static_cast<std::size_t>((count + together - 1) / together), threads, [&](std::size_t piece) {
    const int begin = static_cast<int>(piece) * together;
    body(begin, std::min(begin + together, count));
  });
}

/// Transforms pixels along rows into the first rows of `plane`, [row][0 … u.last]; a real row's spectrum beyond ½ is that of
/// negative frequencies.
void transform_rows(const Image& pixels, const Axis& u, Complex* plane, int threads) {
  in_pieces(pixels.height, 16, threads, [&](int begin, int end) {
    const auto line = u.coarse.real_buffer();
    const auto spectrum = u.coarse.complex_buffer();
    for (int r = begin; r < end; ++r) {
      std::transform(pixels.row(r), pixels.row(r) + pixels.width, line.get(),
                     [](double value) { return std::isfinite(value) ? value : 0; });
      std::fill(line.get() + pixels.width, line.get() + u.length, 0.0);
      u.coarse.real_to_complex(line.get(), spectrum.get());
      Complex* row = plane + static_cast<std::ptrdiff_t>(r) * (u.last + 1);
      for (int k = 0; k <= u.last; ++k) {
        const auto at = static_cast<std::size_t>(k <= u.length / 2 ? k : u.length - k);
        row[k] = u.transfer[static_cast<std::size_t>(k)] * (k <= u.length / 2 ? spectrum[at] : std::conj(spectrum[at]));
      }
    }
  });
}

/// Interpolates the `rows` values of a column to finer · rows values.
void refine_column(const Axis& v, int rows, Complex* column, Complex* fine) {
  std::fill(column + rows, column + v.length, Complex(0));
  v.coarse.complex_to_complex(column, Fft<double>::Sign::forward);
  const int fine_length = finer * v.length;
  std::fill(fine, fine + fine_length, Complex(0));
  for (int k = -v.last; k <= v.last; ++k)
    fine[(k + fine_length) % fine_length] =
        v.transfer[static_cast<std::size_t>(std::abs(k))] * column[(k + v.length) % v.length];
  v.fine.complex_to_complex(fine, Fft<double>::Sign::backward);
}

/// All columns of the plane, in place, as many at a time as share a cache line.
void refine_columns(const Axis& v, int columns, int rows, Complex* plane, int threads) {
  in_pieces(columns, 4, threads, [&](int begin, int end) {
    const auto column = v.coarse.complex_buffer();
    std::vector<Fft<double>::ComplexBuffer> fine;
    for (int c = begin; c < end; ++c) {
      for (int r = 0; r < rows; ++r) column[static_cast<std::size_t>(r)] = plane[static_cast<std::ptrdiff_t>(r) * columns + c];
      refine_column(v, rows, column.get(), fine.emplace_back(v.fine.complex_buffer()).get());
    }
    for (int r = 0; r < finer * rows; ++r)
      for (int c = begin; c < end; ++c)
        plane[static_cast<std::ptrdiff_t>(r) * columns + c] =
            fine[static_cast<std::size_t>(c - begin)][static_cast<std::size_t>(r)];
  });
}

/// Widens marks by the margin along a line, whose elements are `step` apart.
void widen(const unsigned char* marks, int count, unsigned char* widened) {
  constexpr int reach = BandLimitedImage::margin;
  for (int last = -reach - 1, i = 0; i < count; ++i) {
    if (marks[i] != 0) last = i;
    widened[i] = i - last <= reach;
  }
  for (int next = count + reach + 1, i = count - 1; i >= 0; --i) {
    if (marks[i] != 0) next = i;
    if (next - i <= reach) widened[i] = 1;
  }
}

}  // namespace

BandLimitedImage::BandLimitedImage(const Image& pixels, const Image& shown, int threads)
    : width_(pixels.width), height_(pixels.height), taps_(interpolator().polynomial) {
  if (shown.width != width_ || shown.height != height_)
    throw std::invalid_argument("a mask of " + std::to_string(shown.width) + " × " + std::to_string(shown.height) +
                                " pixels; expected the image's " + std::to_string(width_) + " × " + std::to_string(height_));
  find_defined(pixels, shown, threads);
  refine(pixels, threads);
}

void BandLimitedImage::find_defined(const Image& pixels, const Image& shown, int threads) {
  const auto size = pixels.pixel.size(), width = static_cast<std::size_t>(width_);
  std::vector<unsigned char> unknown(size);  // [row][column], within the margin along rows
  defined_.assign(size, 0);
  parallel_for(static_cast<std::size_t>(height_), threads, [&](std::size_t r) {
    const double* row = pixels.row(static_cast<int>(r));
    std::vector<unsigned char> marks(width);
    std::transform(row, row + width_, marks.begin(), [](double value) { return !std::isfinite(value); });
    widen(marks.data(), width_, &unknown[r * width]);
  });
  parallel_for(static_cast<std::size_t>(std::max(0, height_ - 2 * margin)), threads, [&](std::size_t inner) {
    const int r = static_cast<int>(inner) + margin;
    for (int c = margin; c < width_ - margin; ++c) {
      unsigned char any = std::isfinite(shown.at(r, c)) ? 0 : 1;
      for (int near = r - margin; near <= r + margin && any == 0; ++near)
        any = unknown[static_cast<std::size_t>(near) * width + static_cast<std::size_t>(c)];
      defined_[static_cast<std::size_t>(r) * width + static_cast<std::size_t>(c)] = any == 0;
    }
  });
}

void BandLimitedImage::refine(const Image& pixels, int threads) {
  const Axis u(width_), v(height_);
  const int columns = u.last + 1, fine_rows = finer * height_;
  const auto fine_width = static_cast<std::size_t>(finer) * static_cast<std::size_t>(width_);
  BigArray<Complex> plane;
  plane.reserve(static_cast<std::size_t>(fine_rows) * static_cast<std::size_t>(columns));
  transform_rows(pixels, u, plane.data(), threads);
  refine_columns(v, columns, height_, plane.data(), threads);
  fine_.resize(static_cast<std::size_t>(fine_rows) * fine_width);
  in_pieces(fine_rows, 16, threads, [&](int begin, int end) {
    const auto spectrum = u.fine.complex_buffer();
    const auto line = u.fine.real_buffer();
    for (int r = begin; r < end; ++r) {
      std::copy_n(plane.data() + static_cast<std::ptrdiff_t>(r) * columns, columns, spectrum.get());
      std::fill(spectrum.get() + columns, spectrum.get() + u.length + 1, Complex(0));
      u.fine.complex_to_real(spectrum.get(), line.get());
      std::transform(line.get(), line.get() + fine_width, &fine_[static_cast<std::size_t>(r) * fine_width],
                     [](double value) { return static_cast<float>(value); });
    }
  });
}

double BandLimitedImage::at(const PixelPlace& place) const {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const double column = std::floor(place.column + 0.5), row = std::floor(place.row + 0.5);
  if (!(column >= 0 && column < width_ && row >= 0 && row < height_)) return none;
  if (defined_[static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(column)] == 0)
    return none;
  const auto taps_at = [&](double fine, double* out) {
    const double cell = std::floor(fine);
    taps_.taps(fine - cell - 0.5, out);
    return static_cast<std::size_t>(cell) - (taps / 2 - 1);
  };
  double along[taps], across[taps];
  const std::size_t first_column = taps_at(finer * place.column, along), first_row = taps_at(finer * place.row, across);
  const auto fine_width = static_cast<std::size_t>(finer) * static_cast<std::size_t>(width_);
  double sum = 0;
  for (std::size_t r = 0; r < taps; ++r) {
    const float* pixel = &fine_[(first_row + r) * fine_width + first_column];
    double of_row = 0;
    for (std::size_t c = 0; c < taps; ++c) of_row += along[c] * static_cast<double>(pixel[c]);
    sum += across[r] * of_row;
  }
  return sum;
}

Image regridded(const BandLimitedImage& image, const GridMap& map, const Image& where, int threads) {
  Image result(where.width, where.height);
  parallel_for(static_cast<std::size_t>(where.height), threads, [&](std::size_t row) {
    const int r = static_cast<int>(row);
    for (int c = 0; c < where.width; ++c) result.at(r, c) = std::isnan(where.at(r, c)) ? where.at(r, c) : image.at(map(r, c));
  });
  return result;
}

}  // namespace misfit::imager
