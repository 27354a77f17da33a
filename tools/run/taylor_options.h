#pragma once

#include <string>
#include <vector>

#include "imager/data/observation.h"
#include "imager/taylor/taylor_expansion.h"
#include "ms_io/spectral_frame.h"
#include "tools/run/image_options.h"

namespace misfit::tools {

/// Declares --nterms and --reffreq.
void declare_taylor(CLI::App& command, ImageOptions& options);

/// Throws std::invalid_argument that names the option, its value and what was expected.
void check_taylor(const ImageOptions& options);

/// Throws std::runtime_error where data of these windows have fewer frequencies than there are terms to tell apart.
void check_taylor_band(const ImageOptions& options, const std::vector<ms_io::SpectralWindow>& windows);

/// About --reffreq, or the middle of the band imaged, where each sample counts alike: as tclean has it.
imager::TaylorExpansion taylor_expansion(const ImageOptions& options, const imager::Observation& observation);

/// The names of images between <imagename> and .fits that runs of several Taylor terms write, as tclean's: psf.tt0, alpha, …
/// Those of a run of one term are none.
std::vector<std::string> taylor_products(int terms, bool cleaned);

/// The same of what --pblimit and --pbcor write besides: the beam's terms, and where images are `corrected` those of the sky.
std::vector<std::string> taylor_beam_products(int terms, bool cleaned, bool corrected);

}  // namespace misfit::tools
