#include "imager/clean/tiled_residual_loops.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "imager/clean/tiled_residual_loops.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <limits>

HWY_BEFORE_NAMESPACE();
namespace misfit::imager::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::CappedTag<float, 16>;
constexpr int side = residual_block_side;

/// Eight rows, or the half of them that vectors of four hold, stay in registers while all components are taken off.
HWY_ATTR void subtract_from_block(const TiledPsf& psf, PointComponents components, int row, int column, float* block) {
  static_assert(side == 8);
  const hn::CappedTag<float, side> d;
  const std::ptrdiff_t next = psf.columns();
  const int middle_row = row + psf.height() / 2, middle_column = column + psf.width() / 2;
  const auto rows = static_cast<unsigned>(psf.height() + side - 1), columns = static_cast<unsigned>(psf.width() + side - 1);
  for (int c = 0; c < side; c += static_cast<int>(hn::Lanes(d))) {
    float* const b = block + c;
    auto r0 = hn::LoadU(d, b), r1 = hn::LoadU(d, b + side), r2 = hn::LoadU(d, b + 2 * side), r3 = hn::LoadU(d, b + 3 * side);
    auto r4 = hn::LoadU(d, b + 4 * side), r5 = hn::LoadU(d, b + 5 * side), r6 = hn::LoadU(d, b + 6 * side),
         r7 = hn::LoadU(d, b + 7 * side);
    for (const PointComponent& component : components) {
      const int psf_row = middle_row - component.row, psf_column = middle_column - component.column;
      if (static_cast<unsigned>(psf_row + side - 1) >= rows || static_cast<unsigned>(psf_column + side - 1) >= columns)
        continue;  // the PSF does not reach that far
      const float* const p = psf.at(psf_row, psf_column) + c;
      const auto factor = hn::Set(d, component.factor);
      r0 = hn::NegMulAdd(factor, hn::LoadU(d, p), r0);
      r1 = hn::NegMulAdd(factor, hn::LoadU(d, p + next), r1);
      r2 = hn::NegMulAdd(factor, hn::LoadU(d, p + 2 * next), r2);
      r3 = hn::NegMulAdd(factor, hn::LoadU(d, p + 3 * next), r3);
      r4 = hn::NegMulAdd(factor, hn::LoadU(d, p + 4 * next), r4);
      r5 = hn::NegMulAdd(factor, hn::LoadU(d, p + 5 * next), r5);
      r6 = hn::NegMulAdd(factor, hn::LoadU(d, p + 6 * next), r6);
      r7 = hn::NegMulAdd(factor, hn::LoadU(d, p + 7 * next), r7);
    }
    hn::StoreU(r0, d, b), hn::StoreU(r1, d, b + side), hn::StoreU(r2, d, b + 2 * side), hn::StoreU(r3, d, b + 3 * side);
    hn::StoreU(r4, d, b + 4 * side), hn::StoreU(r5, d, b + 5 * side), hn::StoreU(r6, d, b + 6 * side),
        hn::StoreU(r7, d, b + 7 * side);
  }
}

/// hn::Max of a number and NaN is its second argument on x86 and the number on Arm.
HWY_ATTR float largest_magnitude_of_block(const float* block) {
  const Tag d;
  auto peak = hn::Set(d, -std::numeric_limits<float>::infinity());
  for (int i = 0; i < side * side; i += static_cast<int>(hn::Lanes(d))) peak = hn::Max(hn::Abs(hn::LoadU(d, block + i)), peak);
  return hn::GetLane(hn::MaxOfLanes(d, peak));
}

HWY_ATTR float raise_bounds_of_row(float* bound, const float* reach, int count, float amount) {
  constexpr float upwards = 1 + 2 * std::numeric_limits<float>::epsilon();
  const Tag d;
  const int lanes = static_cast<int>(hn::Lanes(d));
  const auto by = hn::Set(d, amount), up = hn::Set(d, upwards);
  auto highest = hn::Set(d, -std::numeric_limits<float>::infinity());
  int i = 0;
  for (; i + lanes <= count; i += lanes) {
    const auto raised = hn::Mul(hn::MulAdd(by, hn::LoadU(d, reach + i), hn::LoadU(d, bound + i)), up);
    hn::StoreU(raised, d, bound + i);
    highest = hn::Max(highest, raised);
  }
  float largest = hn::GetLane(hn::MaxOfLanes(d, highest));
  for (; i < count; ++i) {
    bound[i] = std::fma(amount, reach[i], bound[i]) * upwards;
    largest = std::max(largest, bound[i]);
  }
  return largest;
}

HWY_ATTR void raise_bounds_of_blocks(const Reach& reach, PointComponents components, int row, int column, float* bound) {
  static_assert(blocks_along_tile == 4);
  const hn::CappedTag<float, blocks_along_tile> d;
  const std::size_t next = reach.stride();
  for (std::size_t c = 0; c < blocks_along_tile; c += hn::Lanes(d)) {
    float* const b = bound + c;
    auto r0 = hn::LoadU(d, b), r1 = hn::LoadU(d, b + 4), r2 = hn::LoadU(d, b + 8), r3 = hn::LoadU(d, b + 12);
    for (const PointComponent& component : components) {
      const float* const from = reach(row / side - component.row / side, column / side - component.column / side) + c;
      const auto amount = hn::Set(d, std::abs(component.factor));
      r0 = hn::MulAdd(amount, hn::LoadU(d, from), r0);
      r1 = hn::MulAdd(amount, hn::LoadU(d, from + next), r1);
      r2 = hn::MulAdd(amount, hn::LoadU(d, from + 2 * next), r2);
      r3 = hn::MulAdd(amount, hn::LoadU(d, from + 3 * next), r3);
    }
    // Each sum rounds by half an epsilon.
    const auto up = hn::Set(d, 1 + static_cast<float>(components.size()) * std::numeric_limits<float>::epsilon());
    hn::StoreU(hn::Mul(r0, up), d, b), hn::StoreU(hn::Mul(r1, up), d, b + 4);
    hn::StoreU(hn::Mul(r2, up), d, b + 8), hn::StoreU(hn::Mul(r3, up), d, b + 12);
  }
}

}  // namespace misfit::imager::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace misfit::imager {

HWY_EXPORT(subtract_from_block);
HWY_EXPORT(largest_magnitude_of_block);
HWY_EXPORT(raise_bounds_of_row);
HWY_EXPORT(raise_bounds_of_blocks);

void subtract(const TiledPsf& psf, PointComponents components, int row, int column, float* block) {
  HWY_DYNAMIC_DISPATCH(subtract_from_block)(psf, components, row, column, block);
}

float largest_magnitude(const float* block) {
  return HWY_DYNAMIC_DISPATCH(largest_magnitude_of_block)(block);
}

float raise_bounds(float* bound, const float* reach, int count, float amount) {
  return HWY_DYNAMIC_DISPATCH(raise_bounds_of_row)(bound, reach, count, amount);
}

void raise_block_bounds(const Reach& reach, PointComponents components, int row, int column, float* bound) {
  HWY_DYNAMIC_DISPATCH(raise_bounds_of_blocks)(reach, components, row, column, bound);
}

}  // namespace misfit::imager
#endif  // HWY_ONCE
