#include "imager/wide/stack_rows.h"

#include <algorithm>

#include "imager/numerics/parallel.h"
#include "imager/wide/stack_loops.h"

namespace misfit::imager {
namespace {

/// The column of the grid that a column of storage stands for.
int canonical(const StackShape& s, int column) {
  const int p = (column - s.margin()) % s.nu;
  return p < 0 ? p + s.nu : p;
}

/// Calls visit(chunk, p) for the chunks that stand for canonical columns p … p + tile − 1, and edge(chunk, column in chunk, p)
/// for the columns of the others, which wrap.
template <typename Chunk, typename Column>
void for_chunks(const StackShape& s, const Chunk& visit, const Column& edge) {
  for (int chunk = 0; chunk < s.chunks(); ++chunk) {
    const int p = chunk * s.tile - s.margin();
    if (p >= 0 && p + s.tile <= s.nu) {
      visit(chunk, p);
    } else {
      for (int c = 0; c < s.tile; ++c) edge(chunk, c, canonical(s, chunk * s.tile + c));
    }
  }
}

/// line = a row of storage, margins along u folded in.
template <typename Real>
void gather_stored(const PlaneStack<Real>& stack, int row, int plane, int grid, std::complex<Real>* line) {
  const StackShape& s = stack.shape;
  std::fill_n(line, s.nu, std::complex<Real>(0));
  for_chunks(
      s,
      [&](int chunk, int p) {
        if (stack.uses(row, chunk)) add_cells(stack.chunk(row, chunk, plane, grid), s.tile, line + p);
      },
      [&](int chunk, int c, int p) {
        if (stack.uses(row, chunk)) line[p] += stack.chunk(row, chunk, plane, grid)[c];
      });
}

/// Its transpose: a row of storage, margins along u filled by periodicity.
template <typename Real>
void scatter_stored(const std::complex<Real>* line, int row, int plane, PlaneStack<Real>& stack) {
  const StackShape& s = stack.shape;
  for_chunks(
      s, [&](int chunk, int p) { std::copy_n(line + p, s.tile, stack.chunk(row, chunk, plane, 0)); },
      [&](int chunk, int c, int p) { stack.chunk(row, chunk, plane, 0)[c] = line[p]; });
}

/// The place of −p in a period of n.
int negated(int p, int n) {
  return p == 0 ? 0 : n - p;
}

/// line = row q of a grid; the opposite plane brings what its taps left beyond v = 0 and v = nv/2.
template <typename Real>
void gather_row(const PlaneStack<Real>& stack, int q, int plane, int grid, std::complex<Real>* spare,
                std::complex<Real>* line) {
  const int nu = stack.shape.nu;
  gather_stored(stack, q + stack.shape.margin(), plane, grid, line);
  stack.for_mirrored_rows(q, [&](int row) {
    gather_stored(stack, row, stack.opposite(plane), grid, spare);
    for (int p = 0; p < nu; ++p) line[p] += std::conj(spare[negated(p, nu)]);
  });
}

/// Its transpose.
template <typename Real>
void scatter_row(const std::complex<Real>* line, int q, int plane, std::complex<Real>* spare, PlaneStack<Real>& stack) {
  const int nu = stack.shape.nu, own = q + stack.shape.margin();
  scatter_stored(line, own, plane, stack);
  stack.for_mirrored_rows(q, [&](int row) {
    if (row == own) return;  // the opposite plane's row, which its own line fills
    for (int p = 0; p < nu; ++p) spare[p] = std::conj(line[negated(p, nu)]);
    scatter_stored(spare, row, stack.opposite(plane), stack);
  });
}

/// Calls visit(values, begin, count) for the pieces of a row of the grid between the two transforms of its FFT.
template <typename Stack, typename Visit>
void for_kept_row(Stack& stack, int q, int plane, int grid, int width, const Visit& visit) {
  const StackShape& s = stack.shape;
  for (int begin = 0; begin < width; begin += s.tile)
    visit(stack.chunk(q + s.margin(), begin / s.tile, plane, grid), begin, std::min(s.tile, width - begin));
}

/// Pixels of an image's row lie at the end of an FFT's, and then at its beginning.
template <typename Real>
void fft_to_image(const std::complex<Real>* in, int length, int width, std::complex<Real>* out) {
  const int left = width / 2;
  std::copy_n(in + length - left, left, out);
  std::copy_n(in, width - left, out + left);
}
template <typename Real>
void image_to_fft(const std::complex<Real>* in, int width, int length, std::complex<Real>* out) {
  const int left = width / 2;
  std::copy_n(in + left, width - left, out);
  std::fill(out + width - left, out + length - left, std::complex<Real>(0));
  std::copy_n(in, left, out + length - left);
}

}  // namespace

/// What a thread needs.
template <typename Real>
struct StackRows<Real>::Work {
  typename Fft<Real>::ComplexBuffer line[2];  ///< of a plane and the opposite one
  typename Fft<Real>::ComplexBuffer spare;
  std::vector<std::complex<Real>> image_row;

