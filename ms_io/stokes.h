#pragma once

#include <array>
#include <complex>
#include <cstddef>
#include <string>
#include <vector>

#include "imager/data/stokes.h"
#include "imager/data/visibilities.h"

namespace misfit::ms_io {

/// One Stokes parameter, or one correlation, as a sum of the correlations that are stored: Σ factor[k] · V[used[k]], where
/// `used` belongs to StokesRecipe.
using StokesTerms = std::vector<std::complex<float>>;

/// Which of its two correlations a sample of Stokes I is formed from: both, which must both be usable; or, where one is not
/// usable, the other alone.
enum class Hands { both, either };

/// How Stokes parameters are formed from the correlations of one polarisation setup, with
///   XX = I + Q, XY = U + iV, YX = U − iV, YY = I − Q;  RR = I + V, RL = Q + iU, LR = Q − iU, LL = I − V
/// (Hamaker & Bregman 1996, for feeds along and across the meridian: correlations are taken as they are, parallactic angles are
/// calibration's). A sample takes part when all correlations in use do. All parameters share its weight, 1/(4 σ²) with σ² the
/// mean of their variances: 1 / Σ share[k] / w[used[k]], that is 1/(1/w_XX + 1/w_YY) for I.
struct StokesRecipe {
  std::size_t correlations = 0;    ///< stored in the setup
  std::vector<std::size_t> used;   ///< their indices, ascending
  std::vector<float> share;        ///< [used] 4 × the mean of |factor|²
  std::vector<StokesTerms> terms;  ///< [Stokes parameter][used]
  Hands hands = Hands::both;       ///< either: there are two in use, each with the factor 1/2
};

/// The recipe for correlations given by casacore's Stokes codes (CORR_TYPE). A Stokes parameter is taken as it is where it is
/// stored. Throws std::runtime_error, which lists the correlations there are, when one of `wanted` cannot be formed. With
/// Hands::either Stokes I alone is wanted, for which one of XX, YY, RR and LL is enough: unpolarised emission is the same in
/// each, and the weight is that of I from one correlation, 1/(4 σ²).
StokesRecipe stokes_recipe(const std::vector<int>& correlation_types, const std::vector<imager::Stokes>& wanted,
                           Hands hands = Hands::both);

/// "XX" for 9, and so on; "code 99" for a code that is no linear, circular or Stokes product.
std::string correlation_name(int correlation_type);

/// A run of channels of one row as stored, correlations fastest.
struct StoredSamples {
  const std::complex<float>* data = nullptr;  ///< [channel][correlation]
  const bool* flag = nullptr;                 ///< [channel][correlation]
  const float* weight = nullptr;              ///< [channel][correlation], or [correlation] for all channels
  bool weight_per_channel = false;
  bool uvw_is_finite = true;
  std::size_t channels = 0;
};

/// The memory that Stokes parameters go to.
struct StokesSamples {
  std::array<std::complex<float>*, 12> visibility{};  ///< [Stokes parameter][channel]
  float* weight = nullptr;                            ///< [channel]
};

/// Forms all Stokes parameters of the recipe. Unusable samples become visibility 0 with weight 0, counted in `counts` under the
/// first reason that applies of flagged, non-finite, zero weight; the others are counted as used. Channels are not added to
/// `samples_read`.
void form_stokes(const StokesRecipe& recipe, const StoredSamples& stored, const StokesSamples& formed,
                 imager::SampleCounts& counts);

}  // namespace misfit::ms_io
