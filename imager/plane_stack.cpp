#include "imager/plane_stack.h"

#include <algorithm>

#include "imager/fft.h"
#include "imager/parallel.h"
#include "imager/phasors.h"

namespace misfit::imager {
namespace {

constexpr int columns_at_once = 16;  // a cache line or two of each row while columns are brought to contiguous memory

std::size_t index(int row, int columns) {
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns);
}

/// Pixel i of `pixels` in the order of an FFT of length n.
int place(int i, int pixels, int n) {
  const int x = i - pixels / 2;
  return x < 0 ? x + n : x;
}

/// What lies between the two transforms: rows of the grid, columns of the image. [plane][grid][q][image column]
template <typename Real>
struct KeptRows {
  int grids;
  int rows;
  int width;
  std::vector<std::complex<Real>> value;

  KeptRows(int planes, int grid_count, int row_count, int image_width)
      : grids(grid_count), rows(row_count), width(image_width), value(index(planes * grid_count * row_count, image_width)) {}
  std::complex<Real>* row(int plane, int grid, int q) { return value.data() + index((plane * grids + grid) * rows + q, width); }
  const std::complex<Real>* row(int plane, int grid, int q) const { return const_cast<KeptRows*>(this)->row(plane, grid, q); }
};

/// Calls body(begin, end) for consecutive pieces of [0, count), shared among threads.
template <typename Body>
void in_pieces(int count, int threads, const Body& body) {
  const auto pieces = static_cast<std::size_t>((count + columns_at_once - 1) / columns_at_once);
  parallel_for(pieces, threads, [&](std::size_t piece) {
    const int begin = static_cast<int>(piece) * columns_at_once;
    body(begin, std::min(begin + columns_at_once, count));
  });
}

/// Calls visit(r) for the rows of storage that stand for canonical row q.
template <typename Visit>
void for_rows(const StackShape& s, int q, const Visit& visit) {
  for (const int other : {q - s.nv, q, q + s.nv})
    if (other >= -s.margin() && other <= s.nv + s.margin()) visit(other + s.margin());
}

/// Adds a stored row to the canonical one, folding the margins.
template <typename Real>
void fold_row(const StackShape& s, const Real* real, const Real* imaginary, std::complex<Real>* out) {
  const auto add = [&](int from, int to, int count) {
    for (int i = 0; i < count; ++i) out[to + i] += std::complex<Real>(real[from + i], imaginary[from + i]);
  };
  add(s.margin(), 0, s.nu);
  add(0, s.nu - s.margin(), s.margin());
  add(s.nu + s.margin(), 0, s.margin() + 1);
}

template <typename Real>
KeptRows<Real> transform_rows(const PlaneStack<Real>& stack, int width, int threads) {
  const StackShape& s = stack.shape;
  const int grids = stack.components / 2;
  KeptRows<Real> kept(stack.planes, grids, s.nv, width);
  const Fft<Real> along_u(s.nu);
  in_pieces(s.nv, threads, [&](int begin, int end) {
    const auto buffer = along_u.complex_buffer();
    for (int q = begin; q < end; ++q) {
      bool used = false;
      for_rows(s, q, [&](int r) { used |= stack.row_used[static_cast<std::size_t>(r)] != 0; });
      if (!used) continue;
      for (int plane = 0; plane < stack.planes; ++plane)
        for (int grid = 0; grid < grids; ++grid) {
          std::fill_n(buffer.get(), s.nu, std::complex<Real>(0));
          for_rows(s, q,
                   [&](int r) { fold_row(s, stack.row(plane, 2 * grid, r), stack.row(plane, 2 * grid + 1, r), buffer.get()); });
          along_u.complex_to_complex(buffer.get(), Fft<Real>::Sign::backward);
          const int left = width / 2;
          std::copy_n(buffer.get(), width - left, kept.row(plane, grid, q) + left);
          std::copy_n(buffer.get() + s.nu - left, left, kept.row(plane, grid, q));
        }
    }
  });
  return kept;
}

/// The phases of a column's pixels: exp(2πi w q) at the stack's lowest plane, and from each plane to the next.
struct ColumnPhases {
  std::vector<double> turns, cosine, sine, step_cosine, step_sine;

  explicit ColumnPhases(int height) {
    for (auto* values : {&turns, &cosine, &sine, &step_cosine, &step_sine}) values->resize(static_cast<std::size_t>(height));
  }
  void compute(const Facet& facet, const PlaneHeights& heights, int column) {
    const int height = facet.geometry.height;
    for (int r = 0; r < height; ++r) turns[static_cast<std::size_t>(r)] = heights.step * facet.curvature(column, r);
    phasors(turns.data(), height, step_cosine.data(), step_sine.data());
    for (double& t : turns) t *= heights.first;
    phasors(turns.data(), height, cosine.data(), sine.data());
  }
};

/// The transforms along v of the columns [begin, end) of one grid in every plane. [plane][column] of length nv
template <typename Real>
class ColumnBuffers {
 public:
  ColumnBuffers(const Fft<Real>& fft, int planes, int columns) : columns_(columns) {
    for (int i = 0; i < planes * columns; ++i) buffer_.push_back(fft.complex_buffer());
  }
  std::complex<Real>* at(int plane, int column) { return buffer_[static_cast<std::size_t>(plane * columns_ + column)].get(); }

 private:
  int columns_;
  std::vector<typename Fft<Real>::ComplexBuffer> buffer_;
};

}  // namespace

