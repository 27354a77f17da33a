#include "tools/run/cube_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <tuple>

#include "imager/numerics/constants.h"
#include "ms_io/capitals.h"
#include "tools/base/numbers.h"
#include "tools/base/option_checks.h"
#include "tools/base/quantity.h"

namespace misfit::tools {
namespace {

/// The units of --start and --chanwidth.
enum class SpectralUnit { none, channels, window_channels, frequency, velocity };

struct SpectralQuantity {
  SpectralUnit unit = SpectralUnit::none;
  double value = 0;  ///< channels selected, or of the window, Hz or m/s
};

SpectralQuantity parse(const std::string& option, const std::string& text) {
  if (text.empty()) return {};
  int channels = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), channels);
  const std::string_view rest = error == std::errc() ? std::string_view(end) : "no number";
  if (rest.empty()) return {SpectralUnit::channels, 1.0 * channels};
  if (rest == "chan" && option == "start") return {SpectralUnit::window_channels, 1.0 * channels};
  try {
    if (text.ends_with("/s")) return {SpectralUnit::velocity, parse_velocity_m_s(text)};
    if (has_unit(text)) return {SpectralUnit::frequency, parse_frequency_hz(text)};
  } catch (const std::invalid_argument&) {  // said below
  }
  refuse_option(option, text, "a number of channels, a frequency such as 1.4GHz, or a velocity such as 20km/s");
}

/// The band of all windows, edges included.
struct Band {
  double low_hz = std::numeric_limits<double>::infinity();
  double high_hz = 0;
};

Band band_of(const std::vector<ms_io::SpectralWindow>& windows) {
  Band band;
  for (const ms_io::SpectralWindow& window : windows)
    for (std::size_t c = 0; c < window.frequency_hz.size(); ++c) {
      const double hz = window.frequency_hz[c], width_hz = window.channel_width_hz[c];
      if (!(width_hz > 0))
        throw std::runtime_error("a channel at " + frequency_text(hz, 8) +
                                 " has no width; expected a positive CHAN_WIDTH, which cubes need");
      band.low_hz = std::min(band.low_hz, hz - width_hz / 2);
      band.high_hz = std::max(band.high_hz, hz + width_hz / 2);
    }
  return band;
}

bool at_rest(const CubeOptions& o) {
  return ms_io::capitals(o.outframe) == "REST";
}

bool optical(const CubeOptions& o) {
  return ms_io::capitals(o.veltype) == "OPTICAL";
}

/// FITS SPECSYS of the planes' frequencies; empty where they are the data's, in whatever frame.
std::string plane_frame(const CubeOptions& o) {
  return at_rest(o) ? "SOURCE" : spectral_frame(o);
}

std::string in_frame_text(const imager::SpectralAxis& axis) {
  return axis.frame.empty() ? "" : " in " + axis.frame;
}

/// The axis, option by option.
class AxisMaker {
 public:
  AxisMaker(const CubeOptions& o, const std::vector<ms_io::SpectralWindow>& windows)
      : o_(o),
        first_(windows.front()),
        band_(band_of(windows)),
        start_(parse("start", o.start)),
        width_(parse("chanwidth", o.chanwidth)) {
    axis_.frame = plane_frame(o);
    axis_.rest_frequency_hz = rest_frequency_hz(o);
    const bool velocities = width_.unit == SpectralUnit::velocity ||
                            (start_.unit == SpectralUnit::velocity && width_.unit != SpectralUnit::frequency);
    axis_.in_wavelength = optical(o) && velocities;
  }

  imager::SpectralAxis make() {
    axis_.reference_hz = start_.unit == SpectralUnit::velocity ? frequency_of(start_.value) : first_.frequency_hz.front();
    axis_.increment_hz = increment_hz();
    axis_.reference_hz = start_hz();
    axis_.increment_hz = increment_hz();
    axis_.channels = o_.nchan > 0 ? o_.nchan : planes_to_end();
    check();
    return axis_;
  }

 private:
  double channel_width_hz() const {
    const auto& hz = first_.frequency_hz;
    const bool falls = hz.size() > 1 && hz.back() < hz.front();
    return (falls ? -1 : 1) * first_.channel_width_hz.front();
  }

