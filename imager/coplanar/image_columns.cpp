#include "imager/coplanar/image_columns.h"

#include <algorithm>
#include <complex>
#include <vector>

#include "imager/coplanar/runs.h"
#include "imager/numerics/fft.h"

namespace misfit::imager {
namespace {

/// Buffers for some of an image's columns, and their transforms along v.
template <typename Real>
struct ColumnBuffers {
  std::vector<typename Fft<Real>::ComplexBuffer> spectrum;  ///< [column]
  std::vector<typename Fft<Real>::RealBuffer> pixels;       ///< [column]

  ColumnBuffers(const Fft<Real>& along_v, int columns) {
    for (int c = 0; c < columns; ++c) {
      spectrum.push_back(along_v.complex_buffer());
      pixels.push_back(along_v.real_buffer());
    }
  }
};

/// Calls visit(begin, end) for consecutive pieces of [0, rows).
template <typename Visit>
void for_rows(int rows, const Visit& visit) {
  for (int begin = 0; begin < rows; begin += run_at_once) visit(begin, std::min(begin + run_at_once, rows));
}

/// Brings kept columns from `first` on to their spectra.
template <typename Real>
void load_spectra(const KeptColumns<Real>& kept, int first, ColumnBuffers<Real>& buffers) {
  const std::size_t columns = buffers.spectrum.size(), stride = static_cast<std::size_t>(kept.shape.columns());
  for_rows(kept.shape.nv / 2 + 1, [&](int begin, int end) {
    for (std::size_t c = 0; c < columns; ++c) {
      std::complex<Real>* const to = buffers.spectrum[c].get();
      const Real *re = kept.real(begin) + first + c, *im = kept.imaginary(begin) + first + c;
      for (int q = begin; q < end; ++q, re += stride, im += stride) to[q] = {*re, *im};
    }
  });
}

/// Brings spectra back to kept columns from `first` on.
template <typename Real>
void store_spectra(const ColumnBuffers<Real>& buffers, int first, const KeptColumns<Real>& kept) {
  const std::size_t columns = buffers.spectrum.size();
  for_rows(kept.shape.nv / 2 + 1, [&](int begin, int end) {
    for (int q = begin; q < end; ++q) {
      Real *const re = kept.real(q) + first, *const im = kept.imaginary(q) + first;
      for (std::size_t c = 0; c < columns; ++c) {
        re[c] = buffers.spectrum[c].get()[q].real();
        im[c] = buffers.spectrum[c].get()[q].imag();
      }
    }
  });
}

/// Puts the values of a transform of length n in the order of `pixels` about its first value; upside down for y ↦ −y.
template <typename Real>
void order_pixels(const Real* transformed, int n, int pixels, bool upside_down, Real* out) {
  const int before = pixels / 2, after = pixels - before - 1;
  const Real *const head = transformed + 1, *const end = transformed + n;
  out[before] = transformed[0];
  if (upside_down) {
    std::reverse_copy(head, head + before, out);
    std::reverse_copy(end - after, end, out + before + 1);
  } else {
    std::copy(end - before, end, out);
    std::copy(head, head + after, out + before + 1);
  }
}

/// Sets the image's columns from `first` on to h times lines [column][row], leaving out those beyond its borders.
template <typename Real>
void store_columns(const std::vector<const Real*>& lines, int first, const ImageCorrection& h, Image& image) {
  const int begin = std::max(0, -first), end = std::min(static_cast<int>(lines.size()), image.width - first);
  for_rows(image.height, [&](int begin_row, int end_row) {
    for (int r = begin_row; r < end_row; ++r) {
      const double h_row = h.row[static_cast<std::size_t>(r)];
      const double* const h_column = h.column.data() + first;
      double* const out = image.row(r) + first;
      for (int c = begin; c < end; ++c) out[c] = h_row * h_column[c] * double{lines[static_cast<std::size_t>(c)][r]};
    }
  });
}

}  // namespace

template <typename Real>
Image transform_columns(const KeptColumns<Real>& kept, ColumnRange columns, bool even, const ImageCorrection& h, int threads) {
  const int nv = kept.shape.nv;
  Image image(static_cast<int>(h.column.size()), static_cast<int>(h.row.size()));
  const Fft<Real> along_v(nv);
  in_pieces(columns.count, threads, [&](int begin, int end) {
    ColumnBuffers<Real> buffers(along_v, end - begin);
    load_spectra(kept, begin, buffers);
    std::vector<const Real*> upright, mirrored;
    for (std::size_t c = 0; c < buffers.spectrum.size(); ++c) {
      Real* const transformed = buffers.pixels[c].get();
      along_v.complex_to_real(buffers.spectrum[c].get(), transformed);
      Real* const ordered = reinterpret_cast<Real*>(buffers.spectrum[c].get());  // which is done with, and has twice the room
      order_pixels(transformed, nv, image.height, false, ordered);
      upright.push_back(ordered);
      if (even) order_pixels(transformed, nv, image.height, true, ordered + nv);
      mirrored.insert(mirrored.begin(), ordered + nv);
    }
    store_columns(upright, image.width / 2 + columns.first + begin, h, image);
    if (even) store_columns(mirrored, image.width / 2 - columns.first - end + 1, h, image);
  });
  return image;
}

template <typename Real>
void transform_image_columns(const Image& image, const ImageCorrection& h, int threads, const KeptColumns<Real>& kept) {
  const int nv = kept.shape.nv;
  const Fft<Real> along_v(nv);
  in_pieces(image.width, threads, [&](int begin, int end) {
    ColumnBuffers<Real> buffers(along_v, end - begin);
    for (const auto& column : buffers.pixels) std::fill_n(column.get(), nv, Real(0));
    for_runs(-(image.height / 2), image.height - image.height / 2, nv, [&](int first, int at, int count) {
      const int row = first + image.height / 2;
      const double* const h_row = h.row.data() + row;
      for_rows(count, [&](int begin_row, int end_row) {
        for (int c = begin; c < end; ++c) {
          Real* const to = buffers.pixels[static_cast<std::size_t>(c - begin)].get() + at;
          const double h_column = h.column[static_cast<std::size_t>(c)];
          for (int r = begin_row; r < end_row; ++r) to[r] = static_cast<Real>(h_row[r] * h_column * image.at(row + r, c));
        }
      });
    });
    for (std::size_t c = 0; c < buffers.pixels.size(); ++c)
      along_v.real_to_complex(buffers.pixels[c].get(), buffers.spectrum[c].get());
    store_spectra(buffers, begin, kept);
  });
}

template Image transform_columns(const KeptColumns<float>&, ColumnRange, bool, const ImageCorrection&, int);
template Image transform_columns(const KeptColumns<double>&, ColumnRange, bool, const ImageCorrection&, int);
template void transform_image_columns(const Image&, const ImageCorrection&, int, const KeptColumns<float>&);
template void transform_image_columns(const Image&, const ImageCorrection&, int, const KeptColumns<double>&);

}  // namespace misfit::imager
