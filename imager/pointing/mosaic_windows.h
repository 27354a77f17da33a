#pragma once

#include <algorithm>
#include <complex>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <tuple>
#include <variant>
#include <vector>

#include "imager/coplanar/shared_transform.h"
#include "imager/pointing/mosaic_beams.h"
#include "imager/transform/transform.h"

namespace misfit::imager {

/// Makes the transform of what a window's pixels show of a term of beams, see BeamSpan: each term has its own.
using MakeTermTransform = std::function<std::shared_ptr<const Transform>(const ImageGeometry& window)>;

/// One transform of what a window shows of all curved terms of its beam, see CurvedTerms.
struct CurvedTransforms {
  /// Makes the transform of a window's pixels moved to the phase centre, so that windows of one size share it.
  std::function<std::shared_ptr<const SharedTransform>(const ImageGeometry& window)> make;
  std::size_t terms = most_shared_images;    ///< that are gridded at most: those that come late count least
  std::size_t at_once = most_shared_images;  ///< that are gridded at a time
};

/// How windows are transformed.
using WindowTransforms = std::variant<std::vector<MakeTermTransform>, CurvedTransforms>;

struct MosaicOptions {
  /// Of the pixel whose source the PSF is the response to.
  int psf_row = 0;
  int psf_column = 0;
  bool flat_noise = true;  ///< see MosaicView
  std::size_t samples_at_once =
      std::numeric_limits<std::size_t>::max();  ///< an adjoint is computed whenever so many have gathered; see also Prediction
  int threads = 1;
  int side_by_side = 1;  ///< windows that are worked on at a time, each by a share of the threads

  int threads_of_each() const { return std::max(1, threads / std::max(1, side_by_side)); }
};

/// A window as the samples of a group of rows see it.
struct SeenWindow {
  PairBeam beam;
  Window window;
};

/// The samples of a group of rows that lie in a span of frequencies.
struct WindowSamples {
  std::vector<std::size_t> rows;           ///< of the block
  std::vector<std::size_t> channels;       ///< of the block
  std::vector<std::vector<double>> share;  ///< [channel][term]: by how much a term of beams counts
  SampleCoordinates at;

  std::size_t size() const { return rows.size() * channels.size(); }
};

/// Samples of a window, over the plane that is tangent to the sky at their beam's axis.
struct CurvedSamples {
  const CurvedTerms* terms;
  VisibilityBlock at;                       ///< with u and v along the plane, w/n_0, and weights
  std::vector<std::complex<double>> phase;  ///< of a source in the window's middle where q is 0. [row][channel]

  /// By how much these samples count in some of the terms. The samples must outlive them.
  SampleShares shares(std::size_t first, std::size_t count) const;
};

/// What adjoint and prediction of a mosaic share.
class MosaicWindows {
 public:
  /// With the transforms of each term that counts, or of all curved ones.
  MosaicWindows(std::shared_ptr<const MosaicBeams> beams, WindowTransforms transforms, const MosaicOptions& options)
      : beams_(std::move(beams)), transforms_(std::move(transforms)), options_(options) {}

  const MosaicBeams& beams() const { return *beams_; }
  const MosaicOptions& options() const { return options_; }
  /// Terms that are gridded.
  std::size_t terms(const BeamSpan& span) const {
    return is_curved() ? std::min(beams_->curved(span).terms(), std::get<1>(transforms_).terms)
                       : std::min(span.terms(), std::get<0>(transforms_).size());
  }
  /// Null where the group sees nothing of the image. The same object for rows that see alike.
  std::shared_ptr<const SeenWindow> seen(const RowBeams::Group& group) const;
  WindowSamples samples(const SampleCoordinates& block, const std::vector<std::size_t>& rows, const BeamSpan& span) const;

  std::shared_ptr<const Transform> transform(const Window& window, std::size_t term) const;

  bool is_curved() const { return transforms_.index() == 1; }
  std::size_t curved_at_once() const { return std::get<1>(transforms_).at_once; }
  std::shared_ptr<const SharedTransform> curved_transform(const Window& window) const;
  CurvedSamples curved_samples(const SeenWindow& seen, const BeamSpan& span, const SampleCoordinates& at,
                               std::vector<float> weight) const;
  /// All terms of a window's beam.
  std::vector<Image> beam_terms(const SeenWindow& seen, const BeamSpan& span) const {
    return beams_->terms(seen.beam, seen.window, span, options_.threads_of_each());
  }
  /// Some of the curved terms of a window's beam.
  std::vector<Image> curved_images(const SeenWindow& seen, const BeamSpan& span, std::size_t first, std::size_t count) const {
    return beams_->curved_images(seen.beam, seen.window, span, first, count, options_.threads_of_each());
  }
  bool sees_psf(const SeenWindow& seen) const;
  /// What a source of 1 Jy in the PSF's pixel gives these samples. [row][channel]
  std::vector<std::complex<double>> psf_source(const SeenWindow& seen, const BeamSpan& span,
                                               const WindowSamples& samples) const;

 private:
  DirectionCosines psf_direction() const { return beams_->geometry().at(options_.psf_row, options_.psf_column); }

  std::shared_ptr<const MosaicBeams> beams_;
  WindowTransforms transforms_;
  MosaicOptions options_;
  mutable std::mutex mutex_;  ///< of what follows
  mutable std::map<std::tuple<std::size_t, int, int, int, int>, std::shared_ptr<const Transform>> made_;
  mutable std::map<std::tuple<int, int>, std::shared_ptr<const SharedTransform>> curved_;
  mutable std::map<std::tuple<const VoltagePattern*, const VoltagePattern*, int, double>, std::shared_ptr<const SeenWindow>>
      seen_;
};

}  // namespace misfit::imager
