#pragma once

#include <algorithm>
#include <complex>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <tuple>
#include <vector>

#include "imager/data/phase.h"
#include "imager/pointing/mosaic_beams.h"
#include "imager/transform/transform.h"
#include "imager/wide/facet.h"

namespace misfit::imager {

/// The transforms of what windows show of a term of beams, see BeamSpan.
struct TermTransforms {
  /// Of a window's pixels.
  std::function<std::shared_ptr<const Transform>(const ImageGeometry& window)> make;
  /// Whether they know no w, and windows of one size share one about the phase centre. Of w counts then what the plane makes of
  /// it that lies closest to n − 1 over a window, see Facet.
  bool on_planes = false;
};

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
  Facet plane;  ///< of the whole window
};

/// The samples of a group of rows that lie in a span of frequencies.
struct WindowSamples {
  std::vector<std::size_t> rows;           ///< of the block
  std::vector<std::size_t> channels;       ///< of the block
  std::vector<std::vector<double>> share;  ///< [channel][term]: by how much a term of beams counts
  SampleCoordinates at;

  std::size_t size() const { return rows.size() * channels.size(); }
};

/// The same samples about a window's middle, where w has become a part of u and v.
struct SamplesOnPlane {
  SampleCoordinates at;
  std::vector<std::complex<double>> phase;  ///< exp(+2πi(u l_0 + v m_0 + w middle)), which is left to them. [row][channel]
};

/// What adjoint and prediction of a mosaic share.
class MosaicWindows {
 public:
  /// With the transforms of each term that counts.
  MosaicWindows(std::shared_ptr<const MosaicBeams> beams, std::vector<TermTransforms> of_term, const MosaicOptions& options)
      : beams_(std::move(beams)), of_term_(std::move(of_term)), options_(options) {}

  const MosaicBeams& beams() const { return *beams_; }
  const MosaicOptions& options() const { return options_; }
  /// Terms that are gridded.
  std::size_t terms(const BeamSpan& span) const { return std::min(span.terms(), of_term_.size()); }
  /// Null where the group sees nothing of the image. The same object for rows that see alike.
  std::shared_ptr<const SeenWindow> seen(const RowBeams::Group& group) const;
  WindowSamples samples(const SampleCoordinates& block, const std::vector<std::size_t>& rows, const BeamSpan& span) const;

  bool on_planes(std::size_t term) const { return of_term_[term].on_planes; }
  std::shared_ptr<const Transform> transform(const Window& window, std::size_t term) const;
  SamplesOnPlane on_plane(const SeenWindow& seen, const SampleCoordinates& at) const;
  /// All terms of a window's beam.
  std::vector<Image> beam_terms(const SeenWindow& seen, const BeamSpan& span) const {
    return beams_->terms(seen.beam, seen.window, span, options_.threads_of_each());
  }
  bool sees_psf(const SeenWindow& seen) const;
  /// What a source of 1 Jy in the PSF's pixel gives these samples. [row][channel]
  std::vector<std::complex<double>> psf_source(const SeenWindow& seen, const BeamSpan& span,
                                               const WindowSamples& samples) const;

 private:
  DirectionCosines psf_direction() const { return beams_->geometry().at(options_.psf_row, options_.psf_column); }

  std::shared_ptr<const MosaicBeams> beams_;
  std::vector<TermTransforms> of_term_;
  MosaicOptions options_;
  mutable std::mutex mutex_;  ///< of what follows
  mutable std::map<std::tuple<std::size_t, int, int, int, int>, std::shared_ptr<const Transform>> made_;
  mutable std::map<std::tuple<const VoltagePattern*, const VoltagePattern*, int, double>, std::shared_ptr<const SeenWindow>>
      seen_;
};

}  // namespace misfit::imager
