#include "tools/run/clean_stage.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "imager/clean/mask.h"
#include "imager/data/stokes.h"
#include "kernels/version.h"
#include "tools/base/interrupt.h"
#include "tools/base/numbers.h"
#include "tools/formats/clean_state_file.h"
#include "tools/formats/grid_offset.h"
#include "tools/formats/image_file.h"
#include "tools/formats/mask_file.h"
#include "tools/formats/model_image.h"
#include "tools/run/clean_options.h"

namespace misfit::tools {
namespace {

/// That of a round beam of the same area.
double mean_width_rad(const imager::Beam& beam) {
  return std::sqrt(beam.major_rad * beam.minor_rad);
}

}  // namespace

CleanStage::CleanStage(const ImageOptions& options, imager::ImageHeader image, int threads)
    : o_(options), image_(std::move(image)), threads_(threads) {
  if (!o_.startmodel.empty()) {
    start_file_ = open_image_file(o_.startmodel);
    refuse_taylor_term(*start_file_, o_.startmodel);
  }
  if (!o_.mask.empty()) mask_file_ = std::make_unique<MaskFile>(o_.mask, image_);
}

void CleanStage::begin_channel(int channel) {
  if (channel_ == channel) return;
  channel_ = channel;
  if (start_file_) read_start_model();
  if (!mask_file_ || (!masks_.empty() && mask_file_->one_for_all_channels())) return;
  masks_.clear();
  const int masks = mask_file_->one_for_all_stokes() ? 1 : static_cast<int>(image_.stokes.size());
  for (int stokes = 0; stokes < masks; ++stokes) masks_.push_back(mask_file_->mask({channel, stokes}));
}

std::vector<std::string> CleanStage::words_on_files() const {
  std::vector<std::string> words;
  if (mask_file_) words = mask_file_->doubts();
  if (start_file_) {
    words.push_back(band_warning(start_file_->header().observation, image_.observation, o_.startmodel));
    words.push_back(GridBeside(*start_file_, "start model " + o_.startmodel, image_).remark());
  }
  words.erase(std::remove(words.begin(), words.end(), ""), words.end());
  return words;
}

std::string CleanStage::closed_mask_warning() const {
  std::string closed;
  for (std::size_t m = 0; m < masks_.size(); ++m)
    if (imager::mask_is_empty(masks_[m])) closed += (closed.empty() ? "" : ", ") + stokes_name(image_.stokes[m]);
  if (closed.empty()) return "";
  return "the mask " + o_.mask + " allows no pixel of the image" +
         (masks_.size() > 1 ? " of " + closed + ", of which nothing is cleaned" : ": nothing is cleaned");
}

std::string CleanStage::missing_states_warning() const {
  std::string paths, names;
  for (std::size_t s = 0; o_.restart && s < image_.stokes.size(); ++s) {
    if (std::filesystem::exists(state_path(s))) continue;
    paths += (paths.empty() ? "" : ", ") + state_path(s);
    names += (names.empty() ? " of " : ", ") + stokes_name(image_.stokes[s]);
  }
  if (paths.empty()) return "";
  const std::string of_cube = "state" + (image_.stokes.size() > 1 ? names : "") + " in " + o_.imagename + ".clean";
  return "there is no " + (o_.cube.is_cube() ? of_cube : paths) + " to go on from: CLEAN begins anew";
}

std::vector<std::string> CleanStage::warnings() const {
  std::vector<std::string> words{closed_mask_warning(), missing_states_warning()};
  words.erase(std::remove(words.begin(), words.end(), ""), words.end());
  return words;
}

std::string CleanStage::state_path(std::size_t stokes) const {
  const std::string of = image_.stokes.size() > 1 ? "." + stokes_name(image_.stokes[stokes]) : "";
  if (!o_.cube.is_cube()) return o_.imagename + ".clean" + of + ".state";
  return o_.imagename + ".clean/" + std::to_string(channel_) + of + ".state";
}

void CleanStage::refuse_start_model(const std::string& has, const std::string& expected) const {
  throw std::runtime_error("start model " + o_.startmodel + " " + has + ", expected " + expected);
}

void CleanStage::read_start_model() {
  const imager::ImageGeometry &own = image_.geometry, &g = start_file_->header().geometry;
  const auto size = [](int width, int height) { return std::to_string(width) + " × " + std::to_string(height) + " pixels"; };
  if (g.width != own.width || g.height != own.height)
    refuse_start_model("has " + size(g.width, g.height), size(own.width, own.height));
  const GridBeside beside(*start_file_, "start model " + o_.startmodel, image_);
  const GridOffset offset = offset_between(beside.map(), own);
  // A start is put on the image's own pixels, about which its residual is then exact.
  if (!offset.any || offset.right != 0 || offset.up != 0 || !(offset.most < imager::same_place_pixels))
    refuse_start_model("has other pixels, " + described(beside.grid()),
                       "the image's, " + described(imager::grid_of(own)) + "; regrid it first, as with CASA's imregrid");
  const int channel = channel_for(*start_file_, "start model " + o_.startmodel, image_.spectral, channel_);
  std::vector<imager::SkyImage> planes = read_model_channel(*start_file_, {o_.startmodel, channel});
  start_model_.clear();
  for (const imager::Stokes wanted : image_.stokes) {
    const auto found = std::find_if(planes.begin(), planes.end(), [&](const auto& plane) { return plane.stokes == wanted; });
    if (found == planes.end())
      refuse_start_model("has no plane of " + stokes_name(wanted), "one of each in --stokes " + o_.stokes);
    start_model_.push_back(std::move(found->image));
  }
}

imager::CleanState CleanStage::begin(std::size_t stokes, const CleanStateOwner& owner) {
  imager::Image start;
  if (!start_model_.empty()) start = std::move(start_model_[stokes]);
  if (o_.restart && std::filesystem::exists(state_path(stokes))) return read_clean_state(state_path(stokes), owner);
  const std::filesystem::path state = state_path(stokes);
  if (o_.cube.is_cube()) std::filesystem::create_directories(state.parent_path());
  std::filesystem::remove(state);
  imager::ComponentModel model = owner.like;
  if (!start.pixel.empty()) model.add(imager::components_of(start));
  return imager::first_state(model);
}

std::uint64_t CleanStage::checksum_of(const CleanScene& scene) const {
  const imager::Image* const start = start_model_.empty() ? nullptr : &start_model_[scene.samples.index];
  std::vector<const imager::Image*> images{scene.dirty.front(), scene.psf.front(), mask(scene.samples.index), start};
  images.insert(images.end(), scene.dirty.begin() + 1, scene.dirty.end());
  images.insert(images.end(), scene.psf.begin() + 1, scene.psf.end());
  return checksum(images);
}

imager::CleanResult CleanStage::run(const CleanScene& scene, const nlohmann::json& option_values,
                                    const imager::CycleProgress& cycle_progress, const imager::Context& context) {
  imager::CleanOptions options = clean_options(o_, threads_);
  options.stop_requested = interrupted;
  options.mask = mask(scene.samples.index);
  std::unique_ptr<imager::MinorCycle> minor;
  {
    const imager::StageTimer timer(context.times, "minor cycles");
    minor = imager::make_deconvolver(deconvolver_choice(o_, threads_), scene.psf);
  }
  CleanStateOwner owner{MISFIT_VERSION,
                        option_values,
                        0,
                        scene.samples.source.ranks().size(),
                        {image_.geometry.width, image_.geometry.height, minor->scale_pixels()}};
  imager::CleanState state;
  double sidelobe = 0;
  {
    const imager::StageTimer timer(context.times, "CLEAN state");
    owner.checksum = checksum_of(scene);
    state = begin(scene.samples.index, owner);
    sidelobe = imager::largest_sidelobe(*scene.psf.front(), scene.main_lobe, image_.geometry.cell_rad, threads_);
  }
  const imager::CleanInput input{.samples = scene.samples,
                                 .transform = scene.transform,
                                 .expansion = scene.expansion,
                                 .dirty = scene.dirty,
                                 .psf = scene.psf,
                                 .max_sidelobe = sidelobe,
                                 .accuracy = std::max(o_.accuracy, scene.expected_error),
                                 .beam_fwhm_pixels = mean_width_rad(scene.main_lobe) / image_.geometry.cell_rad};
  const auto save = [&](const imager::CleanState& now) {
    const imager::StageTimer timer(context.times, "CLEAN state");
    write_clean_state(state_path(scene.samples.index), now, owner);
    cycle_progress(now);
  };
  return imager::clean(input, *minor, options, std::move(state), save, context);
}

}  // namespace misfit::tools
