#include "imager/coplanar/half_grid.h"

#include <algorithm>

#include "imager/coplanar/image_columns.h"
#include "imager/coplanar/runs.h"
#include "imager/numerics/fft.h"

namespace misfit::imager {
namespace {

std::size_t first_of_row(const GridShape& s, int q) {
  return static_cast<std::size_t>(s.first_row(q)) * static_cast<std::size_t>(s.columns());
}

/// Cells of one stored row, margins included: [first, end).
struct CellRange {
  int first;
  int end;
};
CellRange stored_cells(const GridShape& s) {
  return {-s.nu / 2 - s.margin(), s.nu / 2 + s.margin() + 2};
}

template <typename Real>
bool any_in(const Real* row, int count) {
  int found = 0;  // without leaving early, so that vectors are compared
  for (int i = 0; i < count; ++i) found |= row[i] != 0 ? 1 : 0;
  return found != 0;
}

/// Adds stored row q to the canonical row `out` [nu], folding the margins; conjugated and reversed when q lies outside 0 …
/// nv/2. Returns whether there was anything to add.
template <typename Real>
bool fold_row(const GridShape& s, const Real* real, const Real* imaginary, int q, bool reflect, std::complex<Real>* out) {
  const CellRange cells = stored_cells(s);
  const std::size_t start = first_of_row(s, q) + static_cast<std::size_t>(s.first_column(cells.first));
  const int count = cells.end - cells.first;
  if (!any_in(real + start, count) && (imaginary == nullptr || !any_in(imaginary + start, count))) return false;
  const Real* const re = real + start - cells.first;
  const Real* const im = imaginary == nullptr ? nullptr : imaginary + start - cells.first;
  const auto add = [&](int first, int at, int run) {
    if (reflect && im != nullptr)
      for (int i = 0; i < run; ++i) out[at + i] += std::complex<Real>(re[-first - i], -im[-first - i]);
    else if (reflect)
      for (int i = 0; i < run; ++i) out[at + i] += re[-first - i];
    else if (im != nullptr)
      for (int i = 0; i < run; ++i) out[at + i] += std::complex<Real>(re[first + i], im[first + i]);
    else
      for (int i = 0; i < run; ++i) out[at + i] += re[first + i];
  };
  if (reflect)
    for_runs(1 - cells.end, 1 - cells.first, s.nu, add);
  else
    for_runs(cells.first, cells.end, s.nu, add);
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
      for_runs(columns.first, columns.first + columns.count, s.nu, [&](int first, int at, int count) {
        const std::complex<Real>* const from = buffer.get() + at;
        Real *const re = kept.real(q) + (first - columns.first), *const im = kept.imaginary(q) + (first - columns.first);
        for (int i = 0; i < count; ++i) re[i] = half * from[i].real();
        for (int i = 0; i < count; ++i) im[i] = half * from[i].imag();
      });
    }
  });
}

/// Stores canonical row `row` [nu] as row q, margins along u included; conjugated and reversed for rows in the margins along v.
template <typename Real>
void store_row(const std::complex<Real>* row, int q, bool reflect, HalfGrid<Real>& grid) {
  const GridShape& s = grid.shape;
  const CellRange cells = stored_cells(s);
  const auto start = static_cast<std::ptrdiff_t>(first_of_row(s, q)) + s.first_column(0);
  Real *const re = grid.real.data() + start, *const im = grid.imaginary.data() + start;
  if (reflect)
    for_runs(1 - cells.end, 1 - cells.first, s.nu, [&](int first, int at, int count) {
      for (int i = 0; i < count; ++i) re[-first - i] = row[at + i].real();
      for (int i = 0; i < count; ++i) im[-first - i] = -row[at + i].imag();
    });
  else
    for_runs(cells.first, cells.end, s.nu, [&](int first, int at, int count) {
      for (int i = 0; i < count; ++i) re[first + i] = row[at + i].real();
      for (int i = 0; i < count; ++i) im[first + i] = row[at + i].imag();
    });
}

}  // namespace

double transform_buffer_bytes(const GridShape& s, int threads, double real_bytes) {
  const double column = 3.0 * s.nv;  // a real column and its complex spectrum, each of nv
  return threads * real_bytes * std::max(run_at_once * column, 2.0 * s.nu);
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
      const int middle = image.width / 2;
      for_runs(-middle, image.width - middle, s.nu, [&](int first, int at, int count) {
        const Real *const re = kept.real(q) + first + middle, *const im = kept.imaginary(q) + first + middle;
        for (int i = 0; i < count; ++i) buffer.get()[at + i] = {re[i], im[i]};
      });
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
