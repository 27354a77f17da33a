#pragma once

#include <complex>
#include <functional>
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

/// The transforms of a mosaic's windows.
struct WindowTransforms {
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
  bool flat_noise = true;              ///< see MosaicView
  std::size_t windows_at_once = 1000;  ///< that an adjoint or a prediction holds; at least 1
  std::size_t samples_at_once = 0;     ///< see Prediction
  int threads = 1;
};

/// A window as the samples of a group of rows see it.
struct SeenWindow {
  PairBeam beam;
  Window window;
  Facet plane;  ///< of the whole window
  std::shared_ptr<const Transform> transform;
};

/// The samples of a group of rows that lie in a span of frequencies, as the transform of their window has them.
struct WindowSamples {
  std::vector<std::size_t> rows;           ///< of the block
  std::vector<std::size_t> channels;       ///< of the block
  std::vector<std::vector<double>> share;  ///< [channel][node]: by how much the beam of each node counts
  SampleCoordinates at;
  /// exp(+2πi(u l_0 + v m_0 + w middle)), which is left to the samples where windows lie on planes, [row][channel]; else empty.
  std::vector<std::complex<double>> phase;

  std::size_t size() const { return rows.size() * channels.size(); }
};

/// What adjoint and prediction of a mosaic share.
class MosaicWindows {
 public:
  MosaicWindows(std::shared_ptr<const MosaicBeams> beams, WindowTransforms transforms, const MosaicOptions& options)
      : beams_(std::move(beams)), transforms_(std::move(transforms)), options_(options) {}

  const MosaicBeams& beams() const { return *beams_; }
  const MosaicOptions& options() const { return options_; }
  /// Null where the group sees nothing of the image. The same object for rows that see alike.
  std::shared_ptr<const SeenWindow> seen(const RowBeams::Group& group) const;
  WindowSamples samples(const SeenWindow& seen, const SampleCoordinates& block, const std::vector<std::size_t>& rows,
                        const FrequencySpan& span) const;
  /// What a source of 1 Jy in the PSF's pixel gives these samples of a block. [row][channel]
  std::vector<std::complex<double>> psf_source(const SeenWindow& seen, const FrequencySpan& span, const WindowSamples& samples,
                                               const SampleCoordinates& block) const;

 private:
  std::shared_ptr<const Transform> transform_of(const Window& window) const;
  /// unit_source() of these samples of a block.
  std::vector<std::complex<double>> unit_source_of(const SampleCoordinates& block, const WindowSamples& samples,
                                                   const PhasePosition& source) const;

  std::shared_ptr<const MosaicBeams> beams_;
  WindowTransforms transforms_;
  MosaicOptions options_;
  mutable std::mutex mutex_;  ///< of what follows
  mutable std::map<std::tuple<int, int, int, int>, std::shared_ptr<const Transform>> made_;
  mutable std::map<std::tuple<const VoltagePattern*, const VoltagePattern*, int, double>, std::shared_ptr<const SeenWindow>>
      seen_;
};

}  // namespace misfit::imager
