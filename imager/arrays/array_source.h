#pragma once

#include "imager/arrays/array_samples.h"

namespace misfit::imager {

/// Visibilities in arrays as blocks of single precision, whose weights are those of the array, 0 where its mask is 0.
template <typename Real>
class ArraySource : public VisibilitySource {
 public:
  /// The arguments must outlive it. Throws std::invalid_argument as check_values does; so do its blocks for weights that are
  /// negative, and values that count and are not finite.
  ArraySource(const ArrayCoordinates& at, const ArrayValues<Real>& values, const ArrayBlockOptions& options);

  std::unique_ptr<BlockStream> open() const override;
  std::uint64_t samples() const override { return at_.samples(); }

 private:
  class Stream;

  const ArrayCoordinates& at_;
  ArrayValues<Real> values_;
  ArrayBlockOptions options_;
};

}  // namespace misfit::imager
