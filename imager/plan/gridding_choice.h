#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "imager/plan/gridding_candidate.h"
#include "imager/pointing/mosaic_beams.h"
#include "imager/wide/wide_transform.h"
#include "kernels/catalogue.h"

namespace misfit::imager {

/// Transforms have a w axis where its phase matters, never, or always.
enum class Gridder { automatic, standard, wide };

/// The request for a mosaic's transform, of the same image as the beams.
struct MosaicRequest {
  std::shared_ptr<const MosaicBeams> beams;
  int psf_row = 0;  ///< of the pixel whose source the PSF is the response to
  int psf_column = 0;
  bool flat_noise = true;  ///< see MosaicView

  std::size_t pointings() const { return beams->rows().of_fields().size(); }
};

/// The number of pointings; 1 where there is no mosaic.
inline std::size_t pointings_of(const std::shared_ptr<const MosaicRequest>& mosaic) {
  return mosaic ? mosaic->pointings() : 1;
}

/// The requirements on a transform.
struct GriddingRequest {
  ImageGeometry geometry;
  std::shared_ptr<const MosaicRequest> mosaic = {};  ///< null: all samples see all pixels alike
  double accuracy = 1e-6;  ///< ε: ‖I − I_DFT‖₂ ≤ ε ‖I_DFT‖₂; 0 = whatever the given width and padding reach
  kernels::KernelFamily kernel = kernels::kernel_family("least-misfit");
  int kernel_width = 0;         ///< cells along u and v; 0 = chosen
  double padding = 0;           ///< FFT size over image size along u and v, at least 1.02; 0 = chosen
  double least_padding = 1.02;  ///< bounds of the paddings to choose from along u and v
  double most_padding = 10;
  bool best_effort = false;   ///< take the most exact kernel when the accuracy is out of reach
  std::uint64_t samples = 0;  ///< visibilities in a pass
  int stokes = 1;             ///< Stokes parameters, each of which has a dirty image made in the pass; 0: the PSF alone
  bool psf = true;            ///< whether the PSF is made besides
  double psf_accuracy = 0;    ///< of a PSF that may have a transform of its own; 0 = the accuracy
  int threads = 1;
  Gridder gridder = Gridder::automatic;
  double max_abs_w = 0;                ///< largest |w| of the samples, in wavelengths
  std::optional<Precision> precision;  ///< of taps, grid and FFT; chosen where there is none
  double single_from = 1e-6;           ///< the smallest accuracy for which single precision may be chosen
  bool shortest_polynomials = true;    ///< whether polynomials have the lowest degree that costs less than half a percent of E
  std::optional<kernels::TableOptions> lookup;                           ///< tables of the full polynomials instead
  bool facets = true;                                                    ///< a w axis may split the image
  std::size_t stack_bytes = WideTransformOptions().stack_bytes;          ///< memory for w planes
  std::size_t samples_at_once = WideTransformOptions().samples_at_once;  ///< that a w axis gathers
};

enum class Rejection { costs_more, not_exact_enough };

/// A neighbour of the choice that was not taken. A neighbour that costs more may not have been judged: its width is then the
/// least that may be enough.
struct RejectedCandidate {
  GriddingCandidate candidate;
  Rejection reason = Rejection::costs_more;
};

struct GriddingChoice {
  GriddingCandidate best;  ///< the cheapest that reaches the accuracy, or the most exact
  bool reached = true;
  double borne_phase_rad = 0;               ///< the neglected phase of w that the accuracy allows beside the error of `best`
  double w_phase_rad = 0;                   ///< the largest phase of w over the image; neglected unless `best` has a w axis
  std::vector<RejectedCandidate> rejected;  ///< the cheapest at each other padding, and the widths next to the best
};

/// Part of the accuracy that the neglected phase of w may take.
inline constexpr double neglected_part = 0.3;

/// The cheapest way that reaches the accuracy, by the fixed constants of CostModel: width along u and v and along w, padding
/// for each axis, facets, precision, and degree of the polynomials.
GriddingChoice choose_gridding(const GriddingRequest& request);

}  // namespace misfit::imager
