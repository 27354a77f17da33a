#include "imager/half_grid.h"

#include <algorithm>

#include "imager/fft.h"
#include "imager/parallel.h"

namespace misfit::imager {
namespace {

constexpr int columns_at_once = 16;  // a cache line or two of each row while columns are brought to contiguous memory

int wrap(int i, int n) {
  return (i % n + n) % n;
}

std::size_t index(int row, int columns) {
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns);
}

/// Cells of one stored row, margins included.
struct CellRange {
  int first;
  int last;
};
CellRange stored_cells(const GridShape& s) {
  return {-s.nu / 2 - s.margin(), s.nu / 2 + s.margin() + 1};
}

/// Adds stored row q to the canonical row `out` [nu], folding the margins; conjugated and reversed when q lies outside 0 …
/// nv/2. Returns whether there was anything to add.
template <typename Real>
bool fold_row(const GridShape& s, const Real* real, const Real* imaginary, int q, bool reflect, std::complex<Real>* out) {
  const std::size_t start = index(s.first_row(q), s.columns());
  const CellRange cells = stored_cells(s);
  const auto any = [&](const Real* plane) {
    const Real* row = plane + start + s.first_column(cells.first);
    return plane != nullptr && std::any_of(row, row + (cells.last - cells.first + 1), [](Real x) { return x != 0; });
  };
  if (!any(real) && (imaginary == nullptr || !any(imaginary))) return false;
  int k = wrap(reflect ? -cells.first : cells.first, s.nu);
  for (int p = cells.first; p <= cells.last; ++p) {
    const std::size_t at = start + static_cast<std::size_t>(s.first_column(p));
    const Real im = imaginary == nullptr ? Real(0) : imaginary[at];
    out[k] += std::complex<Real>(real[at], reflect ? -im : im);
    k = reflect ? (k == 0 ? s.nu - 1 : k - 1) : (k == s.nu - 1 ? 0 : k + 1);
  }
  return true;
}

/// Canonical row q with everything that folds onto it. Returns false when it is all zero.
template <typename Real>
bool gather_row(const GridShape& s, const Real* real, const Real* imaginary, int q, std::complex<Real>* out) {
  std::fill_n(out, s.nu, std::complex<Real>(0));
  bool any = fold_row(s, real, imaginary, q, false, out);
  if (q > 0 && q <= s.margin()) any |= fold_row(s, real, imaginary, -q, true, out);
  const int from_top = s.nv / 2 - q;
  if (from_top > 0 && from_top <= s.margin() + 1) any |= fold_row(s, real, imaginary, s.nv / 2 + from_top, true, out);
  return any;
}

}  // namespace

template <typename Real>
Image grid_to_image(const GridShape& s, const Real* real, const Real* imaginary, const ImageCorrection& h, int threads) {
  using Complex = std::complex<Real>;
  const int width = static_cast<int>(h.column.size());
  const int height = static_cast<int>(h.row.size());
  const int half_rows = s.nv / 2 + 1;
  std::vector<Complex> kept(index(half_rows, width));  // [q][image column]

  const Fft<Real> along_u(s.nu);
  const std::size_t row_blocks = static_cast<std::size_t>((half_rows + columns_at_once - 1) / columns_at_once);
  parallel_for(row_blocks, threads, [&](std::size_t block) {
    const auto buffer = along_u.complex_buffer();
    const int begin = static_cast<int>(block) * columns_at_once;
    for (int q = begin; q < std::min(begin + columns_at_once, half_rows); ++q) {
      if (!gather_row(s, real, imaginary, q, buffer.get())) continue;
      along_u.complex_to_complex(buffer.get(), Fft<Real>::Sign::backward);
      const Real half = q == 0 || q == half_rows - 1 ? Real(1) : Real(0.5);  // complex_to_real doubles the others
      Complex* out = &kept[index(q, width)];
      for (int c = 0; c < width; ++c) out[c] = half * buffer[static_cast<std::size_t>(wrap(c - width / 2, s.nu))];
    }
  });

  Image image(width, height);
  const Fft<Real> along_v(s.nv);
  const std::size_t column_blocks = static_cast<std::size_t>((width + columns_at_once - 1) / columns_at_once);
  parallel_for(column_blocks, threads, [&](std::size_t block) {
    const int begin = static_cast<int>(block) * columns_at_once;
    const int count = std::min(columns_at_once, width - begin);
    std::vector<typename Fft<Real>::ComplexBuffer> spectrum;
    for (int c = 0; c < count; ++c) spectrum.push_back(along_v.complex_buffer());
    for (int q = 0; q < half_rows; ++q)
      for (int c = 0; c < count; ++c)
        spectrum[static_cast<std::size_t>(c)][static_cast<std::size_t>(q)] =
            kept[index(q, width) + static_cast<std::size_t>(begin + c)];
    std::vector<typename Fft<Real>::RealBuffer> column;
    for (int c = 0; c < count; ++c) {
      column.push_back(along_v.real_buffer());
      along_v.complex_to_real(spectrum[static_cast<std::size_t>(c)].get(), column.back().get());
    }
    for (int r = 0; r < height; ++r) {
      const auto y = static_cast<std::size_t>(wrap(r - height / 2, s.nv));
      double* out = image.row(r) + begin;
      for (int c = 0; c < count; ++c)
        out[c] = h.row[static_cast<std::size_t>(r)] * h.column[static_cast<std::size_t>(begin + c)] *
                 double{column[static_cast<std::size_t>(c)][y]};
    }
  });
  return image;
}