template <typename Real>
void add_stack_to_images(const PlaneStack<Real>& stack, const Facet& facet, const PlaneHeights& heights, int threads,
                         const std::vector<Image*>& images) {
  const StackShape& s = stack.shape;
  const int height = facet.geometry.height;
  const KeptRows<Real> kept = transform_rows(stack, facet.geometry.width, threads);
  const Fft<Real> along_v(s.nv);
  in_pieces(facet.geometry.width, threads, [&](int begin, int end) {
    ColumnBuffers<Real> columns(along_v, stack.planes, end - begin);
    ColumnPhases phase(height);
    std::vector<double> real(static_cast<std::size_t>(height)), imaginary(static_cast<std::size_t>(height));
    for (int grid = 0; grid < kept.grids; ++grid) {
      for (int plane = 0; plane < stack.planes; ++plane)
        for (int q = 0; q < s.nv; ++q)
          for (int c = begin; c < end; ++c) columns.at(plane, c - begin)[q] = kept.row(plane, grid, q)[c];
      for (int c = begin; c < end; ++c) {
        for (int plane = 0; plane < stack.planes; ++plane)
          along_v.complex_to_complex(columns.at(plane, c - begin), Fft<Real>::Sign::backward);
        phase.compute(facet, heights, c);
        for (int r = 0; r < height; ++r) {  // Horner's rule from the highest plane down
          const int y = place(r, height, s.nv);
          const auto i = static_cast<std::size_t>(r);
          double re = 0, im = 0;
          for (int plane = stack.planes - 1; plane >= 0; --plane) {
            const std::complex<Real> value = columns.at(plane, c - begin)[y];
            const double turned = re * phase.step_cosine[i] - im * phase.step_sine[i];
            im = re * phase.step_sine[i] + im * phase.step_cosine[i] + double{value.imag()};
            re = turned + double{value.real()};
          }
          const double sum = re * phase.cosine[i] - im * phase.sine[i];
          if (!std::isnan(sum)) images[static_cast<std::size_t>(grid)]->at(facet.first_row + r, facet.first_column + c) += sum;
        }
      }
    }
  });
}

template <typename Real>
void image_to_stack(const Image& image, const Facet& facet, const PlaneHeights& heights, int threads, PlaneStack<Real>& stack) {
  const StackShape& s = stack.shape;
  const int width = facet.geometry.width, height = facet.geometry.height;
  KeptRows<Real> kept(stack.planes, 1, s.nv, width);
  const Fft<Real> along_v(s.nv);
  in_pieces(width, threads, [&](int begin, int end) {
    ColumnBuffers<Real> columns(along_v, stack.planes, end - begin);
    ColumnPhases phase(height);
    for (int c = begin; c < end; ++c) {
      phase.compute(facet, heights, c);
      for (int plane = 0; plane < stack.planes; ++plane) std::fill_n(columns.at(plane, c - begin), s.nv, std::complex<Real>(0));
      for (int r = 0; r < height; ++r) {
        const auto i = static_cast<std::size_t>(r);
        if (std::isnan(phase.cosine[i])) continue;
        const double pixel = image.at(facet.first_row + r, facet.first_column + c);
        double re = pixel * phase.cosine[i], im = -pixel * phase.sine[i];
        const int y = place(r, height, s.nv);
        for (int plane = 0; plane < stack.planes; ++plane) {
          columns.at(plane, c - begin)[y] = {static_cast<Real>(re), static_cast<Real>(im)};
          const double turned = re * phase.step_cosine[i] + im * phase.step_sine[i];
          im = im * phase.step_cosine[i] - re * phase.step_sine[i];
          re = turned;
        }
      }
      for (int plane = 0; plane < stack.planes; ++plane)
        along_v.complex_to_complex(columns.at(plane, c - begin), Fft<Real>::Sign::forward);
    }
    for (int plane = 0; plane < stack.planes; ++plane)
      for (int q = 0; q < s.nv; ++q)
        for (int c = begin; c < end; ++c) kept.row(plane, 0, q)[c] = columns.at(plane, c - begin)[q];
  });
  const Fft<Real> along_u(s.nu);
  in_pieces(s.nv, threads, [&](int begin, int end) {
    const auto buffer = along_u.complex_buffer();
    for (int q = begin; q < end; ++q)
      for (int plane = 0; plane < stack.planes; ++plane) {
        std::fill_n(buffer.get(), s.nu, std::complex<Real>(0));
        const int left = width / 2;
        std::copy_n(kept.row(plane, 0, q) + left, width - left, buffer.get());
        std::copy_n(kept.row(plane, 0, q), left, buffer.get() + s.nu - left);
        along_u.complex_to_complex(buffer.get(), Fft<Real>::Sign::forward);
        for_rows(s, q, [&](int r) {
          for (int column = 0; column <= s.nu + 2 * s.margin(); ++column) {
            const std::complex<Real> value = buffer.get()[(column - s.margin() + s.nu) % s.nu];
            stack.row(plane, 0, r)[column] = value.real();
            stack.row(plane, 1, r)[column] = value.imag();
          }
        });
      }
  });
}

template void add_stack_to_images(const PlaneStack<float>&, const Facet&, const PlaneHeights&, int, const std::vector<Image*>&);
template void add_stack_to_images(const PlaneStack<double>&, const Facet&, const PlaneHeights&, int,
                                  const std::vector<Image*>&);
template void image_to_stack(const Image&, const Facet&, const PlaneHeights&, int, PlaneStack<float>&);
template void image_to_stack(const Image&, const Facet&, const PlaneHeights&, int, PlaneStack<double>&);

}  // namespace misfit::imager
