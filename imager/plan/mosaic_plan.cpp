#include "imager/plan/mosaic_plan.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <set>
#include <stdexcept>
#include <utility>

#include "imager/numerics/constants.h"
#include "imager/plan/cost_model.h"
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
  of_window.stokes = std::clamp(request.stokes + (request.psf ? 1 : 0), 1, static_cast<int>(most_stokes));
  of_window.samples =
      std::max<std::uint64_t>(1, static_cast<std::uint64_t>(static_cast<double>(request.samples) / windows.transforms()));
  constexpr std::size_t shares = 8;  // however many threads there are: by it sums are split
  of_window.stack_bytes = request.stack_bytes / shares;
  return of_window;
}

/// A window's plan: of that over which w matters most.
GriddingPlan plan_window(GriddingRequest request, const AllWindows& all) {
  request.geometry = all.most_curved;
  GriddingPlan plan = plan_gridding(request);
  if (!plan.leaves_w_out() || request.max_abs_w == 0) return plan;
  request.gridder = Gridder::wide;  // in other windows there may be more of it
  return plan_gridding(request);
}

/// Leaves out terms that count for too little. Returns the RMS of what these make.
double leave_out_small(double accuracy, std::vector<double>& sizes) {
  constexpr double part = 0.03;
  double left = 0;
  for (; sizes.size() > 1 && sizes.back() < part * accuracy; sizes.pop_back()) left = std::hypot(left, sizes.back());
  return left;
}

/// Plans for each term. What a term is transformed wrongly by counts as it is large; errors of terms, whose kernels differ, add
/// up by their squares. Each term may take half of the squared error that is left, the last all of it.
std::vector<std::shared_ptr<const GriddingPlan>> plan_terms(const GriddingRequest& request, std::vector<double> sizes,
                                                            const AllWindows& all) {
  constexpr double first_part = 0.8;
  constexpr double coarsest = 0.1;
  leave_out_small(request.accuracy, sizes);
  if (sizes.size() == 1) return {std::make_shared<const GriddingPlan>(plan_window(request, all))};
  std::vector<std::shared_ptr<const GriddingPlan>> plans;
  double left = 1;  // of the squared error
  for (std::size_t k = 0; k < sizes.size(); ++k) {
    GriddingRequest of_term = request;
    of_term.best_effort = true;
    const double part = std::sqrt(k == 0 ? first_part : k + 1 < sizes.size() ? left / 2 : left);
    const double size = k == 0 ? 1 : std::min(1.0, sizes[k]);
    of_term.accuracy = std::min(std::max(coarsest, request.accuracy), part * request.accuracy / size);
    if (k == 0) of_term.single_from *= part;
    GriddingPlan plan = plan_window(of_term, all);
    // The first term may take all of an accuracy that is nearly out of reach.
    if (k == 0 && !plan.direct && !plan.choice.reached) plan = plan_window(request, all);
    if (request.accuracy > 0) left = std::max(0.0, left - std::pow(size * plan.worst_error / request.accuracy, 2));
    if (k == 0 && left < 1 - first_part) left = 1 - first_part;  // it hardly reaches what is asked
    plans.push_back(std::make_shared<const GriddingPlan>(std::move(plan)));
  }
  return plans;
}

