#pragma once

#include <complex>
#include <cstddef>
#include <vector>

#include "imager/data/stokes.h"
#include "ms_io/model_writer.h"

namespace misfit::ms_io {

/// How a correlation V responds to the Stokes parameters S of a source:
///
///     V = S_first + (re + i im) S_second,
///
/// XX = I+Q, XY = U+iV, YX = U−iV, YY = I−Q; RR = I+V, RL = Q+iU, LR = Q−iU, LL = I−V (Hamaker & Bregman 1996, A&AS 117, 161).
struct StokesResponse {
  int first = -1;   ///< index into StokesVisibilities::plane; below 0: V = 0
  int second = -1;  ///< below 0: none
  double re = 0, im = 0;
};

/// The response of a correlation with one of casacore's Stokes codes; 0 for codes that are no linear, circular or Stokes
/// product.
StokesResponse stokes_response(int correlation_type);

/// The parameters of I, Q, U and V that one of these correlations responds to.
std::vector<imager::Stokes> seen_by(const std::vector<int>& correlation_types);

/// A run of samples of one correlation.
struct CorrelationSamples {
  const std::complex<float>* data = nullptr;  ///< the model is subtracted from these; null: the model itself is wanted
  std::complex<float>* out = nullptr;
  std::size_t stride = 1;  ///< from one sample of `data` and `out` to the next
  std::size_t count = 0;
};

/// Forms `to.count` samples, of which the first is the sample `from` of `model`. Where no plane that the correlation responds
/// to is given, they are 0, or the data bit by bit.
void form_correlation(const StokesResponse& response, const StokesVisibilities& model, std::size_t from,
                      const CorrelationSamples& to);

}  // namespace misfit::ms_io