template <typename Real>
void image_to_grid(const Image& image, const ImageCorrection& h, int threads, HalfGrid<Real>& grid) {
  using Complex = std::complex<Real>;
  const GridShape& s = grid.shape;
  const int half_rows = s.nv / 2 + 1;
  std::vector<Complex> kept(index(half_rows, image.width));

  const Fft<Real> along_v(s.nv);
  const std::size_t column_blocks = static_cast<std::size_t>((image.width + columns_at_once - 1) / columns_at_once);
  parallel_for(column_blocks, threads, [&](std::size_t block) {
    const int begin = static_cast<int>(block) * columns_at_once;
    const int count = std::min(columns_at_once, image.width - begin);
    std::vector<typename Fft<Real>::RealBuffer> column;
    for (int c = 0; c < count; ++c) {
      column.push_back(along_v.real_buffer());
      std::fill_n(column.back().get(), s.nv, Real(0));
    }
    for (int r = 0; r < image.height; ++r) {
      const auto y = static_cast<std::size_t>(wrap(r - image.height / 2, s.nv));
      const double* in = image.row(r) + begin;
      for (int c = 0; c < count; ++c)
        column[static_cast<std::size_t>(c)][y] =
            static_cast<Real>(h.row[static_cast<std::size_t>(r)] * h.column[static_cast<std::size_t>(begin + c)] * in[c]);
    }
    const auto spectrum = along_v.complex_buffer();
    for (int c = 0; c < count; ++c) {
      along_v.real_to_complex(column[static_cast<std::size_t>(c)].get(), spectrum.get());
      for (int q = 0; q < half_rows; ++q)
        kept[index(q, image.width) + static_cast<std::size_t>(begin + c)] = spectrum[static_cast<std::size_t>(q)];
    }
  });

  const CellRange cells = stored_cells(s);
  const auto store = [&](const Complex* row, int q, bool reflect) {
    const std::size_t start = index(s.first_row(q), s.columns());
    for (int p = cells.first; p <= cells.last; ++p) {
      const Complex value = row[wrap(reflect ? -p : p, s.nu)];
      const std::size_t at = start + static_cast<std::size_t>(s.first_column(p));
      grid.real[at] = value.real();
      grid.imaginary[at] = reflect ? -value.imag() : value.imag();
    }
  };
  const Fft<Real> along_u(s.nu);
  const std::size_t row_blocks = static_cast<std::size_t>((half_rows + columns_at_once - 1) / columns_at_once);
  parallel_for(row_blocks, threads, [&](std::size_t block) {
    const auto buffer = along_u.complex_buffer();
    const int begin = static_cast<int>(block) * columns_at_once;
    for (int q = begin; q < std::min(begin + columns_at_once, half_rows); ++q) {
      std::fill_n(buffer.get(), s.nu, Complex(0));
      for (int c = 0; c < image.width; ++c)
        buffer[static_cast<std::size_t>(wrap(c - image.width / 2, s.nu))] =
            kept[index(q, image.width) + static_cast<std::size_t>(c)];
      along_u.complex_to_complex(buffer.get(), Fft<Real>::Sign::forward);
      store(buffer.get(), q, false);
      if (q > 0 && q <= s.margin()) store(buffer.get(), -q, true);
      const int from_top = s.nv / 2 - q;
      if (from_top > 0 && from_top <= s.margin() + 1) store(buffer.get(), s.nv / 2 + from_top, true);
    }
  });
}

template Image grid_to_image(const GridShape&, const float*, const float*, const ImageCorrection&, int);
template Image grid_to_image(const GridShape&, const double*, const double*, const ImageCorrection&, int);
template void image_to_grid(const Image&, const ImageCorrection&, int, HalfGrid<float>&);
template void image_to_grid(const Image&, const ImageCorrection&, int, HalfGrid<double>&);

}  // namespace misfit::imager
