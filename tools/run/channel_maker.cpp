#include "tools/run/channel_maker.h"

#include <optional>
#include <stdexcept>
#include <utility>

#include "tools/run/mosaic_stage.h"

namespace misfit::tools {

ChannelMaker::ChannelMaker(const ChannelScene& scene, ChannelMeans means, std::unique_ptr<CleanStage> clean)
    : scene_(scene), means_(std::move(means)) {
  if (!clean) return;
  cleans_.give_back(std::move(clean));
  for (int i = 1; i < means_.workers.count; ++i) cleans_.give_back(std::make_unique<CleanStage>(scene_.options, scene_.header));
}

std::unique_ptr<ChannelRun> ChannelMaker::image(int channel, std::unique_ptr<ChannelSamples> samples) {
  auto run = std::make_unique<ChannelRun>(scene_, channel, std::move(samples));
  if (!run->has_samples()) return run;
  try {
    if (common_weights_)
      run->weigh(common_weights_);
    else
      run->weigh();
    run->make_dirty(means_.plan, means_.transform);
  } catch (const imager::NothingInGrid& nothing) {
    if (scene_.whole_band) throw;
    run->made().outside_grid = nothing.outside_grid;
  } catch (const imager::NothingUsable&) {
    if (scene_.whole_band) throw;
  }
  return run;
}

void ChannelMaker::prepare_clean(ChannelRun& run) {
  if (run.made().empty()) return;
  run.make_terms();
  run.check_start();
  run.verify();
  const ImageOptions& o = scene_.options;
  if (o.primary_beam.wanted() && scene_.whole_band && means_.primary_beam != nullptr) {
    const imager::StageTimer timer(run.times(), imager::stage::primary_beam);
    means_.primary_beam->weigh(run.samples());
  }
  if (!means_.images_here) return;
  run.choose_beams();
  if (!o.clean.runs() || !run.report().beams->restoring) return;
  std::optional<imager::Image> primary_beam;
  if (run.mosaic_beam() != nullptr) {
    primary_beam = limited_beam(*run.mosaic_beam(), o.primary_beam);
  } else if (o.primary_beam.pbmask > 0 || (o.measures_noise_in_beam() && means_.primary_beam != nullptr)) {
    const imager::StageTimer timer(run.times(), imager::stage::primary_beam);
    primary_beam = means_.primary_beam->of_image(run.report().frequency_hz);
  }
  run.begin_clean(
      cleans_.take([]() -> std::unique_ptr<CleanStage> { throw std::logic_error("more channels at a time than workers"); }),
      primary_beam ? &*primary_beam : nullptr);
}

void ChannelMaker::clean(ChannelRun& run) {
  if (!scene_.options.clean.runs()) return;
  if (!means_.images_here) return run.follow_clean();
  if (!run.may_clean()) return;
  std::unique_ptr<CleanStage> stage = run.clean();
  if (!scene_.whole_band) cleans_.give_back(std::move(stage));
}

}  // namespace misfit::tools
