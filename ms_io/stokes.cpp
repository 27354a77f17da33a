#include "ms_io/stokes.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>

#include "ms_io/stokes_response_internal.h"

namespace misfit::ms_io {
namespace {

using imager::Stokes;

constexpr int code(Stokes stokes) {
  return static_cast<int>(stokes);
}

/// A Stokes parameter as half the sum or difference of two correlations, or of i times it.
struct Pair {
  Stokes stokes, first, second;
  std::complex<float> of_first, of_second;
};

/// The pairs from the responses of correlations: V_1 = S + c T and V_2 = S − c T give S = (V_1 + V_2)/2 and
/// T = (V_1 − V_2)/(2c).
std::vector<Pair> solved_pairs() {
  const std::array<std::array<Stokes, 2>, 4> hands = {
      {{Stokes::XX, Stokes::YY}, {Stokes::XY, Stokes::YX}, {Stokes::RR, Stokes::LL}, {Stokes::RL, Stokes::LR}}};
  std::vector<Pair> pairs;
  for (const auto& [first, second] : hands) {
    const StokesResponse response = stokes_response(code(first));
    const std::complex<float> c(static_cast<float>(response.re), static_cast<float>(response.im));
    pairs.push_back({static_cast<Stokes>(response.first + 1), first, second, 0.5F, 0.5F});
    pairs.push_back(
        {static_cast<Stokes>(response.second + 1), first, second, 0.5F * std::conj(c), -0.5F * std::conj(c)});  // |c| = 1
  }
  return pairs;
}

const std::vector<Pair>& pairs() {
  static const std::vector<Pair> all = solved_pairs();
  return all;
}

std::string listed(const std::vector<int>& correlation_types) {
  std::string present;
  for (const int type : correlation_types) present += (present.empty() ? "" : ", ") + correlation_name(type);
  return present.empty() ? "(none)" : present;
}

std::string needed_for(Stokes stokes) {
  std::string needed;
  for (const Pair& pair : pairs())
    if (pair.stokes == stokes) needed += stokes_name(pair.first) + " and " + stokes_name(pair.second) + ", ";
  return needed.empty() ? stokes_name(stokes) : needed + "or " + stokes_name(stokes);
}

/// The factor of every correlation that is stored, 0 for those that are not used.
std::vector<std::complex<float>> factors(const std::vector<int>& types, Stokes wanted) {
  std::vector<std::complex<float>> factor(types.size());
  const auto index = [&](Stokes stokes) {
    return static_cast<std::size_t>(std::find(types.begin(), types.end(), code(stokes)) - types.begin());
  };
  if (const std::size_t own = index(wanted); own < types.size()) {
    factor[own] = 1;
    return factor;
  }
  for (const Pair& pair : pairs()) {
    const std::size_t first = index(pair.first), second = index(pair.second);
    if (pair.stokes != wanted || first == types.size() || second == types.size()) continue;
    factor[first] = pair.of_first;
    factor[second] = pair.of_second;
    return factor;
  }
  const bool is_correlation = code(wanted) >= code(Stokes::RR);
  throw std::runtime_error((is_correlation ? "correlation " + stokes_name(wanted) + " is not among "
                                           : "Stokes " + stokes_name(wanted) + " cannot be formed from correlations ") +
                           listed(types) + (is_correlation ? "" : "; it needs " + needed_for(wanted)));
}

/// The parallel hand that is stored, if there is just one, and Stokes I is not.
std::optional<Stokes> only_hand(const std::vector<int>& types) {
  const auto stored = [&](Stokes stokes) { return std::find(types.begin(), types.end(), code(stokes)) != types.end(); };
  if (stored(Stokes::I)) return {};
  for (const auto& [first, second] : {std::pair{Stokes::XX, Stokes::YY}, {Stokes::RR, Stokes::LL}}) {
    if (stored(first) && stored(second)) return {};
    if (stored(first)) return first;
    if (stored(second)) return second;
  }
  return {};
}

/// 0 when x is finite, NaN otherwise.
inline float probe(float x) {
  return x - x;
}

struct Unusable {
  std::uint32_t flagged = 0, nonfinite = 0, zero_weight = 0;

