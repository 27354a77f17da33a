#include "tools/run/cube_files.h"

#include "imager/primary_beam.h"
#include "tools/run/image_files.h"
#include "tools/run/primary_beam_stage.h"

namespace misfit::tools {

CubeFiles::CubeFiles(const ImageOptions& o, const imager::ImageHeader& header, bool masks) {
  const auto open = [&](const char* kind, const char* unit, bool one_stokes = false) {
    imager::ImageHeader own = header;
    own.unit = unit;
    if (one_stokes) own.stokes.resize(1);
    return open_image_files(o.imagename + "." + kind, own, pixel_format(o.accuracy), o.outformat);
  };
  psf_ = open("psf", "Jy/beam", true);
  residual_ = open("residual", "Jy/beam");
  if (wants_primary_beam(o)) primary_beam_ = open("pb", "", true);
  if (o.pbcor) corrected_ = open("image.pbcor", "Jy/beam");
  if (o.niter == 0) return;
  model_ = open("model", "Jy/pixel");
  restored_ = open("image", "Jy/beam");
  if (masks) mask_ = open("mask", "");
}

void CubeFiles::write_psf(int channel, const imager::Image& psf, const std::optional<imager::Beam>& beam) {
  psf_->write({channel, 0}, psf, beam);
}

void CubeFiles::write(const imager::PlaneIndex& at, const Plane& plane, const std::optional<imager::Beam>& beam) {
  const auto put = [&](const Writer& writer, const imager::Image* image, const std::optional<imager::Beam>& of) {
    if (writer && image != nullptr && !image->pixel.empty()) writer->write(at, *image, of);
  };
  put(residual_, plane.residual, beam);
  put(model_, plane.model, {});
  put(restored_, plane.restored, beam);
  put(mask_, plane.mask, {});
  if (plane.primary_beam == nullptr) return;
  if (at.stokes == 0) put(primary_beam_, plane.primary_beam, {});
  if (!corrected_) return;
  const imager::Image corrected =
      imager::corrected(plane.restored == nullptr ? *plane.residual : *plane.restored, *plane.primary_beam);
  put(corrected_, &corrected, beam);
}

void CubeFiles::finish() {
  for (const Writer* writer : {&psf_, &residual_, &model_, &mask_, &primary_beam_, &restored_, &corrected_})
    if (*writer) (*writer)->finish();
}

}  // namespace misfit::tools
