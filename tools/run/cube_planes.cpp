#include "tools/run/cube_planes.h"

#include <algorithm>
#include <utility>

#include "tools/base/interrupt.h"
#include "tools/run/image_files.h"

namespace misfit::tools {

bool CubePlane::stopped() const {
  return std::any_of(report.stokes.begin(), report.stokes.end(),
                     [](const StokesReport& stokes) { return stokes.clean && stokes.clean->stop == imager::CleanStop::user; });
}

CubePlanes::CubePlanes(CubeScene scene)
    : scene_(std::move(scene)), products_(scene_.options, scene_.header, scene_.primary_beam, scene_.workers, scene_.open) {
  for (int i = 0; scene_.options.niter > 0 && i < scene_.workers.count; ++i)
    cleans_.give_back(std::make_unique<CleanStage>(scene_.options, scene_.header, scene_.workers.threads));
}

CubePlane CubePlanes::empty(int channel) const {
  CubePlane plane;
  plane.report.channel = channel;
  plane.report.frequency_hz = scene_.header.spectral.frequency_hz(channel);
  plane.report.stokes.clear();
  for (const imager::Stokes stokes : scene_.header.stokes) plane.report.stokes.push_back({.stokes = stokes});
  return plane;
}

CubePlane CubePlanes::make(int channel, imager::StreamedVisibilities& visibilities) {
  CubePlane plane = empty(channel);
  ProgressLine silent(true);  // planes tell of themselves; their stages would fill the screen
  const PlaneScene scene{
      scene_.options,
      scene_.header.geometry,
      scene_.header.stokes,
      scene_.reach,
      scene_.workers.threads,
      silent,
      plane.times,
      [&](const std::string& sentence) { plane.warnings.push_back(sentence); },
      [&] { return given_up_.load(); },
  };
  PlaneRun run(scene, visibilities, " of plane " + std::to_string(channel));
  run.report().channel = plane.report.channel;
  run.report().frequency_hz = plane.report.frequency_hz;
  try {
    make(run, plane);
  } catch (const imager::NothingInGrid& nothing) {
    plane.outside_grid = nothing.outside_grid;
    return plane;
  }
  plane.report = std::move(run.report());
  plane.outside_grid = plane.report.sums.outside_grid;
  return plane;
}

void CubePlanes::make(PlaneRun& run, CubePlane& plane) {
  if (common_weights_)
    run.weigh(common_weights_);
  else
    run.weigh();
  run.make_dirty(scene_.plan, scene_.transform);
  if (scene_.options.verify > 0) run.verify();
  run.choose_beams();
  if (scene_.options.niter > 0 && run.report().beams->restoring) clean(run, plane);
  if (const std::string doubt = products_.write(run); !doubt.empty()) plane.doubts.push_back(doubt);
}

void CubePlanes::clean(PlaneRun& run, CubePlane& plane) {
  const int channel = plane.report.channel;
  std::unique_ptr<CleanStage> stage =
      cleans_.take([]() -> std::unique_ptr<CleanStage> { throw std::logic_error("more planes at a time than workers"); });
  {
    const std::lock_guard lock(image_files_mutex());
    stage->begin_channel(channel);
  }
  plane.doubts = stage->warnings();
  run.clean(*stage, scene_.option_values, [&](std::size_t, const imager::CleanState& state) {
    if (state.cycles.size() > 1) ++plane.major_cycles;
  });
  for (const imager::CleanResult& result : run.cleaned()) plane.components += result.report.iterations;
  cleans_.give_back(std::move(stage));
}

}  // namespace misfit::tools