  void count(std::uint32_t flag, std::uint32_t finite, std::uint32_t weighted) {
    flagged += flag;
    nonfinite += (1U - flag) & (1U - finite);
    zero_weight += (1U - flag) & finite & (1U - weighted);
  }
  void add_to(imager::SampleCounts& counts, std::size_t channels) const {
    counts.flagged += flagged;
    counts.nonfinite += nonfinite;
    counts.zero_weight += zero_weight;
    counts.used += channels - flagged - nonfinite - zero_weight;
  }
};

/// Forms one Stokes parameter of two correlations with real factors, as for most images, in one loop. Strides known to the
/// compiler, no branch, no alias and no bool in memory: that lets GCC vectorise it (with -fno-trapping-math). Floats come in
/// pairs of real and imaginary part.
template <std::size_t stride, std::size_t weight_stride, bool first_and_last>
void form_pair(const StokesRecipe& recipe, const float* __restrict data, const unsigned char* __restrict flags,
               const float* __restrict weights, float uvw_probe, std::size_t channels, float* __restrict visibility,
               float* __restrict weight, imager::SampleCounts& counts) {
  const std::size_t a = first_and_last ? 0 : recipe.used[0], b = first_and_last ? stride - 1 : recipe.used[1];
  const float of_a = recipe.terms[0][0].real(), of_b = recipe.terms[0][1].real();
  Unusable unusable;
  for (std::size_t c = 0; c < channels; ++c) {
    const float a_re = data[2 * (c * stride + a)], a_im = data[2 * (c * stride + a) + 1];
    const float b_re = data[2 * (c * stride + b)], b_im = data[2 * (c * stride + b) + 1];
    const float a_weight = weights[c * weight_stride + a], b_weight = weights[c * weight_stride + b];
    // 1/(1/a + 1/b), arranged so that it cannot overflow and equal weights give exactly a/2.
    const float low = a_weight < b_weight ? a_weight : b_weight, high = a_weight < b_weight ? b_weight : a_weight;
    const float w = low / (1 + low / high);
    const float all = probe(a_re) + probe(a_im) + probe(b_re) + probe(b_im) + probe(a_weight) + probe(b_weight) + uvw_probe;
    const std::uint32_t flag = flags[c * stride + a] | flags[c * stride + b];
    const std::uint32_t finite = all == 0;
    // Two weights near 1e-38 may combine to 0.
    const std::uint32_t weighted = static_cast<std::uint32_t>(low > 0) & static_cast<std::uint32_t>(w > 0);
    const std::uint32_t usable = (1U - flag) & finite & weighted;
    unusable.count(flag, finite, weighted);
    // Halves are summed, not the sum halved: this cannot overflow.
    const float re = of_a * a_re + of_b * b_re, im = of_a * a_im + of_b * b_im;
    visibility[2 * c] = usable != 0 ? re : 0;
    visibility[2 * c + 1] = usable != 0 ? im : 0;
    weight[c] = usable != 0 ? w : 0;
  }
  unusable.add_to(counts, channels);
}

/// True if form_pair can form a recipe: all shares are 1, and all factors are real.
bool is_pair(const StokesRecipe& recipe) {
  return recipe.terms.size() == 1 && recipe.used.size() == 2 && recipe.share[0] == 1 && recipe.share[1] == 1 &&
         recipe.terms[0][0].imag() == 0 && recipe.terms[0][1].imag() == 0;
}

/// Stokes I of two correlations, or of one of them where the other cannot be used.
void form_either(const StokesRecipe& recipe, const StoredSamples& stored, const StokesSamples& formed,
                 imager::SampleCounts& counts) {
  struct Hand {
    std::complex<float> value;
    float weight;
    std::uint32_t flag, finite, weighted;

    bool usable() const { return (flag == 0U) && finite != 0 && weighted != 0; }
  };
  const float uvw_probe = stored.uvw_is_finite ? 0.0F : std::numeric_limits<float>::quiet_NaN();
  const auto hand = [&](std::size_t c, std::size_t k) {
    const std::size_t at = c * recipe.correlations + recipe.used[k];
    Hand one{stored.data[at], stored.weight[stored.weight_per_channel ? at : recipe.used[k]], stored.flag[at] ? 1U : 0U, 0, 0};
    one.finite = probe(one.value.real()) + probe(one.value.imag()) + probe(one.weight) + uvw_probe == 0 ? 1U : 0U;
    one.weighted = one.weight / 4 > 0 ? 1U : 0U;
    return one;
  };
  Unusable unusable;
  for (std::size_t c = 0; c < stored.channels; ++c) {
    const Hand a = hand(c, 0), b = hand(c, 1);
    std::complex<float>& visibility = formed.visibility[0][c];
    float& weight = formed.weight[c];
    if (a.usable() && b.usable()) {
      const float low = std::min(a.weight, b.weight), high = std::max(a.weight, b.weight);
      visibility = recipe.terms[0][0] * a.value + recipe.terms[0][1] * b.value;
      weight = low / (1 + low / high);
    } else if (a.usable() || b.usable()) {
      const Hand& alone = a.usable() ? a : b;
      visibility = alone.value;
      weight = alone.weight / 4;
    } else {
      visibility = 0;
      weight = 0;
      unusable.count(a.flag | b.flag, a.finite & b.finite, a.weighted & b.weighted);
    }
  }
  unusable.add_to(counts, stored.channels);
}

/// Channels of other recipes are formed so many at a time, in arrays that stay in the cache.
constexpr std::size_t at_once = 256;

/// The weights of some channels, from all correlations in use.
struct Joined {
  float low[at_once];    ///< the lowest weight
  float sum[at_once];    ///< Σ share · lowest / weight
  float probe[at_once];  ///< 0 where all is finite, NaN elsewhere
  std::uint32_t flag[at_once];
};

/// Loops over channels inside those over correlations, so that they vectorise whatever the recipe.
template <std::size_t stride, std::size_t weight_stride>
void join(const StokesRecipe& recipe, const float* data, const unsigned char* flags, const float* weights, float uvw_probe,
          std::size_t channels, Joined& joined) {
  for (std::size_t c = 0; c < channels; ++c) {
    joined.low[c] = std::numeric_limits<float>::infinity();
    joined.sum[c] = 0;
    joined.probe[c] = uvw_probe;
    joined.flag[c] = 0;
  }
  for (const std::size_t k : recipe.used)
    for (std::size_t c = 0; c < channels; ++c) {
      const float w = weights[c * weight_stride + k];
      joined.low[c] = w < joined.low[c] ? w : joined.low[c];
      joined.flag[c] |= flags[c * stride + k];
      joined.probe[c] += probe(data[2 * (c * stride + k)]) + probe(data[2 * (c * stride + k) + 1]) + probe(w);
    }
  // 1/(1/a + 1/b) as low/(low/a + low/b): it cannot overflow, and equal weights give exactly a/2.
  for (std::size_t i = 0; i < recipe.used.size(); ++i)
    for (std::size_t c = 0; c < channels; ++c)
      joined.sum[c] += recipe.share[i] * (joined.low[c] / weights[c * weight_stride + recipe.used[i]]);
}

/// Sets the weights of some channels, 0 for unusable ones.
void weigh(const Joined& joined, std::size_t channels, float* weight, imager::SampleCounts& counts) {
  Unusable unusable;
  for (std::size_t c = 0; c < channels; ++c) {
    const float w = joined.low[c] / joined.sum[c];
    const std::uint32_t flag = joined.flag[c], finite = joined.probe[c] == 0;
    const std::uint32_t weighted = static_cast<std::uint32_t>(joined.low[c] > 0) & static_cast<std::uint32_t>(w > 0);
    unusable.count(flag, finite, weighted);
    weight[c] = ((1U - flag) & finite & weighted) != 0 ? w : 0;
  }
  unusable.add_to(counts, channels);
}

/// Σ factor · V where the weight is not 0, a correlation at a time. Halves are summed, not the sum halved: this cannot
/// overflow.
template <std::size_t stride>
void combine(const StokesRecipe& recipe, const StokesTerms& terms, const float* __restrict data, const float* __restrict weight,
             std::size_t channels, float* __restrict visibility) {
  for (std::size_t c = 0; c < 2 * channels; ++c) visibility[c] = 0;
  for (std::size_t i = 0; i < terms.size(); ++i) {
    const float re = terms[i].real(), im = terms[i].imag();
    const float* const from = data + 2 * recipe.used[i];
    if (re != 0)
      for (std::size_t c = 0; c < channels; ++c) {
        visibility[2 * c] += weight[c] != 0 ? re * from[2 * c * stride] : 0;
        visibility[2 * c + 1] += weight[c] != 0 ? re * from[2 * c * stride + 1] : 0;
      }
    if (im != 0)
      for (std::size_t c = 0; c < channels; ++c) {
        visibility[2 * c] -= weight[c] != 0 ? im * from[2 * c * stride + 1] : 0;
        visibility[2 * c + 1] += weight[c] != 0 ? im * from[2 * c * stride] : 0;
      }
  }
}

template <std::size_t stride, std::size_t weight_stride>
void form(const StokesRecipe& recipe, const StoredSamples& stored, const StokesSamples& formed, imager::SampleCounts& counts) {
  const float uvw_probe = stored.uvw_is_finite ? 0.0F : std::numeric_limits<float>::quiet_NaN();
  if (is_pair(recipe)) {
    const bool first_and_last = recipe.used[0] == 0 && recipe.used[1] == stride - 1;  // the usual order of correlations
    const auto form = first_and_last ? form_pair<stride, weight_stride, true> : form_pair<stride, weight_stride, false>;
    return form(recipe, reinterpret_cast<const float*>(stored.data), reinterpret_cast<const unsigned char*>(stored.flag),
                stored.weight, uvw_probe, stored.channels, reinterpret_cast<float*>(formed.visibility[0]), formed.weight,
                counts);
  }
  Joined joined;
  for (std::size_t begin = 0; begin < stored.channels; begin += at_once) {
    const std::size_t channels = std::min(at_once, stored.channels - begin);
    const float* const data = reinterpret_cast<const float*>(stored.data + begin * stride);
    join<stride, weight_stride>(recipe, data, reinterpret_cast<const unsigned char*>(stored.flag + begin * stride),
                                stored.weight + begin * weight_stride, uvw_probe, channels, joined);
    weigh(joined, channels, formed.weight + begin, counts);
    for (std::size_t s = 0; s < recipe.terms.size(); ++s)
      combine<stride>(recipe, recipe.terms[s], data, formed.weight + begin, channels,
                      reinterpret_cast<float*>(formed.visibility[s] + begin));
  }
}

template <std::size_t stride>
void form(const StokesRecipe& recipe, const StoredSamples& stored, const StokesSamples& formed, imager::SampleCounts& counts) {
  stored.weight_per_channel ? form<stride, stride>(recipe, stored, formed, counts)
                            : form<stride, 0>(recipe, stored, formed, counts);
}

}  // namespace

std::string correlation_name(int correlation_type) {
  return imager::is_stokes_code(correlation_type) ? stokes_name(static_cast<Stokes>(correlation_type))
                                                  : "code " + std::to_string(correlation_type);
}

StokesRecipe stokes_recipe(const std::vector<int>& correlation_types, const std::vector<Stokes>& wanted, Hands hands) {
  if (hands == Hands::either) {
    if (const std::optional<Stokes> only = only_hand(correlation_types)) return stokes_recipe(correlation_types, {*only});
    StokesRecipe recipe = stokes_recipe(correlation_types, {Stokes::I});
    if (recipe.used.size() == 2) recipe.hands = Hands::either;
    return recipe;
  }
  StokesRecipe recipe;
  recipe.correlations = correlation_types.size();
  std::vector<std::vector<std::complex<float>>> all;  // [Stokes parameter][correlation]
  for (const Stokes stokes : wanted) all.push_back(factors(correlation_types, stokes));
  recipe.terms.resize(all.size());
  for (std::size_t k = 0; k < correlation_types.size(); ++k) {
    float square = 0;
    for (const auto& factor : all) square += std::norm(factor[k]);
    if (square == 0) continue;
    recipe.used.push_back(k);
    recipe.share.push_back(4 * square / static_cast<float>(all.size()));
    for (std::size_t s = 0; s < all.size(); ++s) recipe.terms[s].push_back(all[s][k]);
  }
  return recipe;
}

void form_stokes(const StokesRecipe& recipe, const StoredSamples& stored, const StokesSamples& formed,
                 imager::SampleCounts& counts) {
  if (recipe.hands == Hands::either) return form_either(recipe, stored, formed, counts);
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
