#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "imager/beams/beam.h"
#include "imager/clean/auto_mask.h"
#include "imager/clean/components.h"
#include "imager/clean/minor_cycle.h"
#include "imager/taylor/taylor_expansion.h"
#include "imager/transform/imaging.h"

namespace misfit::imager {

/// The part of the threshold by which a residual may exceed it in the end, as in tclean: a major cycle takes as long for the
/// last hundredth as for the first half.
constexpr double threshold_tolerance = 0.01;

/// Parameters of CLEAN with the names and meaning of CASA's tclean.
struct CleanOptions {
  int max_iterations = 0;   ///< niter
  double gain = 0.1;        ///< part of a peak that a component takes
  double threshold_jy = 0;  ///< stop when the peak residual exceeds it by threshold_tolerance at most
  /// Stop when the peak residual is not above this many times the robust noise. Minor cycles without a mask (one that allows
  /// all pixels is a mask) go on while the noise falls as sources are removed: to this many times the noise that they leave,
  /// but at least to five times.
  double nsigma = 0;
  /// A minor cycle goes down to the peak × largest sidelobe × cycle factor, that fraction of the peak clamped to [min, max];
  /// but not below the threshold, or 5 % below it where the cycle before went down to it. While components are trusted it goes
  /// on to the least fraction, but no deeper than cycle factor × the greater of 6 √Σ f² × RMS of doubtful sidelobes, f being
  /// the flux found in each square of 64 pixels, and the largest f × the largest doubtful sidelobe. With w the RMS is over the
  /// whole PSF, and the largest is taken from a quarter of the image on; where w is left out both are of the last eighth before
  /// half the image, beyond which the PSF is not known. Components are trusted where 6 × RMS and the largest doubtful sidelobe
  /// are at most a quarter of the largest sidelobe, until a cycle leaves more than 1.5 times its depth (with automask: in the
  /// mask that it leaves), or makes the residual grow, or coarser transforms are no longer taken.
  double cycle_factor = 1;
  double min_psf_fraction = 0.05;
  double max_psf_fraction = 0.8;
  int cycle_iterations = -1;                ///< cycleniter: components that a minor cycle finds at most; −1 = no limit
  int max_major_cycles = -1;                ///< nmajor; −1 = no limit
  const Image* mask = nullptr;              ///< where components may lie, see mask.h; null = everywhere
  std::optional<AutoMaskOptions> automask;  ///< the mask is made from the residuals, within `mask`
  const Image* noise_within = nullptr;      ///< where mask_noise() measures the noise, as a mask; null = everywhere
  int threads = 1;
  std::function<bool()> stop_requested;  ///< the user's wish to end; may be empty
};

/// Throws std::invalid_argument that names a parameter whose value is outside its range, as an option with `prefix` before it.
void check(const CleanOptions& options, const std::string& prefix = "");

/// Why CLEAN ended, with tclean's codes.
enum class CleanStop {
  iteration_limit = 1,
  threshold = 2,
  user = 3,
  no_change = 4,
  diverging = 5,            ///< the residual grew to more than three times the residual before
  diverging_from_best = 6,  ///< the residual grew by less, again and again
  empty_mask = 7,
  nsigma = 8,
  major_cycle_limit = 9,
};

/// The state after one major cycle.
struct MajorCycle {
  int iterations = 0;           ///< components of its model, each counted as often as it was found
  double peak_residual_jy = 0;  ///< within the mask; of the whole image where that is empty
  double rms_jy = 0;            ///< robust noise of the residual, within the mask and without
  double model_flux_jy = 0;
  double cycle_threshold_jy = 0;  ///< depth that its minor cycle was to reach, or reached if it was cut short, Jy/beam
  std::string ended;              ///< why its minor cycle ended; empty before the first
  double mean_square_jy2 = 0;     ///< of the residual
  double accuracy = 0;            ///< of the transforms that made it; 0 = as exact as any, see CleanInput
  std::size_t from = 0;           ///< the cycle whose model it began with
  double peak_anywhere_jy = 0;    ///< peak_residual_jy of the whole image
  std::size_t mask_pixels = 0;    ///< where the next minor cycle may find components
  MaskExtension masked{};         ///< how CleanOptions::automask came to these pixels
};

/// All that CLEAN carries from one major cycle to the next: with the same data and options CLEAN goes on from a state with the
/// same bits.
struct CleanState {
  ComponentModel model;
  ComponentModel best_model;       ///< the model that a cycle is taken back to
  GrowingMask mask;                ///< made from the residuals so far; empty unless CleanOptions::automask
  std::vector<MajorCycle> cycles;  ///< [0] is the state before the first; empty before that
  int iterations = 0;              ///< iterations of `model` where there are no cycles yet
  std::size_t now = 0;             ///< the cycle whose model is `model`: the last unless it was taken back
  std::size_t best = 0;            ///< the cycle whose model is `best_model`
  bool found_nothing = false;      ///< whether the last minor cycle found nothing
  std::size_t exact_from = 0;      ///< coarser transforms misled it, and are not taken from this cycle on; 0 = they are
  int tightened = 0;               ///< how often the depth was made less since the residual grew
};

struct CleanReport {
  int iterations = 0;
  CleanStop stop = CleanStop::iteration_limit;
  std::string stop_reason;
  double max_sidelobe = 0;         ///< of the PSF, outside the fitted beam
  std::vector<MajorCycle> cycles;  ///< [0] is the state before the first
  std::size_t kept = 0;            ///< the cycle whose model was kept; the last unless it left more than the best

