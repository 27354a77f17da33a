#include "tools/run/run_report.h"

#include <cmath>
#include <numbers>

#include "imager/wide/facet.h"
#include "tools/base/memory.h"
#include "tools/version.h"

namespace misfit::tools {
namespace {

using nlohmann::json;

constexpr double arcsec = std::numbers::pi / 180 / 3600;

/// JSON has no number for what is not finite.
json number(double value) {
  return std::isfinite(value) ? json(value) : json();
}

json plan_json(const imager::Plan& plan) {
  json list = json::array();
  for (const imager::Decision& d : plan) list.push_back({{"item", d.item}, {"decision", d.decision}, {"because", d.because}});
  return list;
}

json axis_json(const std::string& axis, const kernels::Kernel& kernel, double padding) {
  return {{"axis", axis}, {"width", kernel.width()}, {"x0", kernel.x0}, {"padding", padding}};
}

json kernel_json(const imager::GriddingPlan* gridding) {
  if (gridding == nullptr || gridding->direct) return nullptr;
  const imager::WideTransformOptions& o = gridding->options;
  const auto padding = [](int fft_size, int pixels, int facets) {
    return 1.0 * fft_size / imager::largest_facet(pixels, facets);
  };
  const double padding_u = padding(o.nu, o.geometry.width, o.facets_l);
  json kernel = axis_json("u", o.kernel_u, padding_u);
  kernel.erase("axis");
  kernel["name"] = o.kernel_u.name;
  kernel["evaluation"] = imager::evaluation_of(o);
  kernel["axes"] = {axis_json("u", o.kernel_u, padding_u),
                    axis_json("v", o.kernel_v, padding(o.nv, o.geometry.height, o.facets_m))};
  if (o.has_w_axis()) kernel["axes"].push_back(axis_json("w", o.kernel_w, gridding->choice.best.padding_w));
  return kernel;
}

json error_json(const RunReport& r) {
  json error = {{"requested", r.accuracy == 0 ? json() : json(r.accuracy)},
                {"expected_rms", nullptr},
                {"bound_rms", nullptr},
                {"bound_max", nullptr},
                {"measured_rms", nullptr},
                {"measured_max", nullptr},
                {"measured_predict_rms", nullptr}};
  if (r.theory != nullptr) {
    error["expected_rms"] = number(r.theory->expected_rms);
    error["bound_rms"] = number(r.theory->bound_rms);
    error["bound_max"] = number(r.theory->bound_max);
  }
  if (r.measured != nullptr) {
    error["measured_rms"] = number(r.measured->image.front().rms);
    error["measured_max"] = number(r.measured->image.front().max);
    error["measured_predict_rms"] = number(r.measured->predict_rms);
  }
  return error;
}

json beam_json(const std::optional<imager::Beam>& beam) {
  if (!beam) return nullptr;
  return {{"major_arcsec", beam->major_rad / arcsec},
          {"minor_arcsec", beam->minor_rad / arcsec},
          {"pa_deg", beam->position_angle_rad * 180 / std::numbers::pi}};
}

json restoring_json(const BeamChoice* beams) {
  if (beams == nullptr || !beams->restoring) return nullptr;
  json beam = beam_json(beams->restoring);
  beam["how"] = beams->how;
  beam["misfit"] = number(beams->misfit);
  return beam;
}

json cycle_json(const imager::MajorCycle& cycle) {
  return {{"iterations", cycle.iterations},
          {"peak_residual_jy", number(cycle.peak_residual_jy)},
          {"rms_jy", number(cycle.rms_jy)},
          {"model_flux_jy", number(cycle.model_flux_jy)},
          {"cycle_threshold_jy", number(cycle.cycle_threshold_jy)},
          {"ended", cycle.ended},
          {"from", cycle.from}};
}

json clean_json(const imager::CleanReport* clean) {
  if (clean == nullptr) return nullptr;
  json log = json::array();
  for (const imager::MajorCycle& cycle : clean->cycles) log.push_back(cycle_json(cycle));
  json report = cycle_json(clean->final_state());
  for (const char* of_a_cycle : {"cycle_threshold_jy", "ended", "from"}) report.erase(of_a_cycle);
  report["iterations"] = clean->iterations;
  report["major_cycles"] = clean->cycles.size() - 1;
  report["kept_cycle"] = clean->kept;
  report["stop_code"] = static_cast<int>(clean->stop);
  report["stop_reason"] = clean->stop_reason;
  report["max_sidelobe"] = number(clean->max_sidelobe);
  report["major_cycles_log"] = log;
  return report;
}

json counts_json(const imager::SampleCounts& c) {
  return {{"rows_read", c.rows_read},
          {"samples_read", c.samples_read},
          {"used", c.used},
          {"flagged", c.flagged},
          {"nonfinite", c.nonfinite},
          {"zero_weight", c.zero_weight},
          {"autocorrelations", c.autocorrelations},
          {"outside_grid", c.outside_grid}};
}

json timings_json(const RunReport& r) {
  json timings = json::object();
  if (r.times != nullptr)
    for (const auto& [stage, seconds] : r.times->stages()) timings[stage] = seconds;
  timings["total"] = r.wall_clock_s;
  return timings;
}

json expected_json(const std::vector<StageSeconds>& stages) {
  if (stages.empty()) return nullptr;
  json expected = json::object();
  for (const StageSeconds& s : stages) expected[s.stage] = s.seconds;
  expected["total"] = total_seconds(stages);
  return expected;
}

}  // namespace

json report_json(const RunReport& r) {
  return {{"version", version},
          {"command_line", r.command_line},
          {"options", r.options},
          {"plan", plan_json(r.plan)},
          {"warnings", r.warnings},
          {"kernel", kernel_json(r.gridding)},
          {"error", error_json(r)},
          {"visibilities", counts_json(r.counts)},
          {"timings_s", timings_json(r)},
          {"timings_expected_s", expected_json(r.expected)},
          {"memory_gib_peak", peak_memory_bytes() / gib},
          {"memory_gib_estimated", r.estimated_memory_bytes / gib},
          {"beam", restoring_json(r.beams)},
          {"beam_by_quadrant", r.beams == nullptr ? json() : beam_json(r.beams->quadrant)},
          {"clean", clean_json(r.clean)},
          {"residual_histogram", histogram_json(r.histogram)},
          {"outside", outside_json(r.outside)},
          {"outside_search", outside_search_json(r.outside)}};
}

}  // namespace misfit::tools
