#include "imager/tiled_residual_loops.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "imager/tiled_residual_loops.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <limits>

HWY_BEFORE_NAMESPACE();
namespace misfit::imager::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::CappedTag<float, 16>;
constexpr int side = residual_tile_side;

/// The larger of peak and |value|; peak where value is NaN: given one, hn::Max takes the second argument on x86 and the number
/// on Arm.
template <typename V>
HWY_ATTR V larger(V peak, V value) {
  return hn::Max(hn::Abs(value), peak);
}

HWY_ATTR void subtract_part(float* tile, const PsfPatch& patch, std::ptrdiff_t psf_columns) {
  const float* psf = patch.psf;
  for (int r = patch.first_row; r < patch.end_row; ++r, psf += psf_columns)
    for (int c = patch.first_column; c < patch.end_column; ++c) {
      float& residual = tile[r * side + c];
      residual = __builtin_fmaf(-patch.factor, psf[c - patch.first_column], residual);
    }
}

HWY_ATTR void subtract_whole(float* tile, const PsfPatch& patch, std::ptrdiff_t psf_columns) {
  const Tag d;
  constexpr int lanes = static_cast<int>(hn::MaxLanes(d));
  const auto factor = hn::Set(d, patch.factor);
  const float* psf = patch.psf;
  for (int r = 0; r < side; ++r, tile += side, psf += psf_columns)
    for (int c = 0; c < side; c += lanes)
      hn::StoreU(hn::NegMulAdd(factor, hn::LoadU(d, psf + c), hn::LoadU(d, tile + c)), d, tile + c);
}

HWY_ATTR float subtract_and_peak_of_tile(float* tile, const PsfPatch* patches, std::size_t count, std::ptrdiff_t psf_columns) {
  for (const PsfPatch* patch = patches; patch < patches + count; ++patch) {
    const bool whole = patch->end_row - patch->first_row == side && patch->end_column - patch->first_column == side;
    (whole ? subtract_whole : subtract_part)(tile, *patch, psf_columns);
  }
  const Tag d;
  auto peak = hn::Set(d, -std::numeric_limits<float>::infinity());
  for (int i = 0; i < side * side; i += static_cast<int>(hn::Lanes(d))) peak = larger(peak, hn::LoadU(d, tile + i));
  return hn::GetLane(hn::MaxOfLanes(d, peak));
}

HWY_ATTR void subtract_at_places(const float* psf, float factor, const int* offset, std::size_t count, float* value) {
  for (std::size_t i = 0; i < count; ++i) value[i] = __builtin_fmaf(-factor, psf[offset[i]], value[i]);
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

}  // namespace misfit::imager::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace misfit::imager {

HWY_EXPORT(subtract_and_peak_of_tile);
HWY_EXPORT(subtract_at_places);
HWY_EXPORT(raise_bounds_of_row);

float subtract_and_peak(float* tile, const PsfPatch* patches, std::size_t count, std::ptrdiff_t psf_columns) {
  return HWY_DYNAMIC_DISPATCH(subtract_and_peak_of_tile)(tile, patches, count, psf_columns);
}

void subtract_at(const float* psf, float factor, const int* offset, std::size_t count, float* value) {
  HWY_DYNAMIC_DISPATCH(subtract_at_places)(psf, factor, offset, count, value);
}

float raise_bounds(float* bound, const float* reach, int count, float amount) {
  return HWY_DYNAMIC_DISPATCH(raise_bounds_of_row)(bound, reach, count, amount);
}

}  // namespace misfit::imager
#endif  // HWY_ONCE
