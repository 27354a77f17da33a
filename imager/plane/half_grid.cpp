#include "imager/plane/half_grid.h"

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

/// The part of the uv plane that lies between the two transforms: rows of the grid, columns of the image. [q][column]
/// It is kept in the planes of the grid, each row where row q of the grid lay: nothing else is made from that.
template <typename Real>
struct KeptColumns {
  const GridShape& shape;
  Real* real_plane;
  Real* imaginary_plane;

  Real* real(int q) const { return real_plane + index(shape.first_row(q), shape.columns()); }
  Real* imaginary(int q) const { return imaginary_plane + index(shape.first_row(q), shape.columns()); }
  void set(int q, int c, std::complex<Real> value) const {
    real(q)[c] = value.real();
    imaginary(q)[c] = value.imag();
  }
  std::complex<Real> get(int q, int c) const { return {real(q)[c], imaginary(q)[c]}; }
};

/// Columns of an image, counted from the middle one.
struct ColumnRange {
  int first;
  int count;
};

/// Calls body(begin, end) for consecutive pieces of [0, count), shared among threads.
template <typename Body>
void in_pieces(int count, int threads, const Body& body) {
  const std::size_t pieces = static_cast<std::size_t>((count + columns_at_once - 1) / columns_at_once);
  parallel_for(pieces, threads, [&](std::size_t piece) {
    const int begin = static_cast<int>(piece) * columns_at_once;
    body(begin, std::min(begin + columns_at_once, count));
  });
}

/// The first step from grid to image: transforms along u the rows that hold anything.
template <typename Real>
void transform_rows(const GridShape& s, const Real* real, const Real* imaginary, ColumnRange columns, int threads,
                    const KeptColumns<Real>& kept) {
  const int half_rows = s.nv / 2 + 1;
  const Fft<Real> along_u(s.nu);
  in_pieces(half_rows, threads, [&](int begin, int end) {
    const auto buffer = along_u.complex_buffer();
    for (int q = begin; q < end; ++q) {
      if (!gather_row(s, real, imaginary, q, buffer.get())) continue;
      along_u.complex_to_complex(buffer.get(), Fft<Real>::Sign::backward);
      const Real half = q == 0 || q == half_rows - 1 ? Real(1) : Real(0.5);  // complex_to_real doubles the others
      for (int c = 0; c < columns.count; ++c) kept.set(q, c, half * buffer.get()[wrap(columns.first + c, s.nu)]);
    }
  });
}

/// The second: transforms along v the image's columns, some at a time so that memory is read in lines. An even image has its
/// other columns by symmetry.
template <typename Real>
Image transform_columns(const KeptColumns<Real>& kept, ColumnRange columns, bool even, const ImageCorrection& h, int threads) {
  const GridShape& s = kept.shape;
  Image image(static_cast<int>(h.column.size()), static_cast<int>(h.row.size()));
  const Fft<Real> along_v(s.nv);
  in_pieces(columns.count, threads, [&](int begin, int end) {
    std::vector<typename Fft<Real>::ComplexBuffer> spectrum;
    std::vector<typename Fft<Real>::RealBuffer> column;
    for (int c = begin; c < end; ++c) {
      spectrum.push_back(along_v.complex_buffer());
      column.push_back(along_v.real_buffer());
    }
    for (int q = 0; q <= s.nv / 2; ++q)
      for (int c = begin; c < end; ++c) spectrum[static_cast<std::size_t>(c - begin)].get()[q] = kept.get(q, c);
    for (std::size_t c = 0; c < column.size(); ++c) along_v.complex_to_real(spectrum[c].get(), column[c].get());
    for (int r = 0; r < image.height; ++r) {
      const double h_row = h.row[static_cast<std::size_t>(r)];
      const auto store = [&](int x, Real value) {
        const int c = x + image.width / 2;
        if (c >= 0 && c < image.width) image.at(r, c) = h_row * h.column[static_cast<std::size_t>(c)] * double{value};
      };
      const int y = r - image.height / 2;
      for (int c = begin; c < end; ++c) {
        const Real* const along = column[static_cast<std::size_t>(c - begin)].get();
        store(columns.first + c, along[wrap(y, s.nv)]);
        if (even) store(-(columns.first + c), along[wrap(-y, s.nv)]);
      }
    }
  });
  return image;
}