  Work(const Fft<Real>& fft, int width)
      : line{fft.complex_buffer(), fft.complex_buffer()},
        spare(fft.complex_buffer()),
        image_row(static_cast<std::size_t>(width)) {}
};

template <typename Real>
StackRows<Real>::StackRows(PlaneStack<Real>& stack, int width, int threads)
    : stack_(stack),
      width_(width),
      threads_(threads),
      along_u_(stack.shape.nu),
      done_(static_cast<std::size_t>(stack.shape.nv / 2 + 1)) {}

template <typename Real>
StackRows<Real>::~StackRows() = default;

template <typename Real>
template <typename Transform>
void StackRows<Real>::for_each(const std::vector<int>& rows, const Transform& transform) {
  constexpr std::size_t at_once = 4;
  parallel_for((rows.size() + at_once - 1) / at_once, threads_, [&](std::size_t piece) {
    auto work = spares_.take([&] { return std::make_unique<Work>(along_u_, width_); });
    for (std::size_t i = piece * at_once; i < std::min(rows.size(), (piece + 1) * at_once); ++i)
      for (int plane = 0; plane < stack_.planes / 2; ++plane)
        for (int grid = 0; grid < stack_.grids; ++grid) transform(rows[i], plane, grid, *work);
    spares_.give_back(std::move(work));
  });
}

template <typename Real>
void StackRows<Real>::to_image(int filled) {
  std::vector<int> rows;
  for (std::size_t i = 0; i < done_.size(); ++i) {
    const int q = static_cast<int>(i);
    bool complete = done_[i] == 0 && q + stack_.shape.margin() < filled;
    stack_.for_mirrored_rows(q, [&](int r) { complete &= r < filled; });
    if (!complete) continue;
    done_[i] = 1;
    if (stack_.holds(q)) rows.push_back(q);
  }
  for_each(rows, [&](int q, int first, int grid, Work& work) {
    const int planes[] = {first, stack_.opposite(first)};
    for (int i = 0; i < 2; ++i) gather_row(stack_, q, planes[i], grid, work.spare.get(), work.line[i].get());
    for (int i = 0; i < 2; ++i) {
      along_u_.complex_to_complex(work.line[i].get(), Fft<Real>::Sign::backward);
      fft_to_image(work.line[i].get(), stack_.shape.nu, width_, work.image_row.data());
      for_kept_row(stack_, q, planes[i], grid, width_, [&](std::complex<Real>* values, int begin, int count) {
        std::copy_n(work.image_row.begin() + begin, count, values);
      });
    }
  });
}

template <typename Real>
void StackRows<Real>::to_grid(int needed) {
  std::vector<int> rows;
  for (std::size_t i = 0; i < done_.size(); ++i) {
    const int q = static_cast<int>(i);
    bool shown = q + stack_.shape.margin() < needed;
    stack_.for_mirrored_rows(q, [&](int r) { shown |= r < needed; });
    if (done_[i] == 0 && shown) rows.push_back(q);
    done_[i] |= shown ? 1 : 0;
  }
  for_each(rows, [&](int q, int first, int grid, Work& work) {
    const int planes[] = {first, stack_.opposite(first)};
    for (int i = 0; i < 2; ++i) {
      for_kept_row(stack_, q, planes[i], grid, width_, [&](const std::complex<Real>* values, int begin, int count) {
        std::copy_n(values, count, work.image_row.begin() + begin);
      });
      image_to_fft(work.image_row.data(), width_, stack_.shape.nu, work.line[i].get());
      along_u_.complex_to_complex(work.line[i].get(), Fft<Real>::Sign::forward);
    }
    for (int i = 0; i < 2; ++i) scatter_row(work.line[i].get(), q, planes[i], work.spare.get(), stack_);
  });
}

template class StackRows<float>;
template class StackRows<double>;

}  // namespace misfit::imager
