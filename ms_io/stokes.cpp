#include "ms_io/stokes.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <stdexcept>

namespace misfit::ms_io {
namespace {

constexpr int code_i = 1, code_rr = 5, code_ll = 8, code_xx = 9, code_yy = 12;

constexpr std::array<const char*, 13> names = {"undefined", "I", "Q", "U", "V", "RR", "RL", "LR", "LL", "XX", "XY", "YX", "YY"};

/// 0 when x is finite, NaN otherwise.
inline float finite_probe(float x) {
  return x - x;
}
inline float finite_probe(std::complex<float> x) {
  return finite_probe(x.real()) + finite_probe(x.imag());
}

/// 1/(1/a + 1/b) for a, b > 0, without overflow. Equal weights give exactly a/2.
inline float harmonic(float a, float b) {
  const float smaller = std::min(a, b);
  return smaller / (1 + smaller / std::max(a, b));
}

/// The strides are in floats and bools from channel to channel; known numbers let the compiler vectorise the loop.
template <std::size_t stride, std::size_t weight_stride>
void form(const StokesI& recipe, const StoredSamples& stored, const StokesSamples& formed, imager::SampleCounts& counts) {
  const std::complex<float>* const first = stored.data + recipe.first;
  const std::complex<float>* const second = stored.data + recipe.second;
  const bool* const first_flag = stored.flag + recipe.first;
  const bool* const second_flag = stored.flag + recipe.second;
  const float* const first_weight = stored.weight + recipe.first;
  const float* const second_weight = stored.weight + recipe.second;
  const float own_weight = recipe.first == recipe.second ? 2.0F : 1.0F;  // a stored I keeps its weight: 2 · w/2
  std::uint32_t flagged = 0, nonfinite = 0, zero_weight = 0;
  for (std::size_t c = 0; c < stored.channels; ++c) {
    const std::complex<float> a = first[c * stride], b = second[c * stride];
    const float wa = first_weight[c * weight_stride], wb = second_weight[c * weight_stride];
    const std::uint32_t is_flagged = first_flag[c * stride] | second_flag[c * stride];
    const float probe = finite_probe(a) + finite_probe(b) + finite_probe(wa) + finite_probe(wb);
    const std::uint32_t is_finite = static_cast<std::uint32_t>(probe == 0) & static_cast<std::uint32_t>(stored.uvw_is_finite);
    const float w = own_weight * harmonic(wa, wb);
    // w > 0 is part of it, since a weight below 1e-38 can vanish when it is combined.
    const std::uint32_t is_weighted =
        static_cast<std::uint32_t>(wa > 0) & static_cast<std::uint32_t>(wb > 0) & static_cast<std::uint32_t>(w > 0);
    flagged += is_flagged;
    nonfinite += (1U - is_flagged) & (1U - is_finite);
    zero_weight += (1U - is_flagged) & is_finite & (1U - is_weighted);
    const bool usable = ((1U - is_flagged) & is_finite & is_weighted) != 0;
    // Halves are summed, not the sum halved: this cannot overflow.
    const float re = 0.5F * a.real() + 0.5F * b.real(), im = 0.5F * a.imag() + 0.5F * b.imag();
    formed.visibility[c] = {usable ? re : 0.0F, usable ? im : 0.0F};
    formed.weight[c] = usable ? w : 0.0F;
  }
  counts.flagged += flagged;
  counts.nonfinite += nonfinite;
  counts.zero_weight += zero_weight;
  counts.used += stored.channels - flagged - nonfinite - zero_weight;
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
