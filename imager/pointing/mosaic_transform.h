#pragma once

#include <memory>

#include "imager/pointing/mosaic_windows.h"
#include "imager/transform/transform.h"

namespace misfit::imager {

/// The operator of a mosaic and its adjoint,
///   V_r = A (B_r · I),   D = Σ_r B_r A* w V
/// with the beam B_r of each row and channel as MosaicBeams has it, and A the operator of transform.h. It is computed on the
/// window that each beam sees. Rows whose beams see no pixel predict 0 and add nothing. Coordinates have the sights of their
/// rows. Beams follow from their terms to the tolerance of MosaicBeams, and from those that have a transform as far as these
/// are all; forward and adjoint are each other's transposes to rounding. With curved terms, predictions and adjoints throw
/// std::invalid_argument where |w| of a sample is larger than the beams were made for. The PSF is the response to a source of 1
/// Jy in the pixel of MosaicOptions, as the beams show it to each row.
class MosaicTransform : public Transform {
 public:
  /// With the transforms of each term of beams, or of all curved terms.
  MosaicTransform(std::shared_ptr<const MosaicBeams> beams, WindowTransforms transforms, const MosaicOptions& options)
      : windows_(std::make_shared<const MosaicWindows>(std::move(beams), std::move(transforms), options)) {}

  std::unique_ptr<AdjointSum> adjoint(const AdjointOptions& options) const override;
  std::unique_ptr<Prediction> predict(Image model) const override;
  std::vector<std::complex<double>> psf_source(const SampleCoordinates& at) const override;
  /// From the sensitivity.
  Normalisation normalisation(const AdjointResult& sums) const override;

 private:
  std::shared_ptr<const MosaicWindows> windows_;
};

}  // namespace misfit::imager
