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
#include "tools/formats/mask_file.h"
#include "tools/run/clean_options.h"

namespace misfit::tools {

CleanStage::CleanStage(const ImageOptions& options, imager::ImageHeader image) : o_(options), image_(std::move(image)) {
  if (!o_.clean.startmodel.empty()) start_model_ = std::make_unique<StartModel>(o_, image_);
  for (const std::string& mask : o_.clean.mask) mask_files_.push_back(std::make_unique<MaskFile>(mask, image_));
}

void CleanStage::begin_channel(int channel) {
  if (channel_ == channel) return;
  channel_ = channel;
  limited_.clear();
  noise_within_ = {};
  if (start_model_) start_model_->read(channel);
  const auto all = [&](bool (MaskFile::*is)() const) {
    return std::all_of(mask_files_.begin(), mask_files_.end(), [is](const auto& file) { return (*file.*is)(); });
  };
  if (mask_files_.empty() || (!masks_.empty() && all(&MaskFile::one_for_all_channels))) return;
  masks_.clear();
  const int masks = all(&MaskFile::one_for_all_stokes) ? 1 : static_cast<int>(image_.stokes.size());
  for (int stokes = 0; stokes < masks; ++stokes) masks_.push_back(mask_of_files({channel, stokes}));
}

/// A mask that allows what any of the files does.
imager::Image CleanStage::mask_of_files(const imager::PlaneIndex& at) const {
  imager::Image mask = mask_files_.front()->mask(at);
  for (std::size_t file = 1; file < mask_files_.size(); ++file) {
    const imager::Image other = mask_files_[file]->mask(at);
    for (std::size_t i = 0; i < mask.pixel.size(); ++i)
      if (imager::mask_allows(other.pixel[i])) mask.pixel[i] = 1;
  }
  return mask;
}

void CleanStage::keep_within(const imager::Image& primary_beam) {
  if (o_.measures_noise_in_beam()) {
    const double least = std::max(o_.primary_beam.pbmask, o_.primary_beam.limit());
    noise_within_ = primary_beam;
    for (double& pixel : noise_within_.pixel) pixel = pixel >= least ? 1 : 0;
  }
  const double pbmask = std::max(o_.primary_beam.pbmask, o_.mosaic_limit());
  if (pbmask == 0) return;
  limited_ = masks_;
  if (limited_.empty()) {
    limited_.emplace_back(primary_beam.width, primary_beam.height);
    std::fill(limited_.front().pixel.begin(), limited_.front().pixel.end(), 1);
  }
  for (imager::Image& mask : limited_)
    for (std::size_t i = 0; i < mask.pixel.size(); ++i)
      if (!(primary_beam.pixel[i] >= pbmask)) mask.pixel[i] = 0;
}

std::vector<std::string> CleanStage::words_on_files() const {
  std::vector<std::string> words;
  for (const auto& file : mask_files_)
    for (std::string& doubt : file->doubts()) words.push_back(std::move(doubt));
  if (start_model_)
    for (std::string& remark : start_model_->remarks()) words.push_back(std::move(remark));
  words.erase(std::remove(words.begin(), words.end(), ""), words.end());
  return words;
}

std::string CleanStage::closed_mask_warning() const {
  const std::vector<imager::Image>& masks = limited_.empty() ? masks_ : limited_;
  std::string closed;
  for (std::size_t m = 0; m < masks.size(); ++m)
    if (imager::mask_is_empty(masks[m])) closed += (closed.empty() ? "" : ", ") + stokes_name(image_.stokes[m]);
  if (closed.empty()) return "";
  const bool by_limit = o_.mosaic_limit() > o_.primary_beam.pbmask;
  const std::string least =
      by_limit ? "--pblimit " + significant(o_.mosaic_limit(), 3) : "--pbmask " + significant(o_.primary_beam.pbmask, 3);
  const std::string limit = limited_.empty() ? "" : least;
  const std::string what =
      o_.clean.mask.empty() ? limit : "the mask " + names_of(o_.clean.mask) + (limit.empty() ? "" : " with " + limit);
  return what + " allows no pixel of the image" +
         (masks.size() > 1 ? " of " + closed + ", of which nothing is cleaned" : ": nothing is cleaned");
}

std::string CleanStage::missing_states_warning() const {
  std::string paths, names;
  for (std::size_t s = 0; o_.clean.restart && s < image_.stokes.size(); ++s) {
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

imager::CleanState CleanStage::begin(std::size_t stokes, const CleanStateOwner& owner) {
  std::vector<imager::Component> start;
  if (start_model_) start = start_model_->take(stokes);
  words_on_state_.clear();
  if (o_.clean.restart && std::filesystem::exists(state_path(stokes))) {
    ReadCleanState read = read_clean_state(state_path(stokes), owner);
    for (const std::string& name : read.changed) words_on_state_ += (words_on_state_.empty() ? "--" : ", --") + name;
    if (!read.changed.empty()) words_on_state_ = "CLEAN goes on from its model with another " + words_on_state_;
    return std::move(read.state);
  }
  const std::filesystem::path state = state_path(stokes);
  if (o_.cube.is_cube()) std::filesystem::create_directories(state.parent_path());
  imager::ComponentModel model = owner.like;
  model.add(start);
  return imager::first_state(model);
}

std::uint64_t CleanStage::checksum_of(const CleanScene& scene) const {
  std::vector<const imager::Image*> images{&scene.dirty.front(), scene.psf.front()};
  if (start_model_)
    for (const imager::Image* term : start_model_->images(scene.imaged.samples.index)) images.push_back(term);
  for (std::size_t t = 1; t < scene.dirty.size(); ++t) images.push_back(&scene.dirty[t]);
  images.insert(images.end(), scene.psf.begin() + 1, scene.psf.end());
  return checksum(images);
}

imager::CleanResult CleanStage::run(CleanScene scene, const StateOptionValues& option_values,
                                    const imager::CycleProgress& cycle_progress, const imager::Context& context) {
  imager::CleanOptions options = clean_options(o_.clean, context.threads);
  options.stop_requested = interrupted;
  options.mask = mask(scene.imaged.samples.index);
  options.noise_within = noise_within_.pixel.empty() ? nullptr : &noise_within_;
  if (const imager::MosaicView* const view = scene.imaged.normalisation.mosaic(); start_model_ && view != nullptr)
    start_model_->see_through(*view, scene.imaged.samples.index);
  std::unique_ptr<imager::MinorCycle> minor;
  {
    const imager::StageTimer timer(context.times, imager::stage::minor_cycles);
    minor = imager::make_deconvolver(deconvolver_choice(o_.clean, context.threads), scene.psf);
  }
  CleanStateOwner owner{MISFIT_VERSION,
                        option_values.owners,
                        0,
                        scene.imaged.samples.source.ranks().size(),
                        {image_.geometry.width, image_.geometry.height, minor->scale_pixels()},
                        option_values.ways,
                        0};
  imager::CleanState state;
  double sidelobe = 0;
  {
    const imager::StageTimer timer(context.times, imager::stage::clean_state);
    owner.checksum = checksum_of(scene);
    owner.ways_checksum = checksum({options.mask, options.noise_within});
    state = begin(scene.imaged.samples.index, owner);
    sidelobe = imager::largest_sidelobe(*scene.psf.front(), scene.main_lobe, image_.geometry.cell_rad, context.threads);
  }
  imager::CleanInput input{.imaged = scene.imaged,
                           .expansion = scene.expansion,
                           .dirty = std::move(scene.dirty),
                           .dirty_accuracy = scene.dirty_accuracy,
                           .of_start = scene.of_start,
                           .psf = scene.psf,
                           .max_sidelobe = sidelobe,
                           .same_sidelobes = scene.same_sidelobes,
                           .coarser = scene.coarser,
                           .data_jy = scene.data_jy,
                           .accuracy = std::max(o_.gridding.accuracy, scene.expected_error),
                           .beam = scene.main_lobe,
                           .cell_rad = image_.geometry.cell_rad};
  const auto save = [&](const imager::CleanState& now) {
    const imager::StageTimer timer(context.times, imager::stage::clean_state);
    if (o_.taken.calcres) write_clean_state(state_path(scene.imaged.samples.index), now, owner);
    cycle_progress(now);
  };
  return imager::clean(std::move(input), *minor, options, std::move(state), save, context);
}

}  // namespace misfit::tools
