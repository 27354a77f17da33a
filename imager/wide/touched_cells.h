#pragma once

#include <algorithm>
#include <limits>

#include "imager/wide/stack_loops.h"

namespace misfit::imager {

/// A range of places along one axis, [begin, end).
struct TouchedRange {
  int begin = std::numeric_limits<int>::max();
  int end = 0;

  /// Adds `taps` places from each of `first` on, as far as they lie in [0, limit).
  void add(const int* first, int count, int taps, int limit) {
    for (int i = 0; i < count; ++i) {
      begin = std::min(begin, std::max(first[i], 0));
      end = std::max(end, std::min(first[i] + taps, limit));
    }
  }
  int length() const { return std::max(0, end - begin); }
};

/// The cells of a StackBuffer that the taps of some samples reached.
template <typename Real>
class TouchedCells {
 public:
  TouchedCells(const StackTaps<Real>& taps, const StackBuffer<Real>& buffer, int planes)
      : width_(taps.u.width), width_w_(taps.w.width), columns_(buffer.columns), rows_(buffer.rows), planes_(planes) {}

  void add(const StackBatch<Real>& batch) {
    samples_ += batch.count;
    column.add(batch.column, batch.count, width_, columns_);
    row.add(batch.row, batch.count, width_, rows_);
    plane.add(batch.plane, batch.count, width_w_, planes_);
  }
  int samples() const { return samples_; }
  /// The mean number of samples that a cell has taken.
  double samples_a_cell() const {
    const double cells = static_cast<double>(column.length()) * row.length() * plane.length();
    return static_cast<double>(samples_) * width_ * width_ * width_w_ / std::max(cells, 1.0);
  }
  void clear() {
    samples_ = 0;
    column = row = plane = {};
  }

  TouchedRange column, row, plane;

 private:
  int width_, width_w_, columns_, rows_, planes_;
  int samples_ = 0;
};

}  // namespace misfit::imager
