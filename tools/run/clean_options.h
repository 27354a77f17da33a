#pragma once

#include <string>
#include <vector>

#include "imager/clean/clean.h"
#include "imager/clean/deconvolver.h"

namespace CLI {
class App;
}

namespace misfit::tools {

struct ImageOptions;

/// CLEAN as typed: its deconvolver and depth, masks, what it begins with and leaves.
struct TypedClean {
  std::string deconvolver = "hogbom";
  std::vector<double> scales;  ///< of multiscale, in pixels as tclean means them
  double smallscalebias = 0;
  int niter = 0;
  double gain = 0.1;
  std::string threshold = "0Jy";
  double nsigma = 0;
  double cyclefactor = 1;
  double minpsffraction = 0.05;
  double maxpsffraction = 0.8;
  int cycleniter = -1;
  int nmajor = -1;
  std::string restoringbeam;      ///< see beam_choice.h; empty = the fitted one
  std::vector<std::string> mask;  ///< files, or region text, see mask_file.h, all of which allow pixels; empty = everywhere
  std::string usemask = "user";
  double sidelobethreshold = 3;
  double noisethreshold = 5;
  double lownoisethreshold = 1.5;
  double negativethreshold = 0;
  double smoothfactor = 1;
  double minbeamfrac = 0.3;
  double cutthreshold = 0.01;
  int growiterations = 75;
  bool dogrowprune = true;
  double minpercentchange = -1;
  bool fastnoise = true;
  std::vector<std::string> startmodel;  ///< images in Jy/pixel, of one or of each Taylor term; empty = none
  std::string savemodel = "none";
  bool restart = false;

  /// True if there is a CLEAN, if only of a model to begin with, whose residual and restored image are then made.
  bool runs() const { return niter > 0 || !startmodel.empty(); }
};

void declare(CLI::App& command, TypedClean& options);

/// Throws as check(const ImageOptions&) does.
void check_clean(const ImageOptions& options);

imager::CleanOptions clean_options(const TypedClean& options, int threads);
imager::DeconvolverChoice deconvolver_choice(const TypedClean& options, int threads);

}  // namespace misfit::tools
