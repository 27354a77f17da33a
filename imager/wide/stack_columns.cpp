#include "imager/wide/stack_columns.h"

#include <hwy/cache_control.h>

#include <algorithm>
#include <array>

#include "imager/numerics/fft.h"
#include "imager/numerics/parallel.h"
#include "imager/numerics/spares.h"

namespace misfit::imager {
namespace {

/// Calls body(group, begin, end) for groups of columns in [0, count), shared among threads.
template <typename Body>
void in_groups(int count, int threads, const Body& body) {
  const int groups = (count + columns_at_once - 1) / columns_at_once;
  parallel_for(static_cast<std::size_t>(groups), threads, [&](std::size_t i) {
    const int group = static_cast<int>(i), begin = group * columns_at_once;
    body(group, begin, std::min(begin + columns_at_once, count));
  });
}

/// The columns of a group, each [q].
template <typename Real>
using Columns = std::array<typename Fft<Real>::ComplexBuffer, columns_at_once>;

/// Where row q holds the columns of a group.
template <typename Stack>
auto* group_of_row(Stack& stack, int group, int q, int plane, int grid) {
  const int first = group * columns_at_once, tile = stack.shape.tile;
  return stack.chunk(q + stack.shape.margin(), first / tile, plane, grid) + first % tile;
}

/// Rows of a plane, [begin, end).
struct RowRange {
  int begin;
  int end;
};

/// Brings rows of a group of columns to contiguous memory, a few at a time, so that what is written lies together
/// too. Beyond nv/2 rows are the conjugates of the opposite plane's.
template <typename Real, bool beyond>
void gather_rows(const PlaneStack<Real>& stack, const std::vector<char>& used, int group, int plane, int grid, RowRange range,
                 const Columns<Real>& column) {
  constexpr int rows_at_once = 8, ahead = 2 * rows_at_once;  // memory brings rows while others are copied
  const std::array<std::complex<Real>, columns_at_once> zeros{};
  const auto source = [&](int q) {
    return beyond ? group_of_row(stack, group, stack.shape.nv - q, stack.opposite(plane), grid)
                  : group_of_row(stack, group, q, plane, grid);
  };
  for (int begin = range.begin; begin < range.end; begin += rows_at_once) {
    const int rows = std::min(rows_at_once, range.end - begin);
    const std::complex<Real>* row[rows_at_once];
    for (int i = 0; i < rows; ++i) {
      const int q = begin + i;
      row[i] = used[static_cast<std::size_t>(beyond ? stack.shape.nv - q : q)] != 0 ? source(q) : zeros.data();
      if (q + ahead < range.end) {
        const std::complex<Real>* later = source(q + ahead);
        hwy::Prefetch(later);
        hwy::Prefetch(later + columns_at_once / 2);
      }
    }
    for (int c = 0; c < columns_at_once; ++c) {
      std::complex<Real>* to = column[static_cast<std::size_t>(c)].get() + begin;
      for (int i = 0; i < rows; ++i) to[i] = beyond ? std::conj(row[i][c]) : row[i][c];
    }
  }
}

template <typename Real>
void gather_columns(const PlaneStack<Real>& stack, const std::vector<char>& used, int group, int plane, int grid,
                    const Columns<Real>& column) {
  const int half = stack.shape.nv / 2 + 1;
  gather_rows<Real, false>(stack, used, group, plane, grid, {0, half}, column);
  gather_rows<Real, true>(stack, used, group, plane, grid, {half, stack.shape.nv}, column);
}

/// Its transpose, to a plane and the opposite one.
template <typename Real>
void scatter_columns(const Columns<Real>& column, int group, int plane, PlaneStack<Real>& stack) {
  const int nv = stack.shape.nv;
  for (int q = 0; q <= nv / 2; ++q) {
    const int mirrored = q == 0 ? 0 : nv - q;
    std::complex<Real>* row = group_of_row(stack, group, q, plane, 0);
    std::complex<Real>* opposite = group_of_row(stack, group, q, stack.opposite(plane), 0);
    for (std::size_t c = 0; c < columns_at_once; ++c) {
      row[c] = column[c].get()[q];
      opposite[c] = std::conj(column[c].get()[mirrored]);
    }
  }
}

/// What a thread needs.
template <typename Real>
struct ColumnWork {
  Columns<Real> column;
  ColumnGroup pixels;

  ColumnWork(const Fft<Real>& fft, const StackedFacet& facet) : pixels(facet) {
    for (auto& one : column) one = fft.complex_buffer();
  }
};

}  // namespace

template <typename Real>
void stack_to_images(const PlaneStack<Real>& stack, const StackedFacet& stacked, int first_plane, int threads,
                     const std::vector<Image*>& images) {
  const StackShape& s = stack.shape;
  std::vector<char> used;
  for (int q = 0; q <= s.nv / 2; ++q) used.push_back(stack.holds(q));
  const Fft<Real> along_v(s.nv);
  Spares<ColumnWork<Real>> spares;
  in_groups(stacked.facet.geometry.width, threads, [&](int group, int begin, int end) {
    auto work = spares.take([&] { return std::make_unique<ColumnWork<Real>>(along_v, stacked); });
    auto& [column, pixels] = *work;
    pixels.begin(stacked, begin, end);
    for (int grid = 0; grid < stack.grids; ++grid) {
      pixels.clear();
      for (int plane = stack.planes - 1; plane >= stack.planes / 2; --plane) {
        gather_columns(stack, used, group, plane, grid, column);
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
  const Fft<Real> along_v(s.nv);
  Spares<ColumnWork<Real>> spares;
  in_groups(stacked.facet.geometry.width, threads, [&](int group, int begin, int end) {
    auto work = spares.take([&] { return std::make_unique<ColumnWork<Real>>(along_v, stacked); });
    auto& [column, pixels] = *work;
    pixels.begin(stacked, begin, end);
    pixels.load(image, stacked.facet, first_plane);
    for (int plane = stack.planes / 2; plane < stack.planes; ++plane) {
      for (int c = begin; c < end; ++c) {
        std::complex<Real>* values = column[static_cast<std::size_t>(c - begin)].get();
        std::fill_n(values, s.nv, std::complex<Real>(0));
        pixels.store_and_turn(c, values, s.nv);
        along_v.complex_to_complex(values, Fft<Real>::Sign::forward);
      }
      scatter_columns(column, group, plane, stack);
    }
    spares.give_back(std::move(work));
  });
}

template void stack_to_images(const PlaneStack<float>&, const StackedFacet&, int, int, const std::vector<Image*>&);
template void stack_to_images(const PlaneStack<double>&, const StackedFacet&, int, int, const std::vector<Image*>&);
template void image_to_stack(const Image&, const StackedFacet&, int, int, PlaneStack<float>&);
template void image_to_stack(const Image&, const StackedFacet&, int, int, PlaneStack<double>&);

}  // namespace misfit::imager