/// Plans one transform of all curved terms. It errs as that of one image would, since its errors are of what all terms add up
/// to, and terms themselves leave something. Returns whether there are such terms, and all is exact enough.
bool plan_curved(const GriddingRequest& mosaic, const AllWindows& all, WindowsPlan& windows) {
  constexpr double part = 0.98;  // of the accuracy: the rest is for what terms leave
  GriddingRequest request = window_request(mosaic, windows);
  const MosaicBeams& beams = *mosaic.mosaic->beams;
  std::vector<double> sizes = beams.curved_sizes();
  const double asked = request.accuracy;
  constexpr double of_terms = 0.1, rounding = 1e-9;
  if (sizes.empty() || *beams.max_abs_w() < request.max_abs_w || request.gridder != Gridder::automatic) return false;
  if (asked > 0 && beams.tolerance() > of_terms * (1 + rounding) * asked) return false;
  const double left = std::hypot(leave_out_small(asked, sizes), beams.tolerance());
  const int images = request.stokes;
  request.geometry = all.largest;
  request.geometry.centre = {};
  request.max_abs_w = 0;
  request.gridder = Gridder::standard;
  request.best_effort = true;
  request.accuracy *= part;
  request.single_from *= part;
  request.stokes = images * static_cast<int>(sizes.size());
  GriddingPlan plan = plan_gridding(request);
  if (!plan.choice.reached) return false;
  plan.request.stokes = images;
  for (double* error : {&plan.expected_error, &plan.worst_error}) *error = std::hypot(*error, left);
  for (double* bound : {&plan.bound_rms, &plan.bound_max}) *bound += left;
  // These tell of one image in the plane, which leaves w out.
  const auto is_other = [](const Decision& d) { return d.item == "Stokes parameters" || d.item == "w planes"; };
  plan.decisions.erase(std::remove_if(plan.decisions.begin(), plan.decisions.end(), is_other), plan.decisions.end());
  windows.curved = sizes.size();
  const TransformMemory of_one = memory_of(plan.options, 1, static_cast<double>(request.samples));
  const double term_bytes = of_one.visibilities + static_cast<double>(request.geometry.pixels()) * sizeof(double);
  constexpr double windows_held = 2;  // side by side at least, by all the memory that there is for planes
  const double fit = std::min(static_cast<double>(mosaic.stack_bytes) / windows_held / term_bytes, double{most_shared_images});
  windows.curved_at_once = std::max<std::size_t>(1, static_cast<std::size_t>(fit));
  windows.of_term = {std::make_shared<const GriddingPlan>(std::move(plan))};
  return true;
}

/// The errors of all terms together.
void add_errors(const std::vector<double>& sizes, GriddingPlan& plan) {
  const auto& of_term = plan.windows->of_term;
  double expected = 0, worst = 0, rounding = 0;
  plan.bound_rms = plan.bound_max = 0;
  for (std::size_t k = 0; k < of_term.size(); ++k) {
    const double size = k == 0 ? 1 : sizes[k];
    expected = std::hypot(expected, size * of_term[k]->expected_error);
    worst = std::hypot(worst, size * of_term[k]->worst_error);
    rounding = std::hypot(rounding, size * of_term[k]->rounding);
    plan.bound_rms += size * of_term[k]->bound_rms;
    plan.bound_max += size * of_term[k]->bound_max;
  }
  plan.expected_error = expected;
  plan.worst_error = worst;
  plan.rounding = rounding;
}

std::string angle(double rad) {
  constexpr double arcmin = pi / 180 / 60;
  return text("%.3g", rad / arcmin) + " arcmin";
}

/// Lists the kernels' widths of all terms: "8, 7, 5, 3".
std::string widths(const WindowsPlan& windows) {
  std::string all;
  for (const auto& of_term : windows.of_term)
    all += (all.empty() ? "" : ", ") + (of_term->direct ? "direct sums" : std::to_string(of_term->options.kernel_u.width()));
  return all;
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
      w.curved > 0
          ? Decision{r.max_abs_w > 0 ? "beams and w" : "beams between frequencies",
                     std::to_string(w.spans) + (w.spans == 1 ? " span" : " spans") + " of at most " + std::to_string(w.curved) +
                         (w.curved == 1 ? " term" : " terms"),
                     std::string("from which beams of all channels") +
                         (r.max_abs_w > 0 ? ", and what w makes over the plane tangent at their axes," : "") + " follow to " +
                         text("%.1g", beams.tolerance()) + " of what beams are at most; each sample is gridded for " +
                         (w.curved_at_once < w.curved
                              ? std::to_string(w.curved_at_once) + " of them at a time, as memory allows"
                              : "all of them at once") +
                         ": order, coordinates and taps are the same"}
          : Decision{"beams between frequencies",
                     std::to_string(w.spans) + (w.spans == 1 ? " span" : " spans") + " of at most " +
                         std::to_string(w.of_term.size()) + (w.of_term.size() == 1 ? " term" : " terms"),
                     "from which beams of all channels follow to " + text("%.1g", beams.tolerance()) +
                         " of what they are at most; each sample is gridded for each term, as exactly as its size asks: kernel "
                         "width " +
                         widths(w)}};
  decisions.push_back({"a pointing", text("%.2g", mosaic_seconds(w, 0) / static_cast<double>(w.windows)) + " s of a core",
                       "for a pass over its " + text("%.2g", static_cast<double>(r.samples) / static_cast<double>(w.windows)) +
                           " samples, by counts of operations"});
  if (w.gathers > 1)
    decisions.push_back(
        {"windows", "transformed " + std::to_string(w.gathers) + " times in a pass",
         "memory gathers no more than " + text("%.2g", static_cast<double>(r.samples_at_once)) + " samples at once"});
  if (w.unseeing > 0)
    decisions.push_back({"pointings left out", std::to_string(w.unseeing), "their beams see no pixel of the image"});
  return decisions;
}

