#pragma once

#include <algorithm>
#include <complex>
#include <optional>
#include <type_traits>

#include "imager/wide/touched_cells.h"
#include "imager/wide/wide_setup.h"

namespace misfit::imager {

/// Sums in single precision stay short: a buffer is added to the stack after so many samples.
inline constexpr int most_in_buffer = 1024;
/// Equal terms err to one side, each by up to 2⁻²⁵ of the sum: no more are summed in single precision where one cell takes them
/// all.
inline constexpr int most_in_single_cell = 32;

/// Adds up the samples of a tile: in a buffer that goes to the stack now and then, in place in the stack where they are few,
/// and in double precision where they crowd.
template <typename Real>
class TileSum {
 public:
  /// The arguments must outlive it. The buffer must be zero, and is zero again after finish().
  TileSum(const WideSetup<Real>& setup, const StackTask& task, const Slab& slab, bool in_place, StackBuffer<Real>& buffer,
          PlaneStack<Real>& stack)
      : setup_(setup),
        task_(task),
        plane_(slab.place(task.planes.first)),
        in_place_(in_place),
        buffer_(buffer),
        stack_(stack),
        touched_(setup.taps, buffer, task.planes.planes) {
    buffer_.reserve(task.planes.planes);
  }

  void add(const StackBatch<Real>& batch) {
    touched_.add(batch);
    if (is_dense()) in_place_ = false;
    spread(setup_.taps, batch, in_place_ ? in_stack() : buffer_.cells());
    if (!in_place_ && (touched_.samples() >= most_in_buffer || is_dense())) empty_buffer();
  }

  /// Samples that the next batch may bring.
  int most_in_batch() const { return exact_ ? most_in_single_cell : BatchPhases::capacity; }

  /// Brings the rest to the stack.
  void finish() {
    if (!in_place_ && touched_.samples() > 0) empty_buffer();
    if (exact_) add_to_stack(*exact_);
  }

 private:
  bool is_dense() const { return std::is_same_v<Real, float> && touched_.samples_a_cell() >= most_in_single_cell; }

  StackCells<std::complex<Real>> in_stack() const {
    return stack_.cells_of(task_.tile_u, task_.tile_v, plane_, task_.planes.planes);
  }

  void empty_buffer() {
    if (is_dense() && !exact_) {
      exact_.emplace(setup_.shape.tile, setup_.shape.width, buffer_.grids);
      exact_->reserve(task_.planes.planes);
    }
    if (exact_) {
      move_to(*exact_);
    } else {
      const int tile = setup_.shape.tile;
      for_each_chunk(setup_.shape, touched_.row, touched_.plane, stack_.grids,
                     [&](int row, int chunk, int plane, int grid, int count) {
                       move_cells(buffer_.row(plane, row, grid) + chunk * tile, count, in_stack(row, chunk, plane, grid));
                     });
    }
    touched_.clear();
  }

  void move_to(StackBuffer<double>& exact) {
    for (int plane = touched_.plane.begin; plane < touched_.plane.end; ++plane)
      for (int row = touched_.row.begin; row < touched_.row.end; ++row)
        for (int grid = 0; grid < buffer_.grids; ++grid) {
          std::complex<Real>* const from = buffer_.row(plane, row, grid);
          std::complex<double>* const sum = exact.row(plane, row, grid);
          for (int c = touched_.column.begin; c < touched_.column.end; ++c) {
            sum[c] += std::complex<double>(from[c]);
            from[c] = 0;
          }
        }
  }

  void add_to_stack(const StackBuffer<double>& exact) {
    const StackShape& s = setup_.shape;
    for_each_chunk(s, {0, s.reach()}, {0, task_.planes.planes}, stack_.grids,
                   [&](int row, int chunk, int plane, int grid, int count) {
                     const std::complex<double>* const from = exact.row(plane, row, grid) + chunk * s.tile;
                     std::complex<Real>* const to = in_stack(row, chunk, plane, grid);
                     for (int c = 0; c < count; ++c) to[c] = std::complex<Real>(std::complex<double>(to[c]) + from[c]);
                   });
  }
  std::complex<Real>* in_stack(int row, int chunk, int plane, int grid) {
    return stack_.chunk(task_.tile_v * setup_.shape.tile + row, task_.tile_u + chunk, plane_ + plane, grid);
  }

  const WideSetup<Real>& setup_;
  const StackTask& task_;
  int plane_;  ///< place in the stack of the first plane that the task touches
  bool in_place_;
  StackBuffer<Real>& buffer_;
  PlaneStack<Real>& stack_;
  TouchedCells<Real> touched_;                ///< since the buffer was emptied
  std::optional<StackBuffer<double>> exact_;  ///< the sum so far, where samples crowd
};

}  // namespace misfit::imager
