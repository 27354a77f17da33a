#include "tools/run/run_report.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "imager/wide/facet.h"
#include "kernels/version.h"
#include "tools/base/memory.h"

namespace misfit::tools {
namespace {

using nlohmann::json;

constexpr double arcsec = std::numbers::pi / 180 / 3600;

/// A number as JSON, which has none that is not finite.
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

json error_json(double asked, const ChannelReport& plane, const StokesReport& of) {
  json error = {{"requested", asked == 0 ? json() : json(asked)},
                {"expected_rms", nullptr},
                {"bound_rms", nullptr},
                {"bound_max", nullptr},
                {"measured_rms", nullptr},
                {"measured_max", nullptr},
                {"measured_predict_rms", nullptr}};
  if (of.theory) {
    error["expected_rms"] = number(of.theory->expected_rms);
    error["bound_rms"] = number(of.theory->bound_rms);
    error["bound_max"] = number(of.theory->bound_max);
  }
  if (of.measured) {
    error["measured_rms"] = number(of.measured->rms);
    error["measured_max"] = number(of.measured->max);
  }
  if (plane.measured_predict_rms) error["measured_predict_rms"] = number(*plane.measured_predict_rms);
  return error;
}

/// The noises; unknown ones are null.
json noise_json(const ChannelReport& plane, const StokesReport& of) {
  const auto known = [](double noise_jy) { return noise_jy > 0 ? number(noise_jy) : json(); };
  return {{"predicted_jy", known(plane.predicted_noise_jy)}, {"measured_jy", known(of.histogram.noise_jy)}};
}

json beam_json(const std::optional<imager::Beam>& beam) {
  if (!beam) return nullptr;
  return {{"major_arcsec", beam->major_rad / arcsec},
          {"minor_arcsec", beam->minor_rad / arcsec},
          {"pa_deg", beam->position_angle_rad * 180 / std::numbers::pi}};
}

json restoring_json(const std::optional<BeamChoice>& beams) {
  if (!beams || !beams->restoring) return nullptr;
  json beam = beam_json(beams->restoring);
  beam["how"] = beams->how;
  beam["misfit"] = number(beams->misfit);
  return beam;
}

/// The extension of a mask; null where no residual extended it.
json extension_json(const imager::MaskExtension& masked) {
  if (masked.threshold_jy == 0) return nullptr;
  return {{"threshold_jy", number(masked.threshold_jy)},
          {"by_sidelobes", masked.by_sidelobes},
          {"regions", masked.regions},
          {"pruned", masked.pruned},
          {"grown_regions", masked.grown_regions},
          {"grown_pruned", masked.grown_pruned},
          {"negative_pixels", masked.negative},
          {"added_pixels", masked.added}};
}

json cycle_json(const imager::MajorCycle& cycle) {
  return {{"iterations", cycle.iterations},
          {"peak_residual_jy", number(cycle.peak_residual_jy)},
          {"rms_jy", number(cycle.rms_jy)},
          {"model_flux_jy", number(cycle.model_flux_jy)},
          {"cycle_threshold_jy", number(cycle.cycle_threshold_jy)},
          {"ended", cycle.ended},
          {"from", cycle.from},
          {"accuracy", cycle.accuracy == 0 ? json() : number(cycle.accuracy)},
          {"peak_anywhere_jy", number(cycle.peak_anywhere_jy)},
          {"mask_pixels", cycle.mask_pixels},
          {"mask_extension", extension_json(cycle.masked)}};
}

json clean_json(const std::optional<imager::CleanReport>& clean) {
  if (!clean) return nullptr;
  json log = json::array();
  for (const imager::MajorCycle& cycle : clean->cycles) log.push_back(cycle_json(cycle));
  json report = cycle_json(clean->final_state());
  for (const char* of_a_cycle :
       {"cycle_threshold_jy", "ended", "from", "accuracy", "peak_anywhere_jy", "mask_pixels", "mask_extension"})
    report.erase(of_a_cycle);
  report["iterations"] = clean->iterations;
  report["major_cycles"] = clean->cycles.size() - 1;
  report["kept_cycle"] = clean->kept;
  report["stop_code"] = static_cast<int>(clean->stop);
  report["stop_reason"] = clean->stop_reason;
  report["max_sidelobe"] = number(clean->max_sidelobe);
  report["major_cycles_log"] = log;
  return report;
}

/// The brightest pixel of the restored image; null without one.
json restored_json(const StokesReport& of, const imager::ImageGeometry& geometry) {
  if (!of.clean) return nullptr;
  constexpr double degree = std::numbers::pi / 180;
  const std::optional<imager::SkyDirection> at = peak_direction(of.brightest, geometry);
  return {{"peak_jy", number(of.brightest.value)},
          {"ra_deg", at ? json(at->ra_rad / degree) : json()},
          {"dec_deg", at ? json(at->dec_rad / degree) : json()},
          {"frame", at ? json(at->frame) : json()},
          {"column", of.brightest.column},
          {"row", of.brightest.row}};
}

json stokes_json(const RunReport& r, const ChannelReport& plane) {
  json list = json::array();
  for (const StokesReport& of : plane.stokes)
    list.push_back({{"stokes", imager::stokes_name(of.stokes)},
                    {"error", error_json(r.accuracy, plane, of)},
                    {"noise", noise_json(plane, of)},
                    {"clean", clean_json(of.clean)},
                    {"restored", restored_json(of, r.geometry)},
                    {"residual_histogram", histogram_json(of.histogram)}});
  return list;
}

/// The spectral axis of a cube; null where there is one plane, of the whole band.
json spectral_json(const std::optional<imager::SpectralAxis>& axis) {
  if (!axis) return nullptr;
  return {{"frame", axis->frame},
          {"reference_hz", axis->reference_hz},
          {"increment_hz", axis->increment_hz},
          {"in_wavelength", axis->in_wavelength},
          {"channels", axis->channels},
          {"rest_frequency_hz", axis->rest_frequency_hz > 0 ? json(axis->rest_frequency_hz) : json()}};
}

json planes_json(const RunReport& r) {
  json list = json::array();
  for (const ChannelReport& plane : r.channels) {
    const StokesReport& first = plane.stokes.front();
    const bool empty = plane.sums.used == 0;
    list.push_back({{"plane", plane.channel},
                    {"frequency_hz", plane.frequency_hz},
                    {"used", plane.sums.used},
                    {"beam", restoring_json(plane.beams)},
                    {"noise", noise_json(plane, first)},
                    {"brightest_jy", empty ? json() : number(first.brightest.value)},
                    {"clean", clean_json(first.clean)},
                    {"stokes", stokes_json(r, plane)}});
  }
  return list;
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

std::size_t brightest_channel(const std::vector<ChannelReport>& channels) {
  const auto brightness = [](const ChannelReport& channel) {
    return channel.sums.used == 0 ? -1 : std::abs(channel.stokes.front().brightest.value);
  };
  const auto found = std::max_element(channels.begin(), channels.end(), [&](const ChannelReport& a, const ChannelReport& b) {
    return brightness(a) < brightness(b);
  });
  return static_cast<std::size_t>(found - channels.begin());
}

std::optional<imager::SkyDirection> peak_direction(const imager::Peak& peak, const imager::ImageGeometry& geometry) {
  const imager::DirectionCosines at = geometry.at(peak.row, peak.column);
  if (imager::beyond_horizon(at)) return std::nullopt;
  return imager::sky_direction(at, geometry.phase_centre);
}

double largest_expected_error(const RunReport& r) {
  double largest = 0;
  for (const ChannelReport& plane : r.channels)
    for (const StokesReport& of : plane.stokes) largest = std::max(largest, of.theory ? of.theory->expected_rms : 0);
  return largest;
}

json plan_json(const RunReport& r) {
  return {{"version", MISFIT_VERSION},
          {"command_line", r.command_line},
          {"options", r.options},
          {"plan", plan_json(r.plan)},
          {"warnings", r.warnings},
          {"timings_expected_s", expected_json(r.expected)},
          {"memory_gib_estimated", r.estimated_memory_bytes / gib}};
}

json report_json(const RunReport& r) {
  const ChannelReport& plane = r.channels[r.shown];
  const StokesReport& first = plane.stokes.front();
  json report = plan_json(r);
  report.update(json{{"kernel", kernel_json(r.gridding)},
                     {"error", error_json(r.accuracy, plane, first)},
                     {"noise", noise_json(plane, first)},
                     {"visibilities", counts_json(r.counts)},
                     {"timings_s", timings_json(r)},
                     {"memory_gib_peak", peak_memory_bytes() / gib},
                     {"beam", restoring_json(plane.beams)},
                     {"beam_by_quadrant", plane.beams ? beam_json(plane.beams->quadrant) : json()},
                     {"clean", clean_json(first.clean)},
                     {"restored", restored_json(first, r.geometry)},
                     {"residual_histogram", histogram_json(first.histogram)},
                     {"stokes", stokes_json(r, plane)},
                     {"spectral_axis", spectral_json(r.cube)},
                     {"planes", r.cube ? planes_json(r) : json()},
                     {"plane_samples", r.cube ? json(r.channel_samples) : json()},
                     {"samples_outside_planes", r.cube ? json(r.outside_channels) : json()},
                     {"outside", outside_json(r.outside)},
                     {"outside_search", outside_search_json(r.outside)}});
  return report;
}

}  // namespace misfit::tools