/// Bytes that a window takes while it is computed.
double bytes_at_work(const WindowsPlan& windows, const GriddingRequest& request) {
  constexpr double sum_bytes = sizeof(double), value_bytes = sizeof(std::complex<double>);
  const double images = request.stokes + (request.psf ? 1 : 0);
  const GriddingRequest& first = windows.of_term.front()->request;
  const auto pixels = static_cast<double>(first.geometry.pixels());
  // Its samples need not come evenly: all that it has may have gathered at once.
  const double samples = std::min(static_cast<double>(request.samples) / static_cast<double>(windows.windows * windows.spans),
                                  static_cast<double>(request.samples_at_once));
  if (windows.curved > 0) {
    constexpr double coordinate_bytes = 3 * sizeof(double);
    const auto at_once =
        static_cast<double>(std::min<std::size_t>(windows.curved_at_once, windows.curved * static_cast<std::size_t>(images)));
    const TransformMemory one = memory_of(windows.of_term.front()->options, 1, samples);
    return at_once * (one.visibilities + pixels * sum_bytes) + one.fft +
           samples * (coordinate_bytes + value_bytes + (request.psf ? value_bytes : 0)) + pixels * (2 * images + 3) * sum_bytes;
  }
  double transform = 0;
  for (const auto& of_term : windows.of_term) {
    const TransformMemory of = memory_of(*of_term);
    transform = std::max(transform, of.visibilities + of.psf + of.other_stokes + of.fft);
  }
  const double more = samples - static_cast<double>(first.samples);
  const double term_images = static_cast<double>(windows.of_term.size()) + 1;
  return transform + std::max(0.0, more) * (wide_bytes_a_sample + images * wide_bytes_a_value) +
         samples * images * 2 * value_bytes + pixels * (term_images + 3 * images) * sum_bytes;
}

/// With one transform for image and PSF.
GriddingPlan plan_together(const GriddingRequest& request, const AllWindows& all) {
  const MosaicBeams& beams = *request.mosaic->beams;
  WindowsPlan windows;
  windows.windows = all.windows;
  windows.unseeing = all.unseeing;
  windows.spans = beams.all_spans();
  const std::uint64_t at_once = std::max<std::size_t>(1, request.samples_at_once);
  windows.gathers = std::max<std::uint64_t>(1, (request.samples + at_once - 1) / at_once);
  WindowsPlan curved = windows;
  const bool has_curved = plan_curved(request, all, curved);
  GriddingRequest of_window = window_request(request, windows);
  of_window.best_effort = request.best_effort || has_curved;
  windows.of_term = plan_terms(of_window, beams.term_sizes(), all);
  const GriddingPlan& first = *windows.of_term.front();
  const bool reached = first.direct || first.choice.reached;
  if (has_curved && (!reached || mosaic_seconds(curved, 0) < mosaic_seconds(windows, 0))) windows = std::move(curved);
  const auto fit = static_cast<double>(request.stack_bytes) / bytes_at_work(windows, request);
  windows.most_at_once =
      std::clamp<std::size_t>(static_cast<std::size_t>(std::min(fit, 1e9)), 1, windows.windows * windows.spans);
  share_threads(windows, request.threads);
  GriddingPlan plan = *windows.of_term.front();
  plan.request = request;
  plan.options.threads = request.threads;
  plan.direct = false;
  plan.direct_pixels = 0;
  plan.windows = std::make_shared<const WindowsPlan>(std::move(windows));
  add_errors(beams.term_sizes(), plan);
  Plan decisions = decisions_of(plan, all);
  for (Decision& of_one : plan.decisions) decisions.push_back(std::move(of_one));
  plan.decisions = std::move(decisions);
  return plan;
}

}  // namespace

void share_threads(WindowsPlan& windows, int threads) {
  windows.side_by_side =
      static_cast<int>(std::clamp<std::size_t>(static_cast<std::size_t>(std::max(1, threads)), 1, windows.most_at_once));
  for (auto& of_term : windows.of_term)
    of_term = std::make_shared<const GriddingPlan>(with_threads(*of_term, std::max(1, threads / windows.side_by_side)));
}

