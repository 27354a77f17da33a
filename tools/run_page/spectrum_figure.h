#pragma once

#include <string>
#include <vector>

#include "tools/report/figure.h"

namespace misfit::tools {

/// The spectrum of a cube's planes that have samples, [plane].
struct Spectrum {
  std::string frame;                 ///< of the frequencies
  std::vector<double> frequency_hz;  ///< of the planes' middles
  std::vector<double> brightest_jy;  ///< Jy/beam, the pixel of largest magnitude
  std::vector<double> noise_jy;      ///< Jy/beam
};

/// Both against frequency. For a spectrum of one plane at least.
Figure spectrum_figure(const Spectrum& spectrum);

}  // namespace misfit::tools