  double increment_hz() const {
    const double channel = channel_width_hz();
    const double up = start_.unit == SpectralUnit::frequency  ? std::abs(channel)
                      : start_.unit == SpectralUnit::velocity ? -std::abs(channel)
                                                              : channel;
    if (width_.unit == SpectralUnit::none) return up;
    if (width_.unit == SpectralUnit::channels) return up * width_.value;
    if (width_.unit == SpectralUnit::frequency) return width_.value;
    const double of_line = optical(o_) ? std::pow(axis_.reference_hz / axis_.rest_frequency_hz, 2) : 1;
    return -axis_.rest_frequency_hz * of_line * width_.value / imager::speed_of_light_m_s;
  }

  double frequency_of(double velocity_m_s) const {
    const double beta = velocity_m_s / imager::speed_of_light_m_s;
    return axis_.rest_frequency_hz * (optical(o_) ? 1 / (1 + beta) : 1 - beta);
  }

  double start_hz() const {
    const auto channels = static_cast<int>(first_.frequency_hz.size());
    if (start_.unit == SpectralUnit::frequency) return start_.value;
    if (start_.unit == SpectralUnit::velocity) return frequency_of(start_.value);
    const bool backwards = axis_.increment_hz * channel_width_hz() < 0;
    const int channel = start_.unit == SpectralUnit::channels          ? static_cast<int>(start_.value)
                        : start_.unit == SpectralUnit::window_channels ? place_of(static_cast<int>(start_.value))
                        : backwards                                    ? channels - 1
                                                                       : 0;
    if (channel < 0 || channel >= channels)
      refuse_option("start", o_.start, "0 to " + std::to_string(channels - 1) + ", a channel of the first window selected");
    const double hz = first_.frequency_hz[static_cast<std::size_t>(channel)];
    // The first plane begins where the first channel does.
    return hz + 0.5 * (axis_.increment_hz - std::copysign(std::abs(channel_width_hz()), axis_.increment_hz));
  }

  /// The place of a channel of the window among the selected ones.
  int place_of(int channel) const {
    const auto found = std::find(first_.channel.begin(), first_.channel.end(), channel);
    if (found == first_.channel.end())
      refuse_option("start", o_.start,
                    "a channel that is selected of window " + std::to_string(first_.id) + ", which begin with " +
                        std::to_string(first_.channel.front()) + "chan and end with " + std::to_string(first_.channel.back()) +
                        "chan");
    return static_cast<int>(found - first_.channel.begin());
  }

  /// So many planes that the last one holds the middle of the last data, or reaches half-way into them.
  int planes_to_end() const {
    const double end = axis_.increment_hz > 0 ? band_.high_hz : band_.low_hz;
    const double planes = axis_.plane_of(end) + 0.5;
    if (planes > most_planes)
      refuse_option("chanwidth", o_.chanwidth,
                    "wider planes, or --nchan: it takes " + significant(planes, 3) + " to the end of the data, where " +
                        std::to_string(most_planes) + " are the most");
    constexpr double rounding = 1e-6;  // of a plane: Doppler's shift and where the telescope stands are known less well
    return std::max(1, static_cast<int>(std::floor(planes + 0.5 + rounding)));
  }

  void check() const {
    const auto [low, high] = axis_.band();
    const std::string planes =
        "the cube's planes, " + frequency_text(low, 8) + " to " + frequency_text(high, 8) + in_frame_text(axis_);
    if (!(low > 0))
      throw std::invalid_argument(planes +
                                  ", reach frequencies that are not positive; expected fewer planes, or another --start");
    if (!(high > band_.low_hz && low < band_.high_hz))
      throw std::invalid_argument(planes + ", hold no data; expected planes within " + frequency_text(band_.low_hz, 8) +
                                  " to " + frequency_text(band_.high_hz, 8));
  }

  static constexpr int most_planes = 65536;

  const CubeOptions& o_;
  const ms_io::SpectralWindow& first_;
  Band band_;
  SpectralQuantity start_, width_;
  imager::SpectralAxis axis_;
};

}  // namespace

