#include "tools/run/cube_products.h"

#include <algorithm>
#include <utility>

#include "imager/beams/common_beam.h"
#include "imager/data/noise.h"
#include "imager/numerics/parallel.h"
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

/// What the report tells of the pixels of a plane.
void look_at(const imager::Image& residual, const imager::Image& image, StokesReport& told) {
  const double noise_jy = told.clean ? told.clean->final_state().rms_jy : imager::sampled_noise(residual);
  const imager::ImageStatistics of_residual = imager::statistics_of(residual);
  told.histogram = {.noise_jy = noise_jy, .min_jy = of_residual.least, .max_jy = of_residual.largest, .count = {}};
  told.brightest = &image == &residual ? imager::find_peak(image, of_residual) : imager::find_peak(image);
}

}  // namespace

/// What was written of a plane of a cube.
struct CubeProducts::Written {
  std::unique_ptr<imager::ImageReader> models;
  std::unique_ptr<imager::ImageReader> residuals;
};

CubeProducts::CubeProducts(const ImageOptions& options, const imager::ImageHeader& header, const PrimaryBeamStage* primary_beam,
                           const PlaneWorkers& workers, const CubeFiles::Open& open)
    : o_(options),
      header_(header),
      files_(options, header, has_mask(options), open),
      primary_beam_(primary_beam),
      workers_(workers),
      in_common_(options.niter > 0 && options.restoringbeam == "common") {}

std::string CubeProducts::write(PlaneRun& plane) {
  imager::StageTimes& times = plane.scene().times;
  {
    const imager::StageTimer timer(times, "write images");
    files_.write_psf(plane.report().channel, plane.made().images.psf, plane.report().beams->restoring);
  }
  imager::Image primary_beam;
  if (primary_beam_ != nullptr) {
    const imager::StageTimer timer(times, "primary beam");
    primary_beam = primary_beam_->at(plane.report().frequency_hz);
  }
  for (std::size_t s = 0; s < header_.stokes.size(); ++s) write(s, primary_beam, plane);
  return primary_beam_ == nullptr ? "" : primary_beam_->warning_of(primary_beam);
}

void CubeProducts::write(std::size_t stokes, const imager::Image& primary_beam, PlaneRun& plane) {
  imager::StageTimes& times = plane.scene().times;
  const std::optional<imager::Beam>& beam = plane.report().beams->restoring;
  const imager::CleanResult* const result = plane.cleaned().empty() ? nullptr : &plane.cleaned()[stokes];
  const imager::Image& residual = result != nullptr ? result->residual : plane.made().images.dirty[stokes];
  imager::Image restored;
  if (result != nullptr && !in_common_) {
    const imager::StageTimer timer(times, "restore");
    restored = restore(result->model, residual, *beam);
  }
  {
    const imager::StageTimer timer(times, "statistics");
    look_at(residual, restored.pixel.empty() ? residual : restored, plane.report().stokes[stokes]);
  }
  CubeFiles::Plane written{
      .residual = &residual, .restored = unless_empty(restored), .primary_beam = unless_empty(primary_beam)};
  if (result != nullptr) {
    written.model = &result->model;
    written.mask = &result->mask;
  }
  const imager::StageTimer timer(times, "write images");
  files_.write({plane.report().channel, static_cast<int>(stokes)}, written, beam);
}

std::vector<std::string> CubeProducts::finish(std::vector<PlaneReport>& planes, const std::vector<imager::HeaderCard>& cards,
                                              imager::StageTimes& times) {
  std::vector<std::string> removed;
  {
    const imager::StageTimer timer(times, "write images");
    remove_other_images(o_, files_.paths(), removed);
    remove_left_over_of_cube(o_, header_.spectral.channels, removed);
    files_.add_cards(cards);
    files_.finish(in_common_);
  }
  if (!in_common_) return removed;
  const imager::StageTimer timer(times, "restore");
  restore_in_common(planes);
  files_.finish_restored();
  return removed;
}

imager::Image CubeProducts::restore(const imager::Image& model, const imager::Image& residual, const imager::Beam& beam) const {
  return imager::restored({model, residual}, beam, header_.geometry.cell_rad, workers_.threads);
}

/// Of models and residuals as they were written.
void CubeProducts::restore_in_common(std::vector<PlaneReport>& planes) {
  std::vector<imager::Beam> beams;
  for (const PlaneReport& plane : planes)
    if (cleaned(plane)) beams.push_back(*plane.beams->restoring);
  if (beams.empty()) return;
  const imager::Beam common = imager::common_beam(beams);
  const Written written{open_written(o_, "model"), open_written(o_, "residual")};
  imager::parallel_for(planes.size(), workers_.count, [&](std::size_t i) {
    if (cleaned(planes[i])) restore_plane(planes[i], common, written);
  });
}

void CubeProducts::restore_plane(PlaneReport& plane, const imager::Beam& common, const Written& written) {
  plane.beams->restoring = common;
  plane.beams->how = "common to all planes";
  imager::Image primary_beam;
  if (primary_beam_ != nullptr) primary_beam = primary_beam_->at(plane.frequency_hz);
  const auto read = [](const imager::ImageReader& file, const imager::PlaneIndex& at) {
    const std::lock_guard lock(image_files_mutex());
    return file.read(at);
  };
  for (std::size_t s = 0; s < header_.stokes.size(); ++s) {
    const imager::PlaneIndex at{plane.channel, static_cast<int>(s)};
    const imager::Image restored = restore(read(*written.models, at), read(*written.residuals, at), common);
    plane.stokes[s].brightest = imager::find_peak(restored);
    files_.write_restored(at, {.restored = &restored, .primary_beam = unless_empty(primary_beam)}, common);
  }
}

}  // namespace misfit::tools
