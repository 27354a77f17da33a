#pragma once

#include <string>
#include <vector>

#include "tools/report/figure.h"

namespace misfit::tools {

/// What a cube's planes show, [plane], of those that have samples.
struct Spectrum {
  std::string frame;                 ///< of the frequencies
  std::vector<double> frequency_hz;  ///< of the planes' middles
  std::vector<double> brightest_jy;  ///< Jy/beam, the pixel of largest magnitude
  std::vector<double> noise_jy;      ///< Jy/beam
};

/// Both against frequency. For a spectrum of one plane at least.
Figure spectrum_figure(const Spectrum& spectrum);

}  // namespace misfit::tools
