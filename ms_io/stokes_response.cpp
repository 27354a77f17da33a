#include <algorithm>
#include <array>

#include "ms_io/stokes_response_internal.h"

namespace misfit::ms_io {
namespace {

/// By casacore's code: undefined, I, Q, U, V, RR, RL, LR, LL, XX, XY, YX, YY.
constexpr std::array<StokesResponse, 13> responses = [] {
  constexpr int i = 0, q = 1, u = 2, v = 3;
  return std::array<StokesResponse, 13>{{{},
                                         {i},
                                         {q},
                                         {u},
                                         {v},
                                         {i, v, 1, 0},
                                         {q, u, 0, 1},
                                         {q, u, 0, -1},
                                         {i, v, -1, 0},
                                         {i, q, 1, 0},
                                         {u, v, 0, 1},
                                         {u, v, 0, -1},
                                         {i, q, -1, 0}}};
}();

using Plane = std::vector<std::complex<double>>;

/// A plane of the model; null for one that is 0.
const Plane* given(const StokesVisibilities& model, int plane) {
  if (plane < 0) return nullptr;
  const Plane& values = model.plane[static_cast<std::size_t>(plane)];
  return values.empty() ? nullptr : &values;
}

/// Writes value(sample), or the data less value(sample).
template <typename Value>
void put(const CorrelationSamples& to, const Value& value) {
  for (std::size_t s = 0; s < to.count; ++s) {
    const std::complex<double> model = value(s);
    std::complex<float>& out = to.out[s * to.stride];
    out = std::complex<float>(to.data == nullptr ? model : std::complex<double>(to.data[s * to.stride]) - model);
  }
}

}  // namespace

StokesResponse stokes_response(int correlation_type) {
  const auto code = static_cast<std::size_t>(correlation_type);
  return code < responses.size() ? responses[code] : StokesResponse();
}

std::vector<imager::Stokes> seen_by(const std::vector<int>& correlation_types) {
  std::vector<imager::Stokes> seen;
  for (const int plane : {0, 1, 2, 3}) {
    const auto responds = [&](int type) {
      const StokesResponse response = stokes_response(type);
      return response.first == plane || response.second == plane;
    };
    if (std::any_of(correlation_types.begin(), correlation_types.end(), responds))
      seen.push_back(static_cast<imager::Stokes>(plane + 1));
  }
  return seen;
}

void form_correlation(const StokesResponse& response, const StokesVisibilities& model, std::size_t from,
                      const CorrelationSamples& to) {
  const Plane* const first = given(model, response.first);
  const Plane* const second = given(model, response.second);
  const auto turned = [&](std::size_t s) {
    const std::complex<double> value = (*second)[from + s];
    return std::complex<double>(response.re * value.real() - response.im * value.imag(),
                                response.re * value.imag() + response.im * value.real());
  };
  if (first != nullptr && second != nullptr) {
    put(to, [&](std::size_t s) { return (*first)[from + s] + turned(s); });
  } else if (first != nullptr) {
    put(to, [&](std::size_t s) { return (*first)[from + s]; });
  } else if (second != nullptr) {
    put(to, turned);
  } else {
    for (std::size_t s = 0; s < to.count * to.stride; s += to.stride) to.out[s] = to.data == nullptr ? 0 : to.data[s];
  }
}

}  // namespace misfit::ms_io
