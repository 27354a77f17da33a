#include "ms_io/stokes.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <stdexcept>

namespace misfit::ms_io {
namespace {

constexpr int code_i = 1, code_rr = 5, code_ll = 8, code_xx = 9, code_yy = 12;

constexpr std::array<const char*, 13> names = {"undefined", "I", "Q", "U", "V", "RR", "RL", "LR", "LL", "XX", "XY", "YX", "YY"};

/// 0 when x is finite, NaN otherwise.
inline float probe(float x) {
  return x - x;
}

struct Unusable {
  std::uint32_t flagged = 0, nonfinite = 0, zero_weight = 0;
};

/// The strides lead from channel to channel; floats come in pairs of real and imaginary part. Numbers known to the compiler,
/// no branch, no alias and no bool in memory: that lets GCC vectorise the loop (with -fno-trapping-math).
template <std::size_t stride, std::size_t weight_stride, bool first_and_last>
Unusable form_channels(const StokesI& recipe, const float* __restrict data, const unsigned char* __restrict flags,
                       const float* __restrict weights, float uvw_probe, std::size_t channels, float* __restrict visibility,
                       float* __restrict weight) {
  const std::size_t a = first_and_last ? 0 : recipe.first, b = first_and_last ? stride - 1 : recipe.second;
  const float own_weight = a == b ? 2.0F : 1.0F;  // a stored I keeps its weight: 2 · w/2
  std::uint32_t flagged = 0, nonfinite = 0, zero_weight = 0;
  for (std::size_t c = 0; c < channels; ++c) {
    const float a_re = data[2 * (c * stride + a)], a_im = data[2 * (c * stride + a) + 1];
    const float b_re = data[2 * (c * stride + b)], b_im = data[2 * (c * stride + b) + 1];
    const float a_weight = weights[c * weight_stride + a], b_weight = weights[c * weight_stride + b];
    // 1/(1/a + 1/b), arranged so that it cannot overflow and equal weights give exactly a/2.
    const float low = a_weight < b_weight ? a_weight : b_weight, high = a_weight < b_weight ? b_weight : a_weight;
    const float w = own_weight * (low / (1 + low / high));
    const float all = probe(a_re) + probe(a_im) + probe(b_re) + probe(b_im) + probe(a_weight) + probe(b_weight) + uvw_probe;
    const std::uint32_t flag = flags[c * stride + a] | flags[c * stride + b];
    const std::uint32_t finite = all == 0;
    // Two weights near 1e-38 may combine to 0.
    const std::uint32_t weighted = static_cast<std::uint32_t>(low > 0) & static_cast<std::uint32_t>(w > 0);
    const std::uint32_t usable = (1U - flag) & finite & weighted;
    flagged += flag;
    nonfinite += (1U - flag) & (1U - finite);
    zero_weight += (1U - flag) & finite & (1U - weighted);
    // Halves are summed, not the sum halved: this cannot overflow.
    const float re = 0.5F * a_re + 0.5F * b_re, im = 0.5F * a_im + 0.5F * b_im;
    visibility[2 * c] = usable != 0 ? re : 0;
    visibility[2 * c + 1] = usable != 0 ? im : 0;
    weight[c] = usable != 0 ? w : 0;
  }
  return {flagged, nonfinite, zero_weight};
}

template <std::size_t stride, std::size_t weight_stride, bool first_and_last>
void form(const StokesI& recipe, const StoredSamples& stored, const StokesSamples& formed, imager::SampleCounts& counts) {
  const float uvw_probe = stored.uvw_is_finite ? 0.0F : std::numeric_limits<float>::quiet_NaN();
  const Unusable unusable = form_channels<stride, weight_stride, first_and_last>(
      recipe, reinterpret_cast<const float*>(stored.data), reinterpret_cast<const unsigned char*>(stored.flag), stored.weight,
      uvw_probe, stored.channels, reinterpret_cast<float*>(formed.visibility), formed.weight);
  counts.flagged += unusable.flagged;
  counts.nonfinite += unusable.nonfinite;
  counts.zero_weight += unusable.zero_weight;
  counts.used += stored.channels - unusable.flagged - unusable.nonfinite - unusable.zero_weight;
}

template <std::size_t stride, std::size_t weight_stride>
void form(const StokesI& recipe, const StoredSamples& stored, const StokesSamples& formed, imager::SampleCounts& counts) {
  const bool first_and_last = recipe.first == 0 && recipe.second == stride - 1;  // the usual order of correlations
  first_and_last ? form<stride, weight_stride, true>(recipe, stored, formed, counts)
                 : form<stride, weight_stride, false>(recipe, stored, formed, counts);
}

template <std::size_t stride>
void form(const StokesI& recipe, const StoredSamples& stored, const StokesSamples& formed, imager::SampleCounts& counts) {
  stored.weight_per_channel ? form<stride, stride>(recipe, stored, formed, counts)
                            : form<stride, 0>(recipe, stored, formed, counts);
}

}  // namespace

std::string correlation_name(int correlation_type) {
  const auto code = static_cast<std::size_t>(correlation_type);
  return code < names.size() ? names[code] : "code " + std::to_string(correlation_type);
}

bool receives_stokes_i(int correlation_type) {
  const std::array<int, 5> codes = {code_i, code_rr, code_ll, code_xx, code_yy};
  return std::find(codes.begin(), codes.end(), correlation_type) != codes.end();
}

StokesI stokes_i(const std::vector<int>& correlation_types) {
  const auto index = [&](int code) {
    return static_cast<std::size_t>(std::find(correlation_types.begin(), correlation_types.end(), code) -
                                    correlation_types.begin());
  };
  const std::size_t count = correlation_types.size();
  const std::array<std::array<int, 2>, 3> hands = {{{code_i, code_i}, {code_xx, code_yy}, {code_rr, code_ll}}};
  for (const auto& [first, second] : hands) {
    if (index(first) < count && index(second) < count) return {count, index(first), index(second)};
  }
  std::string present;
  for (const int type : correlation_types) present += (present.empty() ? "" : ", ") + correlation_name(type);
  throw std::runtime_error("Stokes I cannot be formed from correlations " + (present.empty() ? "(none)" : present) +
                           "; it needs XX and YY, RR and LL, or I");
}

void form_stokes_i(const StokesI& recipe, const StoredSamples& stored, const StokesSamples& formed,
                   imager::SampleCounts& counts) {
  switch (recipe.correlations) {
    case 1:
      return form<1>(recipe, stored, formed, counts);
    case 2:
      return form<2>(recipe, stored, formed, counts);
    case 3:
      return form<3>(recipe, stored, formed, counts);
    case 4:
      return form<4>(recipe, stored, formed, counts);
    default:
      throw std::runtime_error("polarisation setup with " + std::to_string(recipe.correlations) +
                               " correlations; expected 1 to 4");
  }
}

}  // namespace misfit::ms_io
