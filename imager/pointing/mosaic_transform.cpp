#include "imager/pointing/mosaic_transform.h"

#include "imager/pointing/mosaic_adjoint.h"
#include "imager/pointing/mosaic_prediction.h"

namespace misfit::imager {

std::unique_ptr<AdjointSum> MosaicTransform::adjoint(const AdjointOptions& options) const {
  return make_mosaic_adjoint(windows_, options);
}

std::unique_ptr<Prediction> MosaicTransform::predict(Image model) const {
  return make_mosaic_prediction(windows_, std::move(model));
}

std::vector<std::complex<double>> MosaicTransform::psf_source(const SampleCoordinates& at) const {
  std::vector<std::complex<double>> source(at.samples());
  for (const RowBeams::Group& group : windows_->beams().groups(at)) {
    const std::shared_ptr<const SeenWindow> seen = windows_->seen(group);
    if (!seen) continue;
    for (const BeamSpan* span : windows_->beams().spans(at.frequency_hz)) {
      const WindowSamples samples = windows_->samples(at, group.rows, *span);
      const std::vector<std::complex<double>> some = windows_->psf_source(*seen, *span, samples);
      for (std::size_t r = 0, i = 0; r < samples.rows.size(); ++r)
        for (const std::size_t c : samples.channels) source[samples.rows[r] * at.channels() + c] = some[i++];
    }
  }
  return source;
}

Normalisation MosaicTransform::normalisation(const AdjointResult& sums) const {
  const MosaicOptions& o = windows_->options();
  return {sums.sensitivity, o.flat_noise, o.psf_row, o.psf_column};
}

}  // namespace misfit::imager
