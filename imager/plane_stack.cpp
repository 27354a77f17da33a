#include "imager/plane_stack.h"

#include <hwy/cache_control.h>

#include <algorithm>
#include <memory>

#include "imager/column_group.h"
#include "imager/fft.h"
#include "imager/parallel.h"
#include "imager/spares.h"
#include "imager/stack_loops.h"

namespace misfit::imager {
namespace {

std::size_t index(int row, int columns) {
  return static_cast<std::size_t>(row) * static_cast<std::size_t>(columns);
}

int groups_of(int columns) {
  return (columns + columns_at_once - 1) / columns_at_once;
}

/// Calls body(group, begin, end) for groups of columns, or of rows, in [0, count), shared among threads.
template <typename Body>
void in_groups(int count, int threads, const Body& body) {
  parallel_for(static_cast<std::size_t>(groups_of(count)), threads, [&](std::size_t i) {
    const int group = static_cast<int>(i), begin = group * columns_at_once;
    body(group, begin, std::min(begin + columns_at_once, count));
  });
}

/// Calls visit(r) for the rows of storage that stand for canonical row q.
template <typename Visit>
void for_rows(const StackShape& s, int q, const Visit& visit) {
  for (const int other : {q - s.nv, q, q + s.nv})
    if (other >= -s.margin() && other <= s.nv + s.margin()) visit(other + s.margin());
}

template <typename Real>
bool row_is_used(const PlaneStack<Real>& stack, int q) {
  bool used = false;
  for_rows(stack.shape, q, [&](int r) { used |= stack.row_used[static_cast<std::size_t>(r)] != 0; });
  return used;
}

/// Column r of storage stands for canonical column r − margin, modulo the grid.
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

/// line = canonical row q of a grid, margins folded in.
template <typename Real>
void gather_row(const PlaneStack<Real>& stack, int q, int plane, int grid, std::complex<Real>* line) {
  const StackShape& s = stack.shape;
  std::fill_n(line, s.nu, std::complex<Real>(0));
  for_rows(s, q, [&](int r) {
    if (stack.row_used[static_cast<std::size_t>(r)] == 0) return;
    for_chunks(
        s, [&](int chunk, int p) { add_cells(stack.chunk(r, chunk, plane, grid), s.tile, line + p); },
        [&](int chunk, int c, int p) { line[p] += stack.chunk(r, chunk, plane, grid)[c]; });
  });
}

/// Its transpose: row q of a grid, margins filled by periodicity.
template <typename Real>
void scatter_row(const std::complex<Real>* line, int q, int plane, PlaneStack<Real>& stack) {
  const StackShape& s = stack.shape;
  for_rows(s, q, [&](int r) {
    for_chunks(
        s, [&](int chunk, int p) { std::copy_n(line + p, s.tile, stack.chunk(r, chunk, plane, 0)); },
        [&](int chunk, int c, int p) { stack.chunk(r, chunk, plane, 0)[c] = line[p]; });
  });
}

/// Between the two transforms of an FFT a row of storage holds a row of the grid in the columns of the image. Calls
/// visit(values, begin, count) for its pieces; whole chunks.
template <typename Stack, typename Visit>
void for_kept_row(Stack& stack, int q, int plane, int grid, int width, const Visit& visit) {
  const StackShape& s = stack.shape;
  for (int begin = 0; begin < width; begin += s.tile)
    visit(stack.chunk(q + s.margin(), begin / s.tile, plane, grid), begin, std::min(s.tile, width - begin));
}

/// The pieces of kept rows that belong to one group of columns.
template <typename Stack>
auto* kept_group(Stack& stack, int group, int q, int plane, int grid) {
  const int first = group * columns_at_once, tile = stack.shape.tile;
  return stack.chunk(q + stack.shape.margin(), first / tile, plane, grid) + first % tile;
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

/// What a thread needs for transforms along u.
template <typename Real>
struct RowWork {
  typename Fft<Real>::ComplexBuffer line;
  std::vector<std::complex<Real>> image_row;

  RowWork(const Fft<Real>& fft, int width) : line(fft.complex_buffer()), image_row(static_cast<std::size_t>(width)) {}
};

template <typename Real>
void transform_rows(PlaneStack<Real>& stack, int width, int threads) {
  const StackShape& s = stack.shape;
  const Fft<Real> along_u(s.nu);
  Spares<RowWork<Real>> spares;
  in_groups(s.nv, threads, [&](int, int begin, int end) {
    auto work = spares.take([&] { return std::make_unique<RowWork<Real>>(along_u, width); });
    auto& [line, image_row] = *work;
    for (int q = begin; q < end; ++q) {
      if (!row_is_used(stack, q)) continue;
      for (int plane = 0; plane < stack.planes; ++plane)
        for (int grid = 0; grid < stack.grids; ++grid) {
          gather_row(stack, q, plane, grid, line.get());
          along_u.complex_to_complex(line.get(), Fft<Real>::Sign::backward);
          fft_to_image(line.get(), s.nu, width, image_row.data());
          for_kept_row(stack, q, plane, grid, width, [&](std::complex<Real>* values, int first, int count) {
            std::copy_n(image_row.begin() + first, count, values);
          });
        }
    }
    spares.give_back(std::move(work));
  });
}

/// What a thread needs for transforms along v.
template <typename Real>
struct ColumnWork {
  std::vector<typename Fft<Real>::ComplexBuffer> column;  ///< [column in group]
  ColumnGroup pixels;

  ColumnWork(const Fft<Real>& fft, const StackedFacet& facet) : pixels(facet) {
    for (int i = 0; i < columns_at_once; ++i) column.push_back(fft.complex_buffer());
  }
};

template <typename Real>
void transform_image_columns(const Image& image, const StackedFacet& stacked, int first_plane, int threads,
                             PlaneStack<Real>& stack) {
  const StackShape& s = stack.shape;
  const Fft<Real> along_v(s.nv);
  Spares<ColumnWork<Real>> spares;
  in_groups(stacked.facet.geometry.width, threads, [&](int group, int begin, int end) {
    auto work = spares.take([&] { return std::make_unique<ColumnWork<Real>>(along_v, stacked); });
    auto& [column, pixels] = *work;
    pixels.begin(stacked, begin, end);
    pixels.load(image, stacked.facet, first_plane);
    for (int plane = 0; plane < stack.planes; ++plane) {
      for (int c = begin; c < end; ++c) {
        std::complex<Real>* values = column[static_cast<std::size_t>(c - begin)].get();
        std::fill_n(values, s.nv, std::complex<Real>(0));
        pixels.store_and_turn(c, values, s.nv);
        along_v.complex_to_complex(values, Fft<Real>::Sign::forward);
      }
      for (int q = 0; q < s.nv; ++q) {
        std::complex<Real>* row = kept_group(stack, group, q, plane, 0);
        for (int c = 0; c < end - begin; ++c) row[c] = column[static_cast<std::size_t>(c)].get()[q];
      }
    }
    spares.give_back(std::move(work));
  });
}

}  // namespace

template <typename Real>
void PlaneStack<Real>::reserve(int plane_count) {
  planes = plane_count;
  cell_.reserve(shape.cells() * static_cast<std::size_t>(planes * grids));
  row_used.assign(static_cast<std::size_t>(shape.rows()), 0);
}

template <typename Real>
void PlaneStack<Real>::clear(int threads) {
  const std::size_t row_cells = index(shape.columns(), planes * grids);
  parallel_for(row_used.size(), threads, [&](std::size_t r) {
    if (row_used[r] != 0) std::fill_n(cell_.data() + r * row_cells, row_cells, std::complex<Real>(0));
  });
}

template <typename Real>
void add_stack_to_images(PlaneStack<Real>& stack, const StackedFacet& stacked, int first_plane, int threads,
                         const std::vector<Image*>& images) {
  const StackShape& s = stack.shape;
  const int width = stacked.facet.geometry.width;
  transform_rows(stack, width, threads);
  std::vector<char> used;
  for (int q = 0; q < s.nv; ++q) used.push_back(row_is_used(stack, q));
  const Fft<Real> along_v(s.nv);
  Spares<ColumnWork<Real>> spares;
  in_groups(width, threads, [&](int group, int begin, int end) {
    auto work = spares.take([&] { return std::make_unique<ColumnWork<Real>>(along_v, stacked); });
    auto& [column, pixels] = *work;
    pixels.begin(stacked, begin, end);
    for (int grid = 0; grid < stack.grids; ++grid) {
      pixels.clear();
      for (int plane = stack.planes - 1; plane >= 0; --plane) {
        for (int q = 0; q < s.nv; ++q) {
          constexpr int ahead = 16;  // rows that memory brings while others are copied
          if (q + ahead < s.nv) hwy::Prefetch(kept_group(stack, group, q + ahead, plane, grid));
          const std::complex<Real>* row = kept_group(stack, group, q, plane, grid);
          for (int c = 0; c < end - begin; ++c)
            column[static_cast<std::size_t>(c)].get()[q] = used[static_cast<std::size_t>(q)] != 0 ? row[c] : Real(0);
        }
        for (int c = begin; c < end; ++c) {
          std::complex<Real>* values = column[static_cast<std::size_t>(c - begin)].get();
          along_v.complex_to_complex(values, Fft<Real>::Sign::backward);
          pixels.turn_and_add(c, values, s.nv);
        }
      }
      pixels.store(stacked.facet, first_plane, *images[static_cast<std::size_t>(grid)]);
    }
    spares.give_back(std::move(work));
  });
}

template <typename Real>
void image_to_stack(const Image& image, const StackedFacet& stacked, int first_plane, int threads, PlaneStack<Real>& stack) {
  const StackShape& s = stack.shape;
  const int width = stacked.facet.geometry.width;
  transform_image_columns(image, stacked, first_plane, threads, stack);
  const Fft<Real> along_u(s.nu);
  Spares<RowWork<Real>> spares;
  in_groups(s.nv, threads, [&](int, int begin, int end) {
    auto work = spares.take([&] { return std::make_unique<RowWork<Real>>(along_u, width); });
    auto& [line, image_row] = *work;
    for (int q = begin; q < end; ++q)
      for (int plane = 0; plane < stack.planes; ++plane) {
        for_kept_row(stack, q, plane, 0, width, [&](const std::complex<Real>* values, int first, int count) {
          std::copy_n(values, count, image_row.begin() + first);
        });
        image_to_fft(image_row.data(), width, s.nu, line.get());
        along_u.complex_to_complex(line.get(), Fft<Real>::Sign::forward);
        scatter_row(line.get(), q, plane, stack);
      }
    spares.give_back(std::move(work));
  });
}

template class PlaneStack<float>;
template class PlaneStack<double>;
template void add_stack_to_images(PlaneStack<float>&, const StackedFacet&, int, int, const std::vector<Image*>&);
template void add_stack_to_images(PlaneStack<double>&, const StackedFacet&, int, int, const std::vector<Image*>&);
template void image_to_stack(const Image&, const StackedFacet&, int, int, PlaneStack<float>&);
template void image_to_stack(const Image&, const StackedFacet&, int, int, PlaneStack<double>&);

}  // namespace misfit::imager
