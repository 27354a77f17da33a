#include "imager/wide/stack_rows.h"

#include <hwy/cache_control.h>

#include <algorithm>

#include "imager/numerics/parallel.h"

namespace misfit::imager {
namespace {

/// The column of the grid that a column of storage stands for.
int canonical(const StackShape& s, int column) {
  const int p = (column - s.margin()) % s.nu;
  return p < 0 ? p + s.nu : p;
}

/// The chunks none of whose columns wraps, [begin, end), and the canonical columns that they stand for, [first, last).
struct WholeChunks {
  int begin, end;
  int first, last;

  explicit WholeChunks(const StackShape& s)
      : begin((s.margin() + s.tile - 1) / s.tile),
        end(std::max(begin, (s.nu + s.margin()) / s.tile)),
        first(begin == end ? 0 : begin * s.tile - s.margin()),
        last(first + (end - begin) * s.tile) {}
};

/// Calls visit(chunk, p) for the chunks that stand for canonical columns p … p + tile − 1, and then edge(chunk, column in
/// chunk, p) for the columns of the others.
template <typename Chunk, typename Column>
void for_chunks(const StackShape& s, const Chunk& visit, const Column& edge) {
  const WholeChunks whole(s);
  for (int chunk = whole.begin; chunk < whole.end; ++chunk) visit(chunk, chunk * s.tile - s.margin());
  for (int chunk = 0; chunk < s.chunks(); ++chunk)
    if (chunk < whole.begin || chunk >= whole.end)
      for (int c = 0; c < s.tile; ++c) edge(chunk, c, canonical(s, chunk * s.tile + c));
}

/// Prefetches a piece of a row, which lies apart from the one before, while others are copied.
template <typename Real>
void prefetch(const std::complex<Real>* piece, int count) {
  const char* const bytes = reinterpret_cast<const char*>(piece);
  for (std::size_t i = 0; i < static_cast<std::size_t>(count) * sizeof(std::complex<Real>); i += 64) hwy::Prefetch(bytes + i);
}

/// line = a row of storage, margins along u folded in.
template <typename Real>
void gather_stored(const PlaneStack<Real>& stack, int row, int plane, int grid, std::complex<Real>* line) {
  const StackShape& s = stack.shape;
  const WholeChunks whole(s);
  constexpr int ahead = 4;
  std::fill_n(line, whole.first, std::complex<Real>(0));
  std::fill(line + whole.last, line + s.nu, std::complex<Real>(0));
  for_chunks(
      s,
      [&](int chunk, int p) {
        const int later = std::min(chunk + ahead, whole.end - 1);
        if (stack.uses(row, later)) prefetch(stack.chunk(row, later, plane, grid), s.tile);
        if (stack.uses(row, chunk))
          std::copy_n(stack.chunk(row, chunk, plane, grid), s.tile, line + p);
        else
          std::fill_n(line + p, s.tile, std::complex<Real>(0));
      },
      [&](int chunk, int c, int p) {
        if (stack.uses(row, chunk)) line[p] += stack.chunk(row, chunk, plane, grid)[c];
      });
}

/// The transpose of gather_stored(): a row of storage, margins along u filled by periodicity.
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

/// line = row q of a grid, with the opposite plane's taps beyond v = 0 and v = nv/2.
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

/// The transpose of gather_row().
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

/// Calls visit(at, values, count) for row q of an image's columns, in pieces that lie together there and, from `at` on, in a
/// line of the FFT, at whose end pixels left of the middle lie.
template <typename Planes, typename Visit>
void for_pieces(Planes& image, int plane, int grid, int q, int length, const Visit& visit) {
  const int left = image.width / 2;
  for (int group = 0, first = 0; first < image.width; ++group, first += columns_at_once) {
    auto* const values = image.row(group, plane, grid, q);
    const int end = std::min(first + columns_at_once, image.width), wraps = std::clamp(left, first, end);
    if (first < wraps) visit(length - left + first, values, wraps - first);
    if (wraps < end) visit(wraps - left, values + (wraps - first), end - wraps);
  }
}

}  // namespace

/// The buffers of one thread.
template <typename Real>
struct StackRows<Real>::Work {
  typename Fft<Real>::ComplexBuffer line[2];  ///< of a plane and the opposite one
  typename Fft<Real>::ComplexBuffer spare;

  explicit Work(const Fft<Real>& fft) : line{fft.complex_buffer(), fft.complex_buffer()}, spare(fft.complex_buffer()) {}
};

template <typename Real>
StackRows<Real>::StackRows(PlaneStack<Real>& stack, ImagePlanes<Real>& image, int threads)
    : stack_(stack),
      image_(image),
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
    auto work = spares_.take([&] { return std::make_unique<Work>(along_u_); });
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
    if (!stack_.holds(q)) continue;
    image_.holds[i] = 1;
    rows.push_back(q);
  }
  for_each(rows, [&](int q, int first, int grid, Work& work) {
    const int planes[] = {first, stack_.opposite(first)};
    for (int i = 0; i < 2; ++i) gather_row(stack_, q, planes[i], grid, work.spare.get(), work.line[i].get());
    for (int i = 0; i < 2; ++i) {
      std::complex<Real>* const line = work.line[i].get();
      along_u_.complex_to_complex(line, Fft<Real>::Sign::backward);
      for_pieces(image_, planes[i], grid, q, stack_.shape.nu,
                 [&](int at, std::complex<Real>* values, int count) { std::copy_n(line + at, count, values); });
    }
  });
}

template <typename Real>
int StackRows<Real>::first_awaited() const {
  int first = stack_.shape.rows();
  for (std::size_t i = 0; i < done_.size(); ++i) {
    if (done_[i] != 0) continue;
    const int q = static_cast<int>(i);
    first = std::min(first, q + stack_.shape.margin());
    stack_.for_mirrored_rows(q, [&](int r) { first = std::min(first, r); });
  }
  return first;
}

template <typename Real>
void StackRows<Real>::to_grid(int needed) {
  std::vector<int> rows;
  for (std::size_t i = 0; i < done_.size(); ++i) {
    const int q = static_cast<int>(i), own = q + stack_.shape.margin();
    bool shown = own < needed;
    stack_.for_mirrored_rows(q, [&](int r) { shown |= r < needed; });
    if (done_[i] != 0 || !shown) continue;
    done_[i] = 1;
    rows.push_back(q);
    stack_.use_row(own);
    stack_.for_mirrored_rows(q, [&](int r) { stack_.use_row(r); });
  }
  for_each(rows, [&](int q, int first, int grid, Work& work) {
    const int planes[] = {first, stack_.opposite(first)};
    for (int i = 0; i < 2; ++i) {
      std::complex<Real>* const line = work.line[i].get();
      const int left = image_.width / 2;
      std::fill(line + image_.width - left, line + stack_.shape.nu - left, std::complex<Real>(0));
      for_pieces(image_, planes[i], grid, q, stack_.shape.nu,
                 [&](int at, const std::complex<Real>* values, int count) { std::copy_n(values, count, line + at); });
      along_u_.complex_to_complex(line, Fft<Real>::Sign::forward);
    }
    for (int i = 0; i < 2; ++i) scatter_row(work.line[i].get(), q, planes[i], work.spare.get(), stack_);
  });
}

template class StackRows<float>;
template class StackRows<double>;

}  // namespace misfit::imager
