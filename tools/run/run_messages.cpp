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

/// "restored peak 106 Jy/beam at 14h 11m 20.519s  +52° 12′ 09.97″ (FK5), pixel 1024, 1024"
std::string restored_text(const imager::Peak& peak, const imager::ImageGeometry& geometry) {
  const std::optional<imager::SkyDirection> at = peak_direction(peak, geometry);
  return "restored peak " + with_prefix(peak.value, "Jy/beam", 4) +
         (at ? " at " + sexagesimal(*at) + " (" + at->frame + "), pixel " : " at pixel ") + std::to_string(peak.column) + ", " +
         std::to_string(peak.row);
}

/// Two lines: CLEAN's components of one Stokes parameter, and the peak of the restored image.
std::string clean_lines(const StokesReport& of, const imager::ImageGeometry& geometry, const std::string& before) {
  return before + grouped(of.clean->iterations) + " components, model flux " +
         with_prefix(of.clean->final_state().model_flux_jy, "Jy", 4) + "; " + of.clean->stop_reason + "\n" + before +
         restored_text(of.brightest, geometry) + "\n";
}

}  // namespace

imager::Decision left_out_decision(const imager::SampleCounts& counts) {
  return {"samples left out", left_out_of_all(counts), left_out_reasons(counts)};
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
  if (plane.beams && plane.beams->restoring) text += "beam " + beam_text(*plane.beams->restoring) + "\n";
  for (const StokesReport& of : plane.stokes)
    if (of.clean) text += clean_lines(of, r.geometry, plane.stokes.size() > 1 ? stokes_name(of.stokes) + ": " : "");
  return text;
}

}  // namespace misfit::tools
