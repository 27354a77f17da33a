#include "tools/run/cube_products.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "imager/common_beam.h"
#include "imager/noise.h"
#include "tools/run/cube_pictures.h"
#include "tools/run/image_files.h"
#include "tools/run/left_over.h"

namespace misfit::tools {
namespace {

/// Whether a mask is to be written: one that the user has under its name stays.
bool has_mask(const ImageOptions& o) {
  const std::vector<std::string> paths = image_paths(o.imagename + ".mask", o.outformat);
  const bool kept = std::any_of(paths.begin(), paths.end(), [&](const std::string& path) { return is_input(o, path); });
  return o.niter > 0 && (o.usemask == "auto" || !o.mask.empty()) && !kept;
}

/// Whether it holds what CLEAN made.
bool cleaned(const PlaneReport& plane) {
  return plane.stokes.front().clean.has_value();
}

/// Null where it has no pixels.
const imager::Image* unless_empty(const imager::Image& image) {
  return image.pixel.empty() ? nullptr : &image;
}

}  // namespace

CubeProducts::CubeProducts(const PlaneScene& scene, const imager::ImageHeader& header, const PrimaryBeamStage* primary_beam)
    : scene_(scene),
      axis_(header.spectral),
      files_(scene.options, header, has_mask(scene.options)),
      primary_beam_(primary_beam),
      in_common_(scene.options.niter > 0 && scene.options.restoringbeam == "common") {}

void CubeProducts::write(int channel, PlaneRun& plane) {
  const std::optional<imager::Beam>& beam = plane.report().beams->restoring;
  const imager::DirtyImages& images = plane.made().images;
  {
    const imager::StageTimer timer(scene_.times, "write images");
    files_.write_psf(channel, images.psf, beam);
  }
  const imager::Image primary_beam = primary_beam_at(axis_.frequency_hz(channel));
  for (std::size_t s = 0; s < scene_.stokes.size(); ++s) {
    const imager::PlaneIndex at{channel, static_cast<int>(s)};
    const imager::CleanResult* const result = plane.cleaned().empty() ? nullptr : &plane.cleaned()[s];
    const imager::Image& residual = result != nullptr ? result->residual : images.dirty[s];
    imager::Image restored;
    if (result != nullptr && !in_common_) {
      const imager::StageTimer timer(scene_.times, "restore");
      restored = restore(result->model, residual, *beam);
    }
    look_at(at, residual, restored.pixel.empty() ? residual : restored, plane.report());
    CubeFiles::Plane written{
        .residual = &residual, .restored = unless_empty(restored), .primary_beam = unless_empty(primary_beam)};
    if (result != nullptr) {
      written.model = &result->model;
      written.mask = &result->mask;
    }
    const imager::StageTimer timer(scene_.times, "write images");
    files_.write(at, written, beam);
  }
}

std::vector<std::string> CubeProducts::finish(std::vector<PlaneReport>& planes, const std::vector<imager::HeaderCard>& cards) {
  std::vector<std::string> removed;
  {
    const imager::StageTimer timer(scene_.times, "write images");
    remove_other_images(scene_.options, files_.paths(), removed);
    remove_left_over_of_cube(scene_.options, axis_.channels, removed);
    files_.add_cards(cards);
    files_.finish(in_common_);
  }
  if (in_common_) restore_in_common(planes);
  return removed;
}

/// Without pixels where none is wanted.
imager::Image CubeProducts::primary_beam_at(double frequency_hz) {
  if (primary_beam_ == nullptr) return {};
  const imager::StageTimer timer(scene_.times, "primary beam");
  imager::Image beam = primary_beam_->at(frequency_hz);
  if (const std::string warning = primary_beam_->warning_of(beam); !warning.empty() && !std::exchange(unseen_, true))
    scene_.warn(warning);
  return beam;
}

imager::Image CubeProducts::restore(const imager::Image& model, const imager::Image& residual, const imager::Beam& beam) const {
  return imager::restored({model, residual}, beam, scene_.geometry.cell_rad, scene_.threads);
}

/// What the report tells of a plane.
void CubeProducts::look_at(const imager::PlaneIndex& at, const imager::Image& residual, const imager::Image& image,
                           PlaneReport& plane) const {
  const imager::StageTimer timer(scene_.times, "statistics");
  StokesReport& told = plane.stokes[static_cast<std::size_t>(at.stokes)];
  const double noise_jy = told.clean ? told.clean->final_state().rms_jy : imager::sampled_noise(residual);
  const imager::ImageStatistics of_residual = imager::statistics_of(residual);
  told.histogram = {.noise_jy = noise_jy, .min_jy = of_residual.least, .max_jy = of_residual.largest, .count = {}};
  told.brightest = &image == &residual ? imager::find_peak(image, of_residual) : imager::find_peak(image);
}

/// Of models and residuals as they were written.
void CubeProducts::restore_in_common(std::vector<PlaneReport>& planes) {
  const imager::StageTimer timer(scene_.times, "restore");
  std::vector<imager::Beam> beams;
  for (const PlaneReport& plane : planes)
    if (cleaned(plane)) beams.push_back(*plane.beams->restoring);
  if (beams.empty()) return files_.finish_restored();
  const imager::Beam common = imager::common_beam(beams);
  const auto models = open_written(scene_.options, "model"), residuals = open_written(scene_.options, "residual");
  for (PlaneReport& plane : planes) {
    if (!cleaned(plane)) continue;
    plane.beams->restoring = common;
    plane.beams->how = "common to all planes";
    const imager::Image primary_beam = primary_beam_at(plane.frequency_hz);
    for (std::size_t s = 0; s < scene_.stokes.size(); ++s) {
      const imager::PlaneIndex at{plane.channel, static_cast<int>(s)};
      const imager::Image restored = restore(models->read(at), residuals->read(at), common);
      plane.stokes[s].brightest = imager::find_peak(restored);
      files_.write_restored(at, {.restored = &restored, .primary_beam = unless_empty(primary_beam)}, common);
    }
  }
  files_.finish_restored();
}

}  // namespace misfit::tools
