#include "imager/plan/mosaic_plan.h"

#include <algorithm>
#include <set>
#include <stdexcept>
#include <utility>

#include "imager/numerics/constants.h"
#include "imager/plan/plan_text_internal.h"
#include "imager/plan/planned_transform.h"
#include "imager/pointing/mosaic_transform.h"
#include "imager/wide/facet.h"

namespace misfit::imager {
namespace {

/// The windows of all pointings and pairs of dishes.
struct AllWindows {
  std::size_t windows = 0;
  std::size_t unseeing = 0;
  ImageGeometry largest;
  ImageGeometry most_curved;  ///< the one over which n − 1 strays farthest from a plane,
  double reach = 0;           ///< and by how much
};

AllWindows all_windows(const MosaicBeams& beams) {
  std::set<Pattern> patterns(beams.rows().of_antennas().begin(), beams.rows().of_antennas().end());
  patterns.erase(nullptr);
  AllWindows all;
  for (const AxisFrame& frame : beams.rows().of_fields()) {
    bool sees = false;
    for (auto one = patterns.begin(); one != patterns.end(); ++one)
      for (auto other = one; other != patterns.end(); ++other) {
        const std::optional<Window> window = beams.window({*one, *other, frame, 0});
        if (!window) continue;
        const Facet plane = split_into_facets(window->geometry, 1, 1).front();
        if (plane.empty) continue;
        sees = true;
        ++all.windows;
        if (window->geometry.pixels() > all.largest.pixels()) all.largest = window->geometry;
        if (plane.reach < all.reach) continue;
        all.reach = plane.reach;
        all.most_curved = window->geometry;
      }
    if (!sees) ++all.unseeing;
  }
  if (all.windows == 0)
    throw std::invalid_argument("no pointing sees any pixel of the image; expected an image where the antennas pointed");
  return all;
}

/// What is asked of the transform of a window.
GriddingRequest window_request(const GriddingRequest& request, const WindowsPlan& windows) {
  GriddingRequest of_window = request;
  of_window.mosaic = nullptr;
  of_window.psf = false;
  of_window.psf_accuracy = 0;
  of_window.samples = std::max<std::uint64_t>(1, request.samples / windows.windows);
  const auto images = static_cast<std::size_t>(request.stokes) + (request.psf ? 1 : 0);
  of_window.stokes = static_cast<int>(std::clamp<std::size_t>(windows.nodes * images, 1, most_stokes));
  of_window.samples_at_once = std::max<std::size_t>(std::size_t{1} << 16, request.samples_at_once / windows.windows);
  return of_window;
}

std::string angle(double rad) {
  constexpr double arcmin = pi / 180 / 60;
  return text("%.3g", rad / arcmin) + " arcmin";
}

/// Bytes that a window holds while others are gridded: its grids; where w has planes, samples that wait for them, and images.
double held_bytes(const GriddingPlan& of_window) {
  const TransformMemory memory = memory_of(of_window);
  if (!of_window.options.has_w_axis()) return memory.visibilities + memory.psf + memory.other_stokes;
  const GriddingRequest& r = of_window.request;
  const auto samples = static_cast<double>(std::min<std::uint64_t>(r.samples, r.samples_at_once));
  const double pixels = static_cast<double>(r.geometry.pixels()), images = r.stokes;
  return samples * (wide_bytes_a_sample + images * wide_bytes_a_value) + images * pixels * sizeof(double);
}

/// As many as take twice the bytes that planes of w may.
std::size_t windows_at_once(const WindowsPlan& windows, const GriddingRequest& request) {
  const double bytes = held_bytes(*windows.of_window);
  const double most = 2 * static_cast<double>(request.stack_bytes) / std::max(bytes, 1.0);
  return std::clamp<std::size_t>(static_cast<std::size_t>(std::min(most, 1e9)), 1, windows.windows * windows.spans);
}

/// Over how much of the sky a window reaches, and by how much of it its samples are gridded.
Plan decisions_of(const GriddingPlan& plan, const AllWindows& all) {
  const GriddingRequest& r = plan.request;
  const MosaicBeams& beams = *r.mosaic->beams;
  const WindowsPlan& w = *plan.windows;
  const double part = static_cast<double>(all.largest.pixels()) / static_cast<double>(r.geometry.pixels());
  Plan decisions = {
      {"mosaic", std::to_string(w.windows) + (w.windows == 1 ? " window" : " windows") + " of pointings and pairs of dishes",
       "each of its samples is gridded on what its beam sees alone, at most " + std::to_string(all.largest.width) + " × " +
           std::to_string(all.largest.height) + " pixels, " + text("%.3g", 100 * part) + "% of the image"},
      {"beams",
       "cut off where main lobes fall to " + text("%.3g", beams.cut()) + ", or before their formula ends, at most " +
           angle(std::asin(beams.largest_reach())) + " from their axes",
       "so the image is defined; a source of 1 Jy at the cut leaves " + text("%.3g", beams.cut()) + " Jy in its pointing"},
      {"beams between frequencies",
       std::to_string(w.spans) + (w.spans == 1 ? " span" : " spans") + " of at most " + std::to_string(w.nodes) +
           (w.nodes == 1 ? " beam" : " beams"),
       "from which all channels follow to " + text("%.1g", beams.tolerance()) +
           " of the peak; each sample is gridded for each"}};
  decisions.push_back({"a pointing", text("%.2g", static_cast<double>(w.nodes) * plan.choice.best.cost_s) + " s of a core",
                       "for a pass over its " + text("%.2g", static_cast<double>(w.of_window->request.samples)) +
                           " samples, by counts of operations"});
  if (w.unseeing > 0)
    decisions.push_back({"pointings left out", std::to_string(w.unseeing), "their beams see no pixel of the image"});
  if (w.on_planes && r.max_abs_w > 0)
    decisions.push_back({"w over windows", "left out beside a plane",
                         "the plane closest to n − 1 over a window leaves " + text("%.2g", w.phase_part) +
                             " of the phase that w makes over the image"});
  return decisions;
}

}  // namespace

GriddingPlan plan_mosaic(const GriddingRequest& request) {
  const MosaicBeams& beams = *request.mosaic->beams;
  const AllWindows all = all_windows(beams);
  WindowsPlan windows;
  windows.windows = all.windows;
  windows.unseeing = all.unseeing;
  windows.spans = beams.all_spans();
  windows.nodes = beams.most_nodes();
  GriddingRequest of_window = window_request(request, windows);
  of_window.geometry = all.largest;
  of_window.geometry.centre = {};
  of_window.max_abs_w = request.max_abs_w * std::min(1.0, all.reach / largest_drop(of_window.geometry));
  GriddingPlan plan = plan_gridding(of_window);
  windows.on_planes = !plan.direct && !plan.options.has_w_axis();
  if (!windows.on_planes) {
    of_window.geometry = all.most_curved;
    of_window.max_abs_w = request.max_abs_w;
    plan = plan_gridding(of_window);
  }
  windows.phase_part = std::min(1.0, all.reach / largest_drop(request.geometry));
  windows.of_window = std::make_shared<const GriddingPlan>(plan);
  plan.request = request;
  plan.direct = false;
  plan.direct_pixels = 0;
  plan.windows = std::make_shared<const WindowsPlan>(std::move(windows));
  Plan decisions = decisions_of(plan, all);
  for (Decision& of_one : plan.decisions) decisions.push_back(std::move(of_one));
  plan.decisions = std::move(decisions);
  return plan;
}

TransformMemory memory_of(const WindowsPlan& windows, const GriddingRequest& request) {
  TransformMemory memory = memory_of(*windows.of_window);
  const auto held = static_cast<double>(windows_at_once(windows, request));
  const double images = 3 * static_cast<double>(request.geometry.pixels()) * sizeof(double);
  const bool planes = windows.of_window->options.has_w_axis();
  memory.visibilities =
      held * held_bytes(*windows.of_window) + images + (planes ? memory.visibilities + memory.psf + memory.other_stokes : 0);
  memory.psf = memory.other_stokes = 0;
  return memory;
}

std::unique_ptr<Transform> make_mosaic_transform(const GriddingPlan& plan) {
  const MosaicRequest& mosaic = *plan.request.mosaic;
  const std::shared_ptr<const GriddingPlan> of_window = plan.windows->of_window;
  const auto make = [of_window](const ImageGeometry& geometry) {
    GriddingPlan of = *of_window;
    of.options.geometry = of.request.geometry = geometry;
    return std::make_shared<const PlannedTransform>(of);
  };
  const std::size_t at_once = plan.options.has_w_axis() ? plan.request.samples_at_once : 0;
  return std::make_unique<MosaicTransform>(
      mosaic.beams, WindowTransforms{make, plan.windows->on_planes},
      MosaicOptions{mosaic.psf_row, mosaic.psf_column, mosaic.flat_noise, windows_at_once(*plan.windows, plan.request), at_once,
                    plan.options.threads});
}

}  // namespace misfit::imager
