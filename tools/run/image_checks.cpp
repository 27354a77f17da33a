#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <stdexcept>

#include "imager/data/stokes.h"
#include "imager/plan/gridding_plan.h"
#include "kernels/kernel_table.h"
#include "tools/base/option_checks.h"
#include "tools/base/quantity.h"
#include "tools/run/image_options.h"
#include "tools/run/model_stage.h"
#include "tools/run/taylor_options.h"
#include "tools/run/weighting_options.h"

namespace misfit::tools {
namespace {

constexpr int largest_side = 65536;  ///< of an image, in pixels

void check_sets(const ImageOptions& o) {
  std::set<std::filesystem::path> met;
  for (const std::string& name : o.vis) {
    const std::filesystem::path path = std::filesystem::weakly_canonical(name);
    if (!met.insert(path.has_filename() ? path : path.parent_path()).second) refuse_option("vis", name, "each set once");
  }
}

void check_image(const ImageOptions& o) {
  check_sets(o);
  const std::string name = std::filesystem::path(o.imagename).filename();
  if ((name.empty() && !o.imagename.empty()) || name == "." || name == "..")
    refuse_option("imagename", "'" + o.imagename + "'", "a name for files to begin with, not a folder");
  for (const int size : o.imsize)
    if (size < 1 || size > largest_side) refuse_option("imsize", std::to_string(size), "1 to 65536 pixels");
  for (const imager::Stokes stokes : imager::parse_stokes(o.stokes))
    if (stokes == imager::Stokes::XY || stokes == imager::Stokes::YX || stokes == imager::Stokes::RL ||
        stokes == imager::Stokes::LR)
      refuse_option("stokes", o.stokes, "no crossed hands, which are complex on the sky: Q, U and V show their parts");
  if (o.cell.empty()) return;
  if (!(parse_angle_rad(o.cell) > 0)) refuse_option("cell", o.cell, "an angle above 0");
  if (parse_angle_rad(o.cell) > 0.5) refuse_option("cell", o.cell, "less than 0.5 rad");
}

/// What is done with one plane of frequency alone.
void check_cube(const ImageOptions& o) {
  if (!o.cube.is_cube()) return;
  if (!o.cube.perchanweightdensity && o.weighting == "natural")
    refuse_option("perchanweightdensity", "false", "weights by density beside it, such as --weighting briggs");
  if (o.savemodel != "none") refuse_option("savemodel", o.savemodel, "none with --specmode cube");
  if (o.check_outside) refuse_option("check-outside", "true", "--specmode mfs beside it");
  if (o.nterms > 1) refuse_option("nterms", std::to_string(o.nterms), "1 with --specmode cube");
}

/// In pixels; the largest that there can be where none is given.
int smallest_side(const ImageOptions& o) {
  return o.imsize.empty() ? largest_side : *std::min_element(o.imsize.begin(), o.imsize.end());
}

void check_deconvolver(const ImageOptions& o) {
  const bool multiscale = o.deconvolver == "multiscale";
  const std::string scales = o.scales.empty() ? "" : typed(o.scales.front()) + " …";
  if (!multiscale && !o.scales.empty()) refuse_option("scales", scales, "--deconvolver multiscale beside it");
  if (!multiscale && o.smallscalebias != 0)
    refuse_option("smallscalebias", typed(o.smallscalebias), "--deconvolver multiscale beside it");
  if (multiscale && o.scales.empty()) refuse_option("deconvolver", o.deconvolver, "--scales beside it, such as 0,5,15");
  for (std::size_t i = 0; i < o.scales.size(); ++i)
    if (!(o.scales[i] >= 0 && o.scales[i] <= smallest_side(o)) || (i > 0 && !(o.scales[i] > o.scales[i - 1])) ||
        (o.scales[i] > 0 && o.scales[i] < 3))
      refuse_option("scales", typed(o.scales[i]), "pixels in ascending order, each 0 or from 3 to the image's size");
  if (!(o.smallscalebias >= 0 && o.smallscalebias < 1))
    refuse_option("smallscalebias", typed(o.smallscalebias), "0 or more, and below 1");
}

void check_auto_mask(const ImageOptions& o) {
  if (o.usemask == "auto" && o.niter == 0) refuse_option("usemask", o.usemask, "--niter above 0 beside it");
  if (o.usemask == "auto" && !o.mask.empty()) refuse_option("mask", o.mask, "--usemask user, or no mask");
  if (!(o.sidelobethreshold >= 0)) refuse_option("sidelobethreshold", typed(o.sidelobethreshold), "0 or more");
  if (!(o.noisethreshold > 0)) refuse_option("noisethreshold", typed(o.noisethreshold), "more than 0");
  if (!(o.lownoisethreshold > 0 && o.lownoisethreshold <= o.noisethreshold))
    refuse_option("lownoisethreshold", typed(o.lownoisethreshold), "more than 0 and at most noisethreshold");
  if (!(o.minbeamfrac >= 0)) refuse_option("minbeamfrac", typed(o.minbeamfrac), "0 or more");
  if (o.growiterations < 0) refuse_option("growiterations", std::to_string(o.growiterations), "0 or more");
}

void check_clean(const ImageOptions& o) {
  if (!(parse_flux_jy(o.threshold) >= 0)) refuse_option("threshold", o.threshold, "0 or more");  // as it was typed
  imager::check(clean_options(o, 1), "--");
  if (restoring_beam(o) && o.niter == 0) refuse_option("restoringbeam", o.restoringbeam, "--niter above 0 beside it");
  const int smallest = smallest_side(o);
  if (o.niter > 0 && smallest < 3 && !restoring_beam(o))
    refuse_option("imsize", std::to_string(smallest), "3 pixels or more to fit a beam to, or --restoringbeam");
  if (!o.startmodel.empty() && o.niter == 0) refuse_option("startmodel", o.startmodel, "--niter above 0 beside it");
  if (o.savemodel != "none" && !saves_model(imager::parse_stokes(o.stokes)))
    refuse_option(
        "savemodel", o.savemodel,
        "--stokes of I, Q, U and V, or of parallel hands, such as XXYY or RR, of which a column's correlations are made");
  if (o.savemodel != "none" && o.niter == 0) refuse_option("savemodel", o.savemodel, "--niter above 0 beside it");
  if (!o.mask.empty() && o.niter == 0) refuse_option("mask", o.mask, "--niter above 0 beside it");
  if (o.restart && o.niter == 0) refuse_option("restart", "true", "--niter above 0 beside it");
  check_deconvolver(o);
  check_taylor(o);
  check_auto_mask(o);
}

void check_tables(const ImageOptions& o) {
  const std::optional<kernels::TableOptions> lookup = lookup_of(o);
  constexpr int most = kernels::kernel_table_max_per_cell;
  if (lookup && !(o.sampling >= 1 && o.sampling <= most))
    refuse_option("sampling", std::to_string(o.sampling),
                  "1 to " + std::to_string(most) + " entries a cell beside --evaluation " + o.evaluation);
  if (!lookup && o.sampling != 0)
    refuse_option("sampling", std::to_string(o.sampling), "--evaluation nearest, linear, quadratic or cubic beside it");
}

/// What needs neither the data nor the kernel's solution.
void check_gridding(const ImageOptions& o) {
  check_tables(o);
  const bool accuracy_is_free = kernel_is_given(o);
  if (!(o.accuracy > 0 && o.accuracy < 1) && !(o.accuracy == 0 && accuracy_is_free))
    refuse_option("accuracy", typed(o.accuracy), "a number above 0 and below 1");
  if (!(o.psf_accuracy >= 0 && o.psf_accuracy < 1))
    refuse_option("psf-accuracy", typed(o.psf_accuracy), "a number above 0 and below 1, or 0 (chosen)");
  if (o.psf_accuracy != 0 && o.accuracy == 0)
    refuse_option("psf-accuracy", typed(o.psf_accuracy), "--accuracy beside it, since the kernel given decides otherwise");
  imager::check_request(gridding_request(o, 1));
}

}  // namespace

void check(const ImageOptions& o) {
  check_image(o);
  check(o.cube);
  check_cube(o);
  check_weighting(o);
  check_clean(o);
  check_gridding(o);
  if (!(std::abs(o.pblimit) < 1)) refuse_option("pblimit", typed(o.pblimit), "a number between 0 and 1, such as 0.2");
  check(o.scale, o.dry_run);
  if (o.verify < 0) refuse_option("verify", std::to_string(o.verify), "0 or more");
  if (o.threads < 0) refuse_option("threads", std::to_string(o.threads), "0 (all cores) or more");
  if (!(o.memory_gib >= 0 && std::isfinite(o.memory_gib)))
    refuse_option("memory", typed(o.memory_gib), "0 (half of the machine's memory) or more, in GiB");
}

}  // namespace misfit::tools
