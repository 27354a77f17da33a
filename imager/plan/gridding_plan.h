#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "imager/plan/gridding_choice.h"
#include "imager/plan/plan.h"
#include "imager/wide/wide_transform.h"

namespace misfit::imager {

struct GriddingPlan;

/// How a mosaic's windows are transformed.
struct WindowsPlan {
  /// The plan of a window's transforms: one plan for all curved terms of beams together, see CurvedTerms, in the largest
  /// window; or a plan for each term of beams, [term, see BeamSpan], in the window over which w matters most, as exact as the
  /// term's size asks.
  std::vector<std::shared_ptr<const GriddingPlan>> of_term;
  std::size_t curved = 0;          ///< curved terms; 0: terms of beams one by one
  std::size_t curved_at_once = 0;  ///< that memory has room for
  std::size_t windows = 0;         ///< windows of pointings and pairs of dishes that see the image
  std::size_t unseeing = 0;        ///< pointings that see no pixel of the image
  std::size_t spans = 1;           ///< see BeamSpan
  std::size_t gathers = 1;         ///< times that samples are gathered and all windows transformed
  std::size_t most_at_once = 1;    ///< windows whose work memory has room for
  int side_by_side = 1;            ///< see MosaicOptions

  /// Transforms of each of these plans that a pass takes.
  double transforms() const { return static_cast<double>(windows * spans * gathers); }
  int at_once() const { return static_cast<int>(std::max<std::size_t>(1, curved_at_once)); }
  /// Images that each of the plans makes for one image asked.
  int images_each() const { return static_cast<int>(std::max<std::size_t>(1, curved)); }
};

/// A plan of gridding: the cheapest that keeps the promise.
struct GriddingPlan {
  GriddingRequest request;       ///< what was asked
  WideTransformOptions options;  ///< with a w axis where the scene needs one
  double expected_error = 0;     ///< RMS error of image and prediction relative to data with random phases, √(E_u + E_v)
  double worst_error = 0;  ///< expected_error for the worst position of samples in their cells, or the worst pixel of a model
  double rounding = 0;     ///< the part of rounding in both
  double bound_rms = 0;    ///< bound on the RMS error of the image over Σ w|V| / Σ w, whatever the data
  double bound_max = 0;    ///< bound on any pixel's error over Σ w|V| / Σ w, whatever the data
  GriddingChoice choice;   ///< with the neighbours that were rejected
  bool direct = false;     ///< images are made by direct sums, which cost less for so few samples
  std::uint64_t direct_pixels = 0;             ///< a model of no more pixels is predicted by direct sums
  std::shared_ptr<const GriddingPlan> psf;     ///< of the PSF, where it has a transform of its own
  std::shared_ptr<const WindowsPlan> windows;  ///< of a mosaic, whose `options` and `choice` are those of a window's first term
  Plan decisions;

  /// Windows of a mosaic know w in full.
  bool leaves_w_out() const { return !direct && !windows && !options.has_w_axis(); }
};

/// Throws std::invalid_argument when the kernel's width, the padding or the accuracy lie outside what can be asked; whether the
/// accuracy can be reached takes plan_gridding to tell.
void check_request(const GriddingRequest& request);

/// Throws std::invalid_argument as check_request does, and with the message of out_of_reach() when the accuracy is out of
/// reach.
GriddingPlan plan_gridding(const GriddingRequest& request);

/// The plan for so many threads, which change no bit of its results.
GriddingPlan with_threads(GriddingPlan plan, int threads);

/// The evaluation of its taps: "polynomials of degree 9", or "cubic tables of 64 entries a cell".
std::string evaluation_of(const CoplanarOptions& options);

/// The memory that the planned transform takes.
TransformMemory memory_of(const GriddingPlan& plan);

}  // namespace misfit::imager
