#include "tools/run/clean_stage.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "imager/clean/mask.h"
#include "tools/base/interrupt.h"
#include "tools/base/numbers.h"
#include "tools/formats/clean_state_file.h"
#include "tools/formats/mask_file.h"
#include "tools/formats/model_image.h"
#include "tools/version.h"

namespace misfit::tools {
namespace {

/// That of a round beam of the same area.
double mean_width_rad(const imager::Beam& beam) {
  return std::sqrt(beam.major_rad * beam.minor_rad);
}

}  // namespace

CleanStage::CleanStage(const ImageOptions& options, const imager::ImageGeometry& geometry, int threads)
    : o_(options), geometry_(geometry), threads_(threads) {
  if (!o_.startmodel.empty()) read_start_model();
  if (!o_.mask.empty()) mask_ = std::make_unique<imager::Image>(read_mask(o_.mask, geometry_));
}

std::string CleanStage::warning() const {
  if (mask_ != nullptr && imager::mask_is_empty(*mask_))
    return "the mask " + o_.mask + " allows no pixel of the image: nothing is cleaned";
  if (o_.restart && !std::filesystem::exists(state_path()))
    return "there is no " + state_path() + " to go on from: CLEAN begins anew";
  return "";
}

void CleanStage::read_start_model() {
  imager::SkyImage model = read_model(o_.startmodel, geometry_.phase_centre);
  const imager::ImageGeometry& g = model.geometry;
  const double cell_off = std::abs(g.cell_rad / geometry_.cell_rad - 1) * std::max(g.width, g.height);
  const auto size = [](int width, int height) { return std::to_string(width) + " × " + std::to_string(height) + " pixels"; };
  const auto refuse = [this](const std::string& has, const std::string& expected) {
    throw std::runtime_error("start model " + o_.startmodel + " " + has + ", expected " + expected);
  };
  if (g.width != geometry_.width || g.height != geometry_.height)
    refuse("has " + size(g.width, g.height), size(geometry_.width, geometry_.height));
  if (!(cell_off < 1e-3)) refuse("has pixels of " + significant(g.cell_rad * 180 / M_PI * 3600, 6) + "arcsec", o_.cell);
  if (g.off_phase_centre()) refuse("has its phase centre off the middle pixel", "it there");
  start_model_ = std::make_unique<imager::Image>(std::move(model.image));
}

double CleanStage::max_sidelobe(const CleanScene& scene) const {
  imager::Image point(geometry_.width, geometry_.height);
  point.at(geometry_.centre_row(), geometry_.centre_column()) = 1;
  const imager::Image beam = imager::convolve_with_beam(point, scene.main_lobe, geometry_.cell_rad, threads_);
  return imager::largest_sidelobe(scene.images.psf, beam);
}

imager::CleanState CleanStage::begin(const imager::MinorCycle& minor, const CleanStateOwner& owner) {
  const std::unique_ptr<imager::Image> start = std::move(start_model_);
  if (o_.restart && std::filesystem::exists(state_path())) return read_clean_state(state_path(), owner);
  std::filesystem::remove(state_path());
  imager::ComponentModel model(geometry_.width, geometry_.height, minor.scale_pixels());
  if (start) model.add(imager::components_of(*start));
  return imager::first_state(model);
}

imager::CleanResult CleanStage::run(const CleanScene& scene, const nlohmann::json& option_values,
                                    const imager::Progress& progress, const imager::CycleProgress& cycle_progress,
                                    imager::StageTimes& times) {
  imager::CleanOptions options = clean_options(o_, threads_);
  options.stop_requested = interrupted;
  options.mask = mask_.get();
  std::unique_ptr<imager::MinorCycle> minor;
  {
    const imager::StageTimer timer(times, "minor cycles");
    minor = imager::make_deconvolver(deconvolver_choice(o_, threads_), scene.images.psf);
  }
  CleanStateOwner owner{version, option_values, 0};
  imager::CleanState state;
  double sidelobe = 0;
  {
    const imager::StageTimer timer(times, "CLEAN state");
    owner.checksum = checksum({&scene.images.dirty.front(), &scene.images.psf, mask_.get(), start_model_.get()});
    state = begin(*minor, owner);
    sidelobe = max_sidelobe(scene);
  }
  const imager::CleanInput input{scene.source,
                                 scene.transform,
                                 scene.images.dirty.front(),
                                 scene.images.psf,
                                 sidelobe,
                                 std::max(o_.accuracy, scene.expected_error),
                                 mean_width_rad(scene.main_lobe) / geometry_.cell_rad};
  return imager::clean(
      input, *minor, options, std::move(state), progress,
      [&](const imager::CleanState& now) {
        const imager::StageTimer timer(times, "CLEAN state");
        write_clean_state(state_path(), now, owner);
        cycle_progress(now);
      },
      times);
}

}  // namespace misfit::tools
