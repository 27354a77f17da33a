#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "imager/data/geometry.h"
#include "ms_io/measurement_set.h"
#include "tools/run/clean_options.h"
#include "tools/run/cube_options.h"
#include "tools/run/gridding_options.h"
#include "tools/run/mosaic_options.h"
#include "tools/run/primary_beam_options.h"
#include "tools/run/scale_options.h"
#include "tools/run/taken_files.h"
#include "tools/run/taylor_options.h"
#include "tools/run/weighting_options.h"

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
  TypedWeighting weighting;
  TypedGridding gridding;
  TypedMosaic mosaic;
  TypedTaylor taylor;
  TypedClean clean;
  TypedPrimaryBeam primary_beam;
  TypedTaken taken;
  bool force_average = false;
  int verify = 0;
  bool check_outside = false;
  int threads = 0;
  double memory_gib = 0;
  std::string products = "needed";  ///< see product_kinds.h
  std::string outformat = "fits";   ///< of images, see image_files.h
  bool dry_run = false;
  ScaleOptions scale;
  bool quiet = false;

  /// True if CLEAN keeps to a mask, given or made.
  bool masks_clean() const { return !clean.mask.empty() || clean.usemask == "auto" || primary_beam.pbmask > 0; }
  /// True if masks need the noise within the primary beam, wherever that is known.
  bool measures_noise_in_beam() const { return clean.runs() && clean.usemask == "auto" && !clean.fastnoise; }
  /// True if pointings become one image; a run decides it where it is left to be chosen.
  bool makes_mosaic() const { return gridding.gridder == "mosaic"; }
  /// True if its images, and its model, are the sky times its primary beam.
  bool makes_flat_noise() const { return makes_mosaic() && mosaic.normtype == "flatnoise"; }
  /// The primary beam below which nothing of a mosaic is cleaned: --pblimit, unless it is below 0; 0 = none.
  double mosaic_limit() const { return makes_mosaic() && primary_beam.pblimit >= 0 ? primary_beam.limit() : 0; }
  bool all_products() const { return products == "tclean"; }
};

/// Declares the options that say which samples make which image, and --threads and --quiet.
void declare_scene(CLI::App& command, ImageOptions& options);

/// Declares all options on `command`.
void declare(CLI::App& command, ImageOptions& options);

/// Sets or images, for messages: "A.ms, B.ms".
std::string names_of(const std::vector<std::string>& paths);

/// The samples of the sets that are imaged, and the direction that they are phased to. Throws std::runtime_error where
/// --phasecenter cannot be understood.
ms_io::Selection selection_of(const ImageOptions& options);

/// Throws std::invalid_argument that names the option, its value and what was expected; std::runtime_error when the kernel is a
/// file that cannot be used. Passes over options that the command requires and that are not given.
void check(const ImageOptions& options);

/// Throws std::invalid_argument for --check-outside where a mosaic is made, which may be known only once sets are opened.
void refuse_outside_of_mosaic(const ImageOptions& options);

imager::ImageGeometry geometry_of(const ImageOptions& options, const imager::SkyDirection& phase_centre);

/// Every option of `command` with the value in force: {name: value}.
nlohmann::json option_values(const CLI::App& command);
/// The option values that matter to states of CLEAN, see OptionMark.
struct StateOptionValues {
  nlohmann::json owners;  ///< that a state belongs to
  nlohmann::json ways;    ///< by which CLEAN goes on
};
StateOptionValues state_option_values(const CLI::App& command);

}  // namespace misfit::tools
