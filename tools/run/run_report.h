#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "imager/clean/clean.h"
#include "imager/data/noise.h"
#include "imager/data/spectral_axis.h"
#include "imager/data/stokes.h"
#include "imager/direct/verify.h"
#include "imager/plan/accurate_imaging.h"
#include "imager/plan/plan.h"
#include "tools/run/beam_choice.h"
#include "tools/run/outside_stage.h"
#include "tools/run/time_forecast.h"
#include "tools/run_page/pixel_histogram.h"

namespace misfit::tools {

/// The report's part on one Stokes parameter.
struct StokesReport {
  imager::Stokes stokes = imager::Stokes::I;
  std::optional<imager::TheoreticalError> theory{};
  std::optional<imager::PixelError> measured{};  ///< over the image's RMS
  std::optional<imager::CleanReport> clean{};
  imager::Peak brightest{};    ///< of the restored image, which there is where CLEAN ran; else of the dirty one of a cube
  PixelHistogram histogram{};  ///< of the residual, or of the dirty image where nothing was cleaned
};

/// The report's part on one channel.
struct ChannelReport {
  int channel = 0;
  double frequency_hz = 0;                  ///< its middle
  std::vector<StokesReport> stokes = {{}};  ///< at least one
  std::optional<double> measured_predict_rms{};
  imager::SampleSums sums{};      ///< of the first Stokes parameter
  double predicted_noise_jy = 0;  ///< Jy/beam, from the weights; 0 = not known
  std::optional<BeamChoice> beams{};
  imager::Plan decisions{};  ///< on the weights, where they are not the data's
  bool made_twice = false;   ///< since a first pass did not keep the accuracy
};

/// The report of a run of `misfit image`; a part that does not exist is null in report.json.
struct RunReport {
  std::string command_line;
  nlohmann::json options;
  imager::Plan plan;
  std::vector<std::string> warnings;
  imager::ImageGeometry geometry{};  ///< of the images
  double accuracy = 0;               ///< 0 = none was asked
  const imager::GriddingPlan* gridding = nullptr;
  std::vector<ChannelReport> channels = {{}};  ///< at least one
  std::size_t shown = 0;                       ///< the channel that is drawn, and the one reported where only one is
  std::optional<imager::SpectralAxis> cube{};  ///< null where there is one channel, of the whole band
  std::uint64_t channel_samples = 0;           ///< samples in channels, which interpolation makes of the samples used
  std::uint64_t outside_channels = 0;          ///< usable samples that lie in no channel
  imager::SampleCounts counts;
  const OutsideReport* outside = nullptr;
  double wall_clock_s = 0;
  double estimated_memory_bytes = 0;  ///< at the peak
  const imager::StageTimes* times = nullptr;
  std::vector<StageSeconds> expected;  ///< the times that were expected, for the cycles and components that there were
};

/// The index of the channel with the brightest pixel of the first Stokes parameter; 0 where none has samples.
std::size_t brightest_channel(const std::vector<ChannelReport>& channels);

/// Where on the sky a pixel of this kind lies; nothing beyond the horizon.
std::optional<imager::SkyDirection> peak_direction(const imager::Peak& peak, const imager::ImageGeometry& geometry);

/// The largest of all channels and Stokes parameters, over each image's RMS.
double largest_expected_error(const RunReport& report);

/// report.json, with the keys of the project's design; `noise` {predicted_jy, measured_jy}, `beam.how`, `beam.misfit`,
/// `beam_by_quadrant`, `memory_gib_estimated`, `warnings`, `command_line`, `outside`, `outside_search`, `timings_s.total`,
/// `timings_expected_s` (by stage, with `total`; null where nothing was expected), `clean.major_cycles_log`, `clean.kept_cycle`
/// (whose model was kept), `residual_histogram` (see histogram_json()), `restored` {peak_jy, ra_deg, dec_deg, column, row} (the
/// brightest pixel of the restored image, before the primary beam is divided out; null without one) and `stokes` (a list of
/// {stokes, error, noise, clean, restored, residual_histogram}, of which the first is what the report's own keys hold) are
/// additions. For a cube, these keys tell of
/// the plane that is drawn, `spectral_axis` of its planes' frequencies, `planes` (a list of {plane, frequency_hz, used, beam,
/// noise, brightest_jy, clean, stokes}) of each, `plane_samples` and `samples_outside_planes` of usable samples in them and in
/// none; they are null otherwise. Where several planes are made at a time, `timings_s` counts the seconds that they spent on a
/// stage together over the number of planes made at a time, so that the stages add up to the run's wall clock, as far as all
/// were busy.
nlohmann::json report_json(const RunReport& report);
/// The part of report.json that is known before the run: version, command_line, options, plan, warnings, timings_expected_s,
/// memory_gib_estimated.
nlohmann::json plan_json(const RunReport& report);

}  // namespace misfit::tools
