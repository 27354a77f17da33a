#include "tools/run/run_messages.h"

#include <algorithm>
#include <cmath>

#include "imager/numerics/constants.h"
#include "tools/base/left_out.h"
#include "tools/base/numbers.h"

namespace misfit::tools {
namespace {

std::string counted(std::uint64_t count) {
  return grouped(static_cast<long long>(count));
}

std::string beam_text(const imager::Beam& beam) {
  const ScaledUnit unit = angle_unit(beam.major_rad);
  return significant(beam.major_rad / unit.size, 4) + " × " + significant(beam.minor_rad / unit.size, 4) + unit.name + " at " +
         significant(beam.position_angle_rad * 180 / M_PI, 3) + "°";
}

/// The beam in words, with the one that WSClean would have, since people compare.
std::string beam_line(const BeamChoice& beams) {
  return "beam " + beam_text(*beams.restoring) + (beams.quadrant ? "; by WSClean's rule " + beam_text(*beams.quadrant) : "") +
         "\n";
}

}  // namespace

imager::Decision left_out_decision(const imager::SampleCounts& counts) {
  return {"samples left out", left_out_of_all(counts), left_out_reasons(counts)};
}

std::string outside_grid_warning(std::uint64_t samples, const imager::UvwReach& reach) {
  const double largest_cell_rad = 0.5 / std::max(reach.max_abs_u, reach.max_abs_v);
  const ScaledUnit unit = angle_unit(largest_cell_rad);
  return counted(samples) + " samples lie beyond 1/(2 cell) and were left out; a cell of " +
         significant(std::floor(largest_cell_rad / unit.size * 1e4) / 1e4, 4) + unit.name + " would keep them";
}

std::string pointing_warning(const ms_io::FieldPointing& nearest, const imager::ImageGeometry& geometry, double frequency_hz) {
  constexpr double degree = M_PI / 180, most_beams = 3, most_without_dish_rad = 10 * degree;
  const double beam_rad = nearest.smallest_dish_m > 0 ? imager::speed_of_light_m_s / frequency_hz / nearest.smallest_dish_m : 0;
  const double half_diagonal_rad = 0.5 * std::hypot(geometry.width, geometry.height) * geometry.cell_rad;
  const double beyond_rad = nearest.from_centre_rad - half_diagonal_rad;
  if (!(beyond_rad > (beam_rad > 0 ? most_beams * beam_rad : most_without_dish_rad))) return "";
  return "the image's centre is " + significant(nearest.from_centre_rad / degree, 3) + " degrees from the nearest field, " +
         nearest.name +
         (beam_rad > 0 ? ", or " + significant(nearest.from_centre_rad / beam_rad, 2) + " times λ/D of antennas " +
                             significant(nearest.smallest_dish_m, 3) + " m wide"
                       : "") +
         ": they hardly see it, and it may show noise alone";
}

std::string accuracy_warning(double asked, double expected) {
  return "the accuracy of " + significant(asked, 2) +
         " is out of reach: the image is weak against its data, and its error may come to " + significant(expected, 2);
}

std::string cycle_message(const imager::CleanState& state) {
  const imager::MajorCycle& cycle = state.cycles.back();
  return grouped(cycle.iterations) + " components, peak residual " + with_prefix(cycle.peak_residual_jy, "Jy/beam", 3) +
         ", noise " + with_prefix(cycle.rms_jy, "Jy/beam", 3) + (state.now + 1 == state.cycles.size() ? "" : ": taken back");
}

std::string channel_line(const ChannelReport& channel, int channels) {
  std::string text = "  plane " + std::to_string(channel.channel) + " of " + std::to_string(channels) + ", " +
                     frequency_text(channel.frequency_hz, 9);
  for (const StokesReport& of : channel.stokes) {
    text += channel.stokes.size() > 1 ? "; " + stokes_name(of.stokes) + " " : ": ";
    if (of.clean)
      text += grouped(of.clean->iterations) + " components, peak residual " +
              with_prefix(of.clean->final_state().peak_residual_jy, "Jy/beam", 3) + ", ";
    text += "noise " + with_prefix(of.histogram.noise_jy, "Jy/beam", 3);
  }
  return text;
}

std::string divergence_warning(const imager::CleanReport& report) {
  return "CLEAN diverged: a lower --gain, a --mask around the sources, or more scales may help; the largest sidelobe is " +
         significant(100 * report.max_sidelobe, 2) + " % of the PSF's peak";
}

std::string summary(const RunReport& r) {
  const ChannelReport& plane = r.channels[r.shown];
  const std::string imaged = r.cube ? " samples imaged, as " + counted(r.channel_samples) + " in " +
                                          std::to_string(r.cube->channels) + " planes; at plane " +
                                          std::to_string(plane.channel) + ", the brightest: expected error "
                                    : " samples imaged; expected error ";
  std::string text =
      counted(r.counts.used) + " of " + counted(r.counts.samples_read) + imaged + significant(largest_expected_error(r), 2);
  if (plane.measured_predict_rms) {
    double measured = 0;
    for (const StokesReport& of : plane.stokes) measured = std::max(measured, of.measured->rms);
    text += ", measured " + significant(measured, 2) + " (prediction " + significant(*plane.measured_predict_rms, 2) + ")";
  }
  text += "; noise";
  for (const StokesReport& of : plane.stokes)
    text += (plane.stokes.size() > 1 ? " of " + stokes_name(of.stokes) + " " : " ") +
            with_prefix(of.histogram.noise_jy, "Jy/beam", 3) + ",";
  text += " predicted " + with_prefix(plane.predicted_noise_jy, "Jy/beam", 3) + "\n";
  if (plane.beams && plane.beams->restoring) text += beam_line(*plane.beams);
  for (const StokesReport& of : plane.stokes)
    if (of.clean)
      text += (plane.stokes.size() > 1 ? stokes_name(of.stokes) + ": " : "") + grouped(of.clean->iterations) +
              " components, model flux " + significant(of.clean->final_state().model_flux_jy, 4) + "; " +
              of.clean->stop_reason + "\n";
  return text;
}

}  // namespace misfit::tools
