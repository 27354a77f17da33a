#pragma once

#include <string>
#include <vector>

#include "imager/data/observation.h"
#include "imager/taylor/taylor_expansion.h"
#include "ms_io/spectral_frame.h"

namespace CLI {
class App;
}

namespace misfit::tools {

struct ImageOptions;

/// Terms of spectra, as typed.
struct TypedTaylor {
  int nterms = 1;
  std::string reffreq;  ///< empty = the middle of the band
};

void declare(CLI::App& command, TypedTaylor& options);

/// Replaces --deconvolver mtmfs by the options that it stands for. To be called before options are checked.
void settle_mtmfs(CLI::App& command, ImageOptions& options);

/// Throws std::invalid_argument that names the option, its value and what was expected.
void check_taylor(const ImageOptions& options);

/// Throws std::runtime_error where data of these windows have fewer frequencies than there are terms to tell apart.
void check_taylor_band(const TypedTaylor& options, const std::vector<ms_io::SpectralWindow>& windows);

/// The expansion about --reffreq or, as in tclean, about the middle of the band imaged, where each sample counts alike.
imager::TaylorExpansion taylor_expansion(const TypedTaylor& options, const imager::Observation& observation);

}  // namespace misfit::tools