void declare(CLI::App& command, CubeOptions& o) {
  command
      .add_option("--specmode", o.specmode,
                  "mfs: one image of the whole band; cube: planes of frequency in --outframe; cubedata: planes in the "
                  "frequencies of the data; cubesource: planes in the rest frame of a planet or of an ephemeris' target")
      ->check(CLI::IsMember({"mfs", "cube", "cubedata", "cubesource"}));
  command.add_option("--nchan", o.nchan, "Number of planes of a cube; -1 means up to the end of the data");
  command.add_option("--start", o.start,
                     "First plane: a channel counted among the selected ones of the first window, such as 3, or among all its "
                     "channels, such as 3chan; or a frequency such as 1.4GHz or a velocity such as 20km/s, in --outframe; the "
                     "first selected channel when empty");
  command.add_option(
      "--chanwidth,--width", o.chanwidth,
      "Step from plane to plane, in channels, frequency or velocity, negative to go down; one channel when empty");
  command
      .add_option("--outframe", o.outframe,
                  "Frame of the planes' frequencies: LSRK, LSRD, BARY, GEO, TOPO, GALACTO, LGROUP or CMB; or REST, for data "
                  "that are in the source's rest frame already")
      ->check(values_are({"LSRK", "LSRD", "BARY", "GEO", "TOPO", "GALACTO", "LGROUP", "CMB", "REST"}));
  command
      .add_option("--veltype", o.veltype,
                  "Definition of the velocities of --start and --chanwidth: radio, c (1 - f/restfreq); or optical, c "
                  "(restfreq/f - 1), which also spaces planes evenly in velocity")
      ->check(CLI::IsMember({"radio", "optical"}, CLI::ignore_case));
  command.add_option("--restfreq", o.restfreq,
                     "Rest frequency of the line, to which velocities are relative; headers state it");
  command
      .add_option("--interpolation", o.interpolation,
                  "linear: interpolate visibilities between channels to the planes' frequencies; nearest: take the channels "
                  "within each plane")
      ->check(CLI::IsMember({"linear", "nearest"}));
  command
      .add_option("--perchanweightdensity", o.perchanweightdensity,
                  "true: each plane's weights follow from the density of its own samples; false: from the density of all "
                  "planes' samples")
      ->default_str("true")
      ->check(CLI::IsMember({"true", "false"}, CLI::ignore_case));
}

double rest_frequency_hz(const CubeOptions& o) {
  if (o.restfreq.empty()) return 0;
  double hz = 0;
  try {
    hz = parse_frequency_hz(o.restfreq);
  } catch (const std::invalid_argument&) {  // said below
  }
  if (!(hz > 0) || !has_unit(o.restfreq))
    refuse_option("restfreq", o.restfreq, "a frequency such as 1.420405752GHz, above 0 and with its unit");
  return hz;
}

void check(const CubeOptions& o) {
  const CubeOptions usual;
  const auto only_of_cubes = [&](const char* option, const std::string& value, bool given) {
    if (given && !o.is_cube()) refuse_option(option, value, "--specmode cube beside it");
  };
  only_of_cubes("nchan", std::to_string(o.nchan), o.nchan != usual.nchan);
  only_of_cubes("start", o.start, !o.start.empty());
  only_of_cubes("chanwidth", o.chanwidth, !o.chanwidth.empty());
  const bool other_frame = ms_io::capitals(o.outframe) != usual.outframe;
  only_of_cubes("outframe", o.outframe, other_frame);
  only_of_cubes("veltype", o.veltype, optical(o));
  only_of_cubes("interpolation", o.interpolation, o.interpolation != usual.interpolation);
  only_of_cubes("perchanweightdensity", "false", !o.perchanweightdensity);
  if (o.nchan != -1 && (o.nchan < 1 || o.nchan > 65536)) refuse_option("nchan", std::to_string(o.nchan), "1 to 65536, or -1");
  const SpectralQuantity start = parse("start", o.start), width = parse("chanwidth", o.chanwidth);
  if (width.unit != SpectralUnit::none && width.value == 0) refuse_option("chanwidth", o.chanwidth, "other than 0");
  const double rest_hz = rest_frequency_hz(o);
  for (const auto& [option, given, text] : {std::tuple{"start", start, o.start}, {"chanwidth", width, o.chanwidth}})
    if (given.unit == SpectralUnit::velocity && rest_hz == 0) refuse_option(option, text, "--restfreq beside a velocity");
  if (optical(o) && start.unit != SpectralUnit::velocity && width.unit != SpectralUnit::velocity)
    refuse_option("veltype", o.veltype, "a velocity in --start or --chanwidth beside it");
  if (start.unit == SpectralUnit::channels && start.value < 0) refuse_option("start", o.start, "a channel from 0 on");
  if (o.specmode == "cubedata" && other_frame)
    refuse_option("outframe", o.outframe, "none with --specmode cubedata, whose frequencies stay as they are");
  if (o.specmode == "cubesource" && other_frame && !at_rest(o))
    refuse_option("outframe", o.outframe, "REST or none with --specmode cubesource");
  try {
    plane_frame(o);
  } catch (const std::invalid_argument&) {
    refuse_option("outframe", o.outframe, "LSRK, LSRD, BARY, GEO, TOPO, GALACTO, LGROUP, CMB or REST");
  }
}