double mosaic_seconds(const WindowsPlan& windows, int images) {
  double sum = 0;
  for (const auto& of_term : windows.of_term) {
    GriddingWork work = of_term->choice.best.work;
    if (images > 0) work.stokes = images * windows.images_each();
    const int passes = windows.curved == 0 ? 1 : (work.stokes + windows.at_once() - 1) / windows.at_once();
    work.stokes = (work.stokes + passes - 1) / passes;
    sum += passes * CostModel().seconds(work);
  }
  return windows.transforms() * sum;
}

GriddingPlan plan_mosaic(const GriddingRequest& request) {
  const MosaicBeams& beams = *request.mosaic->beams;
  const AllWindows all = all_windows(beams);
  if (!request.psf || request.psf_accuracy == 0 || request.accuracy == 0) return plan_together(request, all);
  if (request.psf_accuracy <= request.accuracy) {
    GriddingRequest both = request;
    both.accuracy = request.psf_accuracy;
    GriddingPlan plan = plan_together(both, all);
    plan.request = request;
    return plan;
  }
  // A PSF that need not be as exact takes fewer terms, and many windows do not see its source.
  GriddingRequest alone = request;
  alone.psf = false;
  GriddingPlan plan = plan_together(alone, all);
  alone.stokes = 0;
  alone.psf = true;
  alone.accuracy = request.psf_accuracy;
  plan.psf = std::make_shared<const GriddingPlan>(plan_together(alone, all));
  plan.request = request;
  plan.decisions.push_back(
      {"PSF", "has its own transform, kernel width " + widths(*plan.psf->windows),
       "it is made to " + text("%.2g", request.psf_accuracy) + ", and of windows that see its source alone"});
  return plan;
}

TransformMemory mosaic_memory(const GriddingPlan& plan) {
  constexpr double value_bytes = sizeof(std::complex<double>), row_bytes = 8;  // of each of four channels
  const GriddingRequest& r = plan.request;
  const double images = r.stokes + (r.psf ? 1 : 0);
  const double gathered = std::min(static_cast<double>(r.samples), static_cast<double>(r.samples_at_once));
  TransformMemory memory;
  // However many threads there are: what fits into memory decides on gathers, which images must not depend on.
  memory.visibilities = static_cast<double>(plan.windows->most_at_once) * bytes_at_work(*plan.windows, r) +
                        gathered * (row_bytes + sizeof(float) + r.stokes * value_bytes) +
                        (images + 1) * static_cast<double>(r.geometry.pixels()) * sizeof(double) +
                        (plan.windows->curved > 0 ? r.mosaic->beams->curved_bytes() : 0);
  memory.gathered = gathered;
  if (plan.psf) {
    memory.psf = gathered * (row_bytes + sizeof(float));
    memory.visibilities = std::max(memory.visibilities, mosaic_memory(*plan.psf).visibilities);
  }
  return memory;
}

namespace {

WindowTransforms curved_transforms(const WindowsPlan& windows) {
  const auto make = [options = CoplanarOptions(windows.of_term.front()->options)](const ImageGeometry& geometry) {
    CoplanarOptions of = options;
    of.geometry = geometry;
    return std::shared_ptr<const SharedTransform>(make_shared_transform(of));
  };
  return CurvedTransforms{make, windows.curved, windows.curved_at_once};
}

WindowTransforms term_transforms(const WindowsPlan& windows) {
  std::vector<MakeTermTransform> of_term;
  for (const std::shared_ptr<const GriddingPlan>& planned : windows.of_term)
    of_term.emplace_back([planned](const ImageGeometry& geometry) {
      GriddingPlan of = *planned;
      of.options.geometry = of.request.geometry = geometry;
      return std::make_shared<const PlannedTransform>(of);
    });
  return of_term;
}

}  // namespace

std::unique_ptr<Transform> make_mosaic_transform(const GriddingPlan& plan) {
  const MosaicRequest& mosaic = *plan.request.mosaic;
  const WindowsPlan& windows = *plan.windows;
  return std::make_unique<MosaicTransform>(
      mosaic.beams, windows.curved > 0 ? curved_transforms(windows) : term_transforms(windows),
      MosaicOptions{mosaic.psf_row, mosaic.psf_column, mosaic.flat_noise, plan.request.samples_at_once, plan.request.threads,
                    plan.windows->side_by_side});
}

}  // namespace misfit::imager
