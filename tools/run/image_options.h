#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "imager/data/geometry.h"
#include "ms_io/measurement_set.h"
#include "tools/kernel_choice/kernel_choice.h"
#include "tools/run/cube_options.h"
#include "tools/run/scale_options.h"

namespace CLI {
class App;
}

namespace misfit::tools {

/// Options of `misfit image` as typed; names and meaning are tclean's where the meaning is the same.
struct ImageOptions {
  std::vector<std::string> vis;
  std::string phasecenter;  ///< as ms_io::phased_to() takes it; empty = where the data are phased to
  std::string imagename;
  std::vector<int> imsize;  ///< width, or width and height
  std::string cell;
  ms_io::Selection selection;
  std::string datacolumn = "auto";  ///< as ms_io::MeasurementSet takes it
  std::string stokes = "I";
  CubeOptions cube;
  std::string weighting = "natural";
  double robust = 0.5;  ///< of briggs
  int npixels = 0;      ///< of superuniform, see weighting_options.h; 0 = 6
  std::string uvtaper;  ///< empty = none
  KernelSource kernel;
  double accuracy = 1e-6;
  double psf_accuracy = 0;  ///< 0 = the larger of accuracy and 1e-4
  int kernel_width = 0;
  double padding = 0;
  std::string evaluation = "polynomial";
  int sampling = 0;  ///< entries a cell of a table; 0 = none
  std::string precision = "auto";
  std::string gridder = "auto";
  std::string deconvolver = "hogbom";
  std::vector<double> scales;  ///< of multiscale, in pixels as tclean means them
  double smallscalebias = 0;
  int nterms = 1;
  std::string reffreq;  ///< of the Taylor terms; empty = the middle of the band
  int niter = 0;
  double gain = 0.1;
  std::string threshold = "0Jy";
  double nsigma = 0;
  double cyclefactor = 1;
  double minpsffraction = 0.05;
  double maxpsffraction = 0.8;
  int cycleniter = -1;
  int nmajor = -1;
  std::string restoringbeam;  ///< empty = the fitted one
  std::string mask;           ///< a file, or region text, see mask_file.h; empty = everywhere
  std::string usemask = "user";
  double sidelobethreshold = 3;
  double noisethreshold = 5;
  double lownoisethreshold = 1.5;
  double minbeamfrac = 0.3;
  int growiterations = 75;
  std::vector<std::string> startmodel;  ///< images in Jy/pixel, of one or of each Taylor term; empty = none
  std::string savemodel = "none";
  bool restart = false;
  bool force_average = false;
  bool pbcor = false;
  double pblimit = 0;  ///< 0: not given, and 0.2 with pbcor; its sign makes no difference
  int verify = 0;
  bool check_outside = false;
  int threads = 0;
  double memory_gib = 0;
  std::string outformat = "fits";  ///< of images, see image_files.h
  bool dry_run = false;
  ScaleOptions scale;
  bool quiet = false;
};

/// Declares the options that say which samples make which image, and --threads and --quiet.
void declare_scene(CLI::App& command, ImageOptions& options);

/// Declares all options on `command`.
void declare(CLI::App& command, ImageOptions& options);

/// Sets or images, for messages: "A.ms, B.ms".
std::string names_of(const std::vector<std::string>& paths);

/// What of the sets is imaged, and where it is phased to. Throws std::runtime_error where --phasecenter cannot be understood.
ms_io::Selection selection_of(const ImageOptions& options);

/// Throws std::invalid_argument that names the option, its value and what was expected; std::runtime_error when the kernel is a
/// file that cannot be used. Passes over options that the command requires and that are not given.
void check(const ImageOptions& options);

imager::ImageGeometry geometry_of(const ImageOptions& options, const imager::SkyDirection& phase_centre);

/// Every option of `command` with the value in force: {name: value}.
nlohmann::json option_values(const CLI::App& command);
/// Those of them that a state of CLEAN belongs to, see OptionMark.
nlohmann::json state_option_values(const CLI::App& command);

}  // namespace misfit::tools
