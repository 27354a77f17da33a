#include "tools/paper/plain_gridder.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "imager/numerics/constants.h"
#include "imager/numerics/fft.h"

namespace misfit::tools {
namespace {

using Complex = std::complex<double>;
using Fft = imager::Fft<double>;

/// The cells that a visibility at u cells touches, and its taps there.
struct Touched {
  int first = 0;
  Eigen::VectorXd taps;

  Touched(double u, const kernels::TapFunction& taps_at) {
    const auto width = static_cast<double>(taps_at(0).size());
    const double first_place = u - (width - 1) / 2;
    first = static_cast<int>(std::lround(first_place));
    taps = taps_at(first_place - first);
  }
};

class Grid {
 public:
  explicit Grid(int size) : size_(size), value_(static_cast<std::size_t>(size) * static_cast<std::size_t>(size)) {}

  Complex& at(int v, int u) { return value_[wrapped(v) * static_cast<std::size_t>(size_) + wrapped(u)]; }
  Complex* row(int v) { return &at(v, 0); }
  int size() const { return size_; }

 private:
  std::size_t wrapped(int cell) const { return static_cast<std::size_t>((cell % size_ + size_) % size_); }

  int size_;
  std::vector<Complex> value_;
};

/// Adds visibilities to the grid. l falls along a row: u is counted the other way.
void add_visibilities(const PlainGridder& gridder, const imager::VisibilityBlock& block, const std::vector<Complex>& visibility,
                      Grid& grid) {
  const double cells = gridder.geometry.cell_rad * grid.size();
  for (std::size_t i = 0; i < block.samples(); ++i) {
    const double* uvw_m = &block.uvw_m[i / block.channels() * 3];
    const double per_m = cells * block.frequency_hz[i % block.channels()] / imager::speed_of_light_m_s;
    const double u = -uvw_m[0] * per_m;
    const double v = uvw_m[1] * per_m;
    if (std::max(std::abs(u), std::abs(v)) > grid.size() / 2.0) continue;
    const Touched along_u(u, gridder.taps);
    const Touched along_v(v, gridder.taps);
    const Complex value = visibility[i] * double{block.weight[i]};
    for (int r = 0; r < along_v.taps.size(); ++r)
      for (int s = 0; s < along_u.taps.size(); ++s)
        grid.at(along_v.first + r, along_u.first + s) += value * along_v.taps[r] * along_u.taps[s];
  }
}

}  // namespace

imager::Image plain_image(const PlainGridder& gridder, const imager::VisibilityBlock& block,
                          const std::vector<Complex>& visibility) {
  const int size = gridder.fft_size;
  Grid grid(size);
  add_visibilities(gridder, block, visibility, grid);
  const Fft fft(size);
  const Fft::ComplexBuffer buffer = fft.complex_buffer();
  for (int v = 0; v < size; ++v) {
    std::copy_n(grid.row(v), size, buffer.get());
    fft.complex_to_complex(buffer.get(), Fft::Sign::forward);
    std::copy_n(buffer.get(), size, grid.row(v));
  }
  imager::Image image(gridder.geometry.width, gridder.geometry.height);
  for (int column = 0; column < image.width; ++column) {
    const int x = column - gridder.geometry.centre_column();
    for (int v = 0; v < size; ++v) buffer[static_cast<std::size_t>(v)] = grid.at(v, x);
    fft.complex_to_complex(buffer.get(), Fft::Sign::forward);
    for (int row = 0; row < image.height; ++row) {
      const int y = row - gridder.geometry.centre_row();
      const double h = gridder.correction[std::abs(x)] * gridder.correction[std::abs(y)];
      image.at(row, column) = h * buffer[static_cast<std::size_t>((y + size) % size)].real();
    }
  }
  return image;
}

}  // namespace misfit::tools