imager::Decision axis_decision(const imager::CubeSampling& sampling) {
  const imager::SpectralAxis& axis = sampling.axis;
  const double last = axis.frequency_hz(axis.channels - 1);
  const bool linear = sampling.interpolation == imager::SpectralInterpolation::linear;
  return {"frequencies",
          std::to_string(axis.channels) + (axis.channels == 1 ? " plane" : " planes") + " from " +
              frequency_text(axis.reference_hz, 9) + " to " + frequency_text(last, 9) + in_frame_text(axis) + ", " +
              frequency_text(axis.width_hz(), 6) +
              (axis.in_wavelength ? " the first, and evenly spaced in wavelength" : " each"),
          (linear ? "visibilities are interpolated between channels" : "each takes the channels within it") +
              std::string(axis.frame.empty() ? ", whose frequencies are taken as they are"
                                             : " at each integration's own Doppler shift")};
}

std::string windows_left_out(const imager::SpectralAxis& axis, const std::vector<ms_io::SpectralWindow>& windows) {
  constexpr std::size_t most = 5;
  const auto [low, high] = axis.band();
  std::size_t count = 0;
  std::string text;
  for (const ms_io::SpectralWindow& window : windows) {
    const Band band = band_of({window});
    if (band.high_hz > low && band.low_hz < high) continue;
    if (++count > most) continue;
    text += (text.empty() ? "" : "; ") + std::string("spectral window ") + std::to_string(window.id) + " of " + window.set +
            ", " + frequency_text(band.low_hz, 8) + " to " + frequency_text(band.high_hz, 8);
  }
  if (count == 0) return "";
  const std::string planes =
      "the cube's planes, " + frequency_text(low, 8) + " to " + frequency_text(high, 8) + " in " + axis.frame;
  if (count > most) text += "; and " + std::to_string(count - most) + " more";
  if (count == windows.size())
    throw std::invalid_argument(
        planes + ", hold no data: they lie between windows; expected planes within the windows selected, " + text);
  return "data outside " + planes + ", are left out: " + text;
}

std::string spectral_frame(const CubeOptions& o) {
  if (o.specmode == "cubesource") return "SOURCE";
  return o.specmode == "cube" && !at_rest(o) ? ms_io::parse_spectral_frame(o.outframe) : "";
}

imager::CubeSampling cube_sampling(const CubeOptions& o, const std::vector<ms_io::SpectralWindow>& windows,
                                   const std::string& data_frame) {
  if (o.specmode == "cube" && at_rest(o) && data_frame != "SOURCE")
    refuse_option("outframe", o.outframe,
                  "data at rest in the source, MEAS_FREQ_REF 0, and these are " +
                      (data_frame.empty() ? "in no one frame" : "in " + data_frame) +
                      "; --specmode cubesource converts what has an ephemeris");
  return {AxisMaker(o, windows).make(),
          o.interpolation == "nearest" ? imager::SpectralInterpolation::nearest : imager::SpectralInterpolation::linear};
}

}  // namespace misfit::tools
