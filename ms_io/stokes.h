#pragma once

#include <complex>
#include <cstddef>
#include <string>
#include <vector>

#include "imager/visibilities.h"

namespace misfit::ms_io {

/// How Stokes I is formed from the correlations of one polarisation setup: I = (V_first + V_second)/2 with weight
/// 1/(1/w_first + 1/w_second), from the parallel hands; or the stored I itself, then first = second.
struct StokesI {
  std::size_t correlations = 0;  ///< stored in the setup
  std::size_t first = 0;         ///< index of XX, RR or I
  std::size_t second = 0;        ///< index of YY, LL or I
};

/// The recipe for correlations given by casacore's Stokes codes (CORR_TYPE). Throws std::runtime_error, which lists the
/// correlations there are, when there is neither XX with YY, nor RR with LL, nor I. I is preferred where it is stored.
StokesI stokes_i(const std::vector<int>& correlation_types);

/// "XX" for 9, and so on; "code 99" for a code that is no linear, circular or Stokes product.
std::string correlation_name(int correlation_type);

/// Whether an unpolarised source of flux I shows up as I in this correlation: XX, YY, RR, LL and I. It is 0 in the others.
bool receives_stokes_i(int correlation_type);

/// A run of channels of one row as stored, correlations fastest.
struct StoredSamples {
  const std::complex<float>* data = nullptr;  ///< [channel][correlation]
  const bool* flag = nullptr;                 ///< [channel][correlation]
  const float* weight = nullptr;              ///< [channel][correlation], or [correlation] for all channels
  bool weight_per_channel = false;
  bool uvw_is_finite = true;
  std::size_t channels = 0;
};

/// Where Stokes I goes.
struct StokesSamples {
  std::complex<float>* visibility = nullptr;  ///< [channel]
  float* weight = nullptr;                    ///< [channel]
};

/// Forms Stokes I. Unusable samples become visibility 0 with weight 0, counted in `counts` under the first reason that
/// applies of flagged, non-finite, zero weight; the others are counted as used. Channels are not added to `samples_read`.
void form_stokes_i(const StokesI& recipe, const StoredSamples& stored, const StokesSamples& formed,
                   imager::SampleCounts& counts);

}  // namespace misfit::ms_io
