#include "tools/run_page/spectrum_figure.h"

namespace misfit::tools {

Figure spectrum_figure(const Spectrum& spectrum) {
  std::vector<double> ghz;
  for (const double hz : spectrum.frequency_hz) ghz.push_back(hz / 1e9);
  const bool few = ghz.size() < 20;
  const auto series = [&](const std::string& label, const std::vector<double>& y) {
    return Series{.label = label, .x = ghz, .y = y, .points = few};
  };
  return {.name = "spectrum",
          .title = "Planes",
          .caption = "",
          .x = {.label = "Frequency in GHz" + (spectrum.frame.empty() ? "" : ", " + spectrum.frame)},
          .y = {.label = "Jy/beam"},
          .series = {series("brightest pixel", spectrum.brightest_jy), series("noise", spectrum.noise_jy)}};
}

}  // namespace misfit::tools
