#pragma once

#include <optional>
#include <string>
#include <vector>

#include "imager/beams/beam.h"
#include "imager/data/image.h"

namespace CLI {
class App;
}

namespace misfit::tools {

/// Declares --restoringbeam.
void declare_restoring_beam(CLI::App& command, std::string& typed);

/// The beam that --restoringbeam asks for.
struct WantedBeam {
  std::optional<imager::Beam> given{};  ///< "0.5arcsec" or "0.5arcsec,0.4arcsec,30deg"; nothing: the fitted one
  bool circular = false;                ///< the fitted one, but as wide across as it is long
};

/// Throws as check(const ImageOptions&) does.
WantedBeam restoring_beam(const std::string& typed);

/// The beams of a run.
struct BeamChoice {
  std::optional<imager::Beam> restoring;  ///< that images are restored with
  std::optional<imager::Beam> main_lobe;  ///< of the PSF; where no beam fits it, the given beam
  std::optional<imager::Beam> quadrant;   ///< by WSClean's rule, for comparison; see imager::BeamRegion
  std::string how;                        ///< what `restoring` is: "fitted", "fitted round", "fitted, made circular", "given"
  double misfit = 0;                      ///< RMS of the PSF's main lobe less `restoring`
  std::vector<std::string> warnings;
};

/// The beam that is wanted. If none is, the Gaussian that fits the PSF's main lobe; if none fits, with a warning, the round one
/// that fits. A fit that leaves a tenth of the peak or more is warned of. Where nothing fits and none is given: throws
/// std::runtime_error that says what would help when CLEAN needs a beam, and warns otherwise.
BeamChoice choose_beam(const imager::Image& psf, double cell_rad, const WantedBeam& wanted, bool needed);

}  // namespace misfit::tools
