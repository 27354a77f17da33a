#include "tools/run/cube_files.h"

#include <mutex>

#include "imager/beams/primary_beam.h"
#include "tools/run/image_files.h"
#include "tools/run/primary_beam_stage.h"

namespace misfit::tools {

CubeFiles::CubeFiles(const ImageOptions& o, const imager::ImageHeader& header, bool masks, const Open& open_file) {
  const auto open = [&](const char* kind, const char* unit, bool one_stokes = false) {
    imager::ImageHeader own = header;
    own.unit = unit;
    if (one_stokes) own.stokes.resize(1);
    for (const std::string& path : image_paths(o.imagename + "." + kind, o.outformat)) paths_.push_back(path);
    Writer file = open_file(o.imagename + "." + kind, own);
    files_.push_back(file.get());
    return file;
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
  const std::lock_guard lock(image_files_mutex());
  psf_->write({channel, 0}, psf, beam);
}

void CubeFiles::write_sent(int file, const imager::PlaneIndex& at, const imager::Image& image,
                           const std::optional<imager::Beam>& beam) {
  const std::lock_guard lock(image_files_mutex());
  files_.at(static_cast<std::size_t>(file))->write(at, image, beam);
}

void CubeFiles::put(const Writer& writer, const imager::PlaneIndex& at, const imager::Image* image,
                    const std::optional<imager::Beam>& beam) {
  if (writer && image != nullptr && !image->pixel.empty()) writer->write(at, *image, beam);
}

void CubeFiles::write(const imager::PlaneIndex& at, const Plane& plane, const std::optional<imager::Beam>& beam) {
  {
    const std::lock_guard lock(image_files_mutex());
    put(residual_, at, plane.residual, beam);
    put(model_, at, plane.model, {});
    put(mask_, at, plane.mask, {});
    if (at.stokes == 0) put(primary_beam_, at, plane.primary_beam, {});
  }
  write_restored(at, plane, beam);
}

void CubeFiles::write_restored(const imager::PlaneIndex& at, const Plane& plane, const std::optional<imager::Beam>& beam) {
  const imager::Image* const brightness = restored_ ? plane.restored : plane.residual;
  imager::Image corrected;
  if (corrected_ && plane.primary_beam != nullptr && brightness != nullptr)
    corrected = imager::corrected(*brightness, *plane.primary_beam);
  const std::lock_guard lock(image_files_mutex());
  put(restored_, at, plane.restored, beam);
  put(corrected_, at, &corrected, beam);
}

void CubeFiles::add_cards(const std::vector<imager::HeaderCard>& cards) {
  for (const Writer* writer : {&psf_, &residual_, &model_, &mask_, &primary_beam_, &restored_, &corrected_})
    if (*writer) (*writer)->add_cards(cards);
}

void CubeFiles::finish(bool restored_follow) {
  for (const Writer* writer : {&psf_, &residual_, &model_, &mask_, &primary_beam_})
    if (*writer) (*writer)->finish();
  if (!restored_follow) finish_restored();
}

void CubeFiles::finish_restored() {
  for (const Writer* writer : {&restored_, &corrected_})
    if (*writer) (*writer)->finish();
}

}  // namespace misfit::tools
