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

/// Calls visit(sample, taps along u, taps along v) for each sample that the grid holds. l falls along a row: u is counted the
/// other way.
template <typename Visit>
void for_samples(const PlainGridder& gridder, const imager::VisibilityBlock& block, Visit visit) {
  const double cells = gridder.geometry.cell_rad * gridder.fft_size;
  for (std::size_t i = 0; i < block.samples(); ++i) {
    const double* uvw_m = &block.uvw_m[i / block.channels() * 3];
    const double per_m = cells * block.frequency_hz[i % block.channels()] / imager::speed_of_light_m_s;
    const double u = -uvw_m[0] * per_m;
    const double v = uvw_m[1] * per_m;
    if (std::max(std::abs(u), std::abs(v)) <= gridder.fft_size / 2.0)
      visit(i, Touched(u, gridder.taps), Touched(v, gridder.taps));
  }
}

/// h at a pixel x and y from the centre.
double correction_at(const PlainGridder& gridder, int x, int y) {
  return gridder.correction[std::abs(x)] * gridder.correction[std::abs(y)];
}

void transform_rows(const Fft& fft, Fft::Sign sign, Grid& grid) {
  const Fft::ComplexBuffer buffer = fft.complex_buffer();
  for (int v = 0; v < grid.size(); ++v) {
    std::copy_n(grid.row(v), grid.size(), buffer.get());
    fft.complex_to_complex(buffer.get(), sign);
    std::copy_n(buffer.get(), grid.size(), grid.row(v));
  }
}

}  // namespace

imager::Image plain_image(const PlainGridder& gridder, const imager::VisibilityBlock& block,
                          const std::vector<Complex>& visibility) {
  const int size = gridder.fft_size;
  Grid grid(size);
  for_samples(gridder, block, [&](std::size_t i, const Touched& along_u, const Touched& along_v) {
    const Complex value = visibility[i] * double{block.weight[i]};
    for (int r = 0; r < along_v.taps.size(); ++r)
      for (int s = 0; s < along_u.taps.size(); ++s)
        grid.at(along_v.first + r, along_u.first + s) += value * along_v.taps[r] * along_u.taps[s];
  });
  const Fft fft(size);
  transform_rows(fft, Fft::Sign::forward, grid);
  const Fft::ComplexBuffer buffer = fft.complex_buffer();
  imager::Image image(gridder.geometry.width, gridder.geometry.height);
  for (int column = 0; column < image.width; ++column) {
    const int x = column - gridder.geometry.centre_column();
    for (int v = 0; v < size; ++v) buffer[static_cast<std::size_t>(v)] = grid.at(v, x);
    fft.complex_to_complex(buffer.get(), Fft::Sign::forward);
    for (int row = 0; row < image.height; ++row) {
      const int y = row - gridder.geometry.centre_row();
      image.at(row, column) = correction_at(gridder, x, y) * buffer[static_cast<std::size_t>((y + size) % size)].real();
    }
  }
  return image;
}

std::vector<Complex> plain_prediction(const PlainGridder& gridder, const imager::Image& model,
                                      const imager::VisibilityBlock& block) {
  const int size = gridder.fft_size;
  Grid grid(size);
  const Fft fft(size);
  const Fft::ComplexBuffer buffer = fft.complex_buffer();
  for (int column = 0; column < model.width; ++column) {
    const int x = column - gridder.geometry.centre_column();
    std::fill_n(buffer.get(), size, 0);
    for (int row = 0; row < model.height; ++row) {
      const int y = row - gridder.geometry.centre_row();
      buffer[static_cast<std::size_t>((y + size) % size)] = correction_at(gridder, x, y) * model.at(row, column);
    }
    fft.complex_to_complex(buffer.get(), Fft::Sign::backward);
    for (int v = 0; v < size; ++v) grid.at(v, x) = buffer[static_cast<std::size_t>(v)];
  }
  transform_rows(fft, Fft::Sign::backward, grid);
  std::vector<Complex> visibility(block.samples());
  for_samples(gridder, block, [&](std::size_t i, const Touched& along_u, const Touched& along_v) {
    for (int r = 0; r < along_v.taps.size(); ++r)
      for (int s = 0; s < along_u.taps.size(); ++s)
        visibility[i] += grid.at(along_v.first + r, along_u.first + s) * along_v.taps[r] * along_u.taps[s];
  });
  return visibility;
}

}  // namespace misfit::tools
