#pragma once

#include <cstddef>
#include <vector>

namespace misfit::imager {

/// What is taken off a residual: factor × PSF centred on a pixel.
struct PointComponent {
  int row;
  int column;
  float factor;
};

/// Some that lie side by side.
struct PointComponents {
  const PointComponent* first = nullptr;
  std::size_t count = 0;

  const PointComponent* begin() const { return first; }
  const PointComponent* end() const { return first + count; }
  std::size_t size() const { return count; }
};

/// Components in the order in which they were found. CLEAN finds those of a bright pixel again and again; from here they are
/// had merged: pieces of the log hold every pixel once, and pieces of twice the length are merged from two, so that merging
/// costs a component no more than the logarithm of their number.
class ComponentLog {
 public:
  void add(const PointComponent& component);
  std::size_t size() const { return component_.size(); }

  /// All components from the `first` on, in few pieces. Each holds a pixel once, and its pixels tile by tile. Valid until the
  /// next is added.
  using Pieces = std::vector<PointComponents>;
  Pieces since(std::size_t first) const;

 private:
  std::vector<PointComponent> component_;
  std::vector<std::vector<std::vector<PointComponent>>> merged_;  ///< [level][piece] of shortest · 2^level components
};

}  // namespace misfit::imager