/// The first step from image to grid: transforms along v the image's columns.
template <typename Real>
void transform_image_columns(const Image& image, const ImageCorrection& h, int threads, const KeptColumns<Real>& kept) {
  const GridShape& s = kept.shape;
  const Fft<Real> along_v(s.nv);
  in_pieces(image.width, threads, [&](int begin, int end) {
    std::vector<typename Fft<Real>::RealBuffer> column;
    for (int c = begin; c < end; ++c) {
      column.push_back(along_v.real_buffer());
      std::fill_n(column.back().get(), s.nv, Real(0));
    }
    for (int r = 0; r < image.height; ++r) {
      const double h_row = h.row[static_cast<std::size_t>(r)];
      const int y = wrap(r - image.height / 2, s.nv);
      for (int c = begin; c < end; ++c)
        column[static_cast<std::size_t>(c - begin)].get()[y] =
            static_cast<Real>(h_row * h.column[static_cast<std::size_t>(c)] * image.at(r, c));
    }
    const auto spectrum = along_v.complex_buffer();
    for (int c = begin; c < end; ++c) {
      along_v.real_to_complex(column[static_cast<std::size_t>(c - begin)].get(), spectrum.get());
      for (int q = 0; q <= s.nv / 2; ++q) kept.set(q, c, spectrum.get()[q]);
    }
  });
}

/// Stores canonical row `row` [nu] as row q, margins along u included; conjugated and reversed for rows in the margins along v.
template <typename Real>
void store_row(const std::complex<Real>* row, int q, bool reflect, HalfGrid<Real>& grid) {
  const GridShape& s = grid.shape;
  const CellRange cells = stored_cells(s);
  const std::size_t start = index(s.first_row(q), s.columns());
  for (int p = cells.first; p <= cells.last; ++p) {
    const std::complex<Real> value = row[wrap(reflect ? -p : p, s.nu)];
    const std::size_t at = start + static_cast<std::size_t>(s.first_column(p));
    grid.real[at] = value.real();
    grid.imaginary[at] = reflect ? -value.imag() : value.imag();
  }
}

}  // namespace

double transform_buffer_bytes(const GridShape& s, int threads, double real_bytes) {
  const double column = 3.0 * s.nv;  // a real column and its complex spectrum, each of nv
  return threads * real_bytes * std::max(columns_at_once * column, 2.0 * s.nu);
}

template <typename Real>
Image grid_to_image(const GridShape& s, std::vector<Real> real, std::vector<Real> imaginary, const ImageCorrection& h,
                    int threads) {
  const int width = static_cast<int>(h.column.size());
  if (!imaginary.empty()) {
    const KeptColumns<Real> kept{s, real.data(), imaginary.data()};
    transform_rows(s, real.data(), imaginary.data(), {-(width / 2), width}, threads, kept);
    return transform_columns(kept, {-(width / 2), width}, false, h, threads);
  }
  // A real grid stands for one that is real and even. Half its columns, real and imaginary, take no more room than a row.
  const ColumnRange half{0, width / 2 + 1};
  const KeptColumns<Real> kept{s, real.data(), real.data() + half.count};
  transform_rows<Real>(s, real.data(), nullptr, half, threads, kept);
  return transform_columns(kept, half, true, h, threads);
}

template <typename Real>
void image_to_grid(const Image& image, const ImageCorrection& h, int threads, HalfGrid<Real>& grid) {
  const GridShape& s = grid.shape;
  const KeptColumns<Real> kept{s, grid.real.data(), grid.imaginary.data()};
  transform_image_columns(image, h, threads, kept);
  const Fft<Real> along_u(s.nu);
  in_pieces(s.nv / 2 + 1, threads, [&](int begin, int end) {
    const auto buffer = along_u.complex_buffer();
    for (int q = begin; q < end; ++q) {
      std::fill_n(buffer.get(), s.nu, std::complex<Real>(0));
      for (int c = 0; c < image.width; ++c) buffer.get()[wrap(c - image.width / 2, s.nu)] = kept.get(q, c);
      along_u.complex_to_complex(buffer.get(), Fft<Real>::Sign::forward);
      store_row(buffer.get(), q, false, grid);
      if (q > 0 && q <= s.margin()) store_row(buffer.get(), -q, true, grid);
      const int from_top = s.nv / 2 - q;
      if (from_top > 0 && from_top <= s.margin() + 1) store_row(buffer.get(), s.nv / 2 + from_top, true, grid);
    }
  });
}

template Image grid_to_image(const GridShape&, std::vector<float>, std::vector<float>, const ImageCorrection&, int);
template Image grid_to_image(const GridShape&, std::vector<double>, std::vector<double>, const ImageCorrection&, int);
template void image_to_grid(const Image&, const ImageCorrection&, int, HalfGrid<float>&);
template void image_to_grid(const Image&, const ImageCorrection&, int, HalfGrid<double>&);

}  // namespace misfit::imager