  const MajorCycle& final_state() const { return cycles[kept]; }
};

struct CleanResult {
  ComponentModel components;
  Image model;     ///< Jy/pixel, of the components
  Image residual;  ///< Jy/beam, of this model
  Image mask;      ///< made by CleanOptions::automask; empty without
  CleanReport report;
  std::vector<Image> further_models;     ///< of Taylor terms after the first [term − 1], Jy/pixel; none of one term
  std::vector<Image> further_residuals;  ///< [term − 1], Jy/beam

  std::vector<const Image*> models() const { return all_terms(model, further_models); }           ///< [term]
  std::vector<const Image*> residuals() const { return all_terms(residual, further_residuals); }  ///< [term]
};

/// The input of CLEAN: an image, or the Taylor terms of one, of which the first is the image. Where several ranks share the
/// samples, rank 0 cleans and the others call follow_clean().
struct CleanInput {
  ImagedData imaged;
  TaylorExpansion expansion{};    ///< of the components' spectra
  std::vector<Image> dirty;       ///< of these samples: R_t [term], see TaylorImages; CLEAN takes them as its first residuals
  double dirty_accuracy = 0;      ///< relative, of `dirty`; 0 = as exact as `imaged` makes them
  bool of_start = false;          ///< `dirty` are residuals of the state's model, not of an empty model
  std::vector<const Image*> psf;  ///< P_k [k], 2 terms − 1 of them
  double max_sidelobe = 0;        ///< the largest of the first PSF
  bool same_sidelobes = false;    ///< the first PSF's sidelobes are right for sources anywhere, as where w is left out
  /// Transforms for residuals that decide where minor cycles go next, the least exact first; the last residual is made by the
  /// transform of `imaged`.
  std::vector<CoarserTransform> coarser{};
  double data_jy = 0;      ///< root mean square of the visibilities
  double accuracy = 1e-7;  ///< of images and prediction, relative; single-precision data have no better
  Beam beam{};             ///< the PSF's main lobe; automask alone needs it
  double cell_rad = 0;     ///< pixel size, for automask
};

/// Told before the first and after every major cycle.
using CycleProgress = std::function<void(const CleanState&)>;

/// Largest magnitude of the PSF once the Gaussian `beam` is taken off; NaN does not count.
double largest_sidelobe(const Image& psf, const Image& beam);
/// largest_sidelobe() for a beam about the middle pixel, on pixels of this size.
double largest_sidelobe(const Image& psf, const Beam& beam, double cell_rad, int threads);

/// Sidelobes of a PSF far from its middle; NaN does not count.
struct FarSidelobes {
  double root_mean_square = 0;
  double largest = 0;  ///< in magnitude
};
/// Measures the sidelobes that lie this part of the PSF's width or height from its middle, or farther.
FarSidelobes far_sidelobes(const Image& psf, double from_part);

/// The state with which CLEAN begins: a model of the minor cycle's scales, of these points.
CleanState first_state(const ComponentModel& model);

/// Cotton–Schwab CLEAN (Schwab 1984, AJ 89, 1076): minor cycles find components in the image; major cycles predict the model's
/// visibilities, subtract them from the data, and image the difference. It begins with `state`, whose model has the scales of
/// `minor`. With several Taylor terms components have spectra, and major cycles predict Σ_t x^t A I_t and image the difference
/// for each term; peaks, noise, thresholds and masks are those of the first term's residual, as in tclean.
///
/// A major cycle whose residual has a peak 1.5 times the smallest so far (with automask, whose masks grow: 1.5 times the peak
/// before, within the same mask) is taken back: CLEAN goes on from the best model, and minor cycles go half as far down from
/// the peak. After three such cycles CLEAN stops as diverging; or as without change, where the peak is ten times `accuracy` of
/// the dirty image's or less, since the residual then is the error of the transforms. It also stops as without change where
/// neither the peak nor the mean square of the residual becomes less in five cycles. Where the last cycle left more than the
/// best, in peak and mean square, the result is the best cycle's.
///
/// A residual for further minor cycles is made by the least exact of the transforms whose error, by theory, is at most a
/// fiftieth of the depth to which these will go, or a twentieth where components are trusted; it may be the dirty image. A
/// residual that ends CLEAN is made anew as exactly as was asked. Where that one does not end CLEAN, and where a residual grew,
/// all later residuals are made as exactly, since sources outside the image may err by more.
///
/// Stages timed: "minor cycles", "statistics", and those of make_residual_image. Throws std::runtime_error when a PSF or a
/// residual is not finite, std::invalid_argument unless terms, images and `minor` agree.
CleanResult clean(CleanInput input, const MinorCycle& minor, const CleanOptions& options, CleanState state,
                  const CycleProgress& cycle_progress, const Context& context);

}  // namespace misfit::imager
