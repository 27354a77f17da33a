#include "tools/run/image_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "imager/data/stokes.h"
#include "imager/plan/gridding_plan.h"
#include "kernels/kernel_table.h"
#include "ms_io/phase_centre.h"
#include "tools/base/option_checks.h"
#include "tools/base/quantity.h"
#include "tools/base/text.h"
#include "tools/formats/config_file.h"
#include "tools/run/image_files.h"
#include "tools/run/selection_options.h"
#include "tools/run/taylor_options.h"
#include "tools/run/weighting_options.h"

namespace misfit::tools {

void declare_scene(CLI::App& command, ImageOptions& o) {
  command.add_option("--vis", o.vis, "MeasurementSet, or several for one image; opened read-only, but to save a model")
      ->required()
      ->type_name(folder_type);
  command.add_option(
      "--phasecenter", o.phasecenter,
      "Shift the visibilities to a direction, such as 'J2000 12h30m49.4s +12d23m28s', or to the phase centre of a "
      "field by id or name; what is selected may then have several. TRACKFIELD: to what fields with an ephemeris follow");
  command.add_option("--imsize", o.imsize, "Width, or width and height, in pixels")->required()->expected(1, 2);
  command.add_option("--cell", o.cell, "Size of a pixel: 0.2arcsec, 3mas, …; in arcsec without a unit")
      ->required()
      ->check(quantity(parse_angle_rad));
  declare_selection(command, o.selection);
  command
      .add_option("--datacolumn", o.datacolumn,
                  "auto (CORRECTED_DATA where a set has it, else DATA), data, corrected, model, or a column's name; or one for "
                  "each set: corrected,data")
      ->check(values_are({"auto", "data", "corrected", "model"}, Others::possible));
  command.add_flag("--force-average", o.force_average,
                   "Average fields whose antennas pointed apart even where the image's centre lies beyond the first null of "
                   "one's beam, which dims what the others see; without it they are refused by name");
  declare_weighting(command, o);
  command.add_option("--gridder", o.gridder, "w planes: auto (where w matters), standard (none), wide (always)")
      ->check(CLI::IsMember({"auto", "standard", "wide"}));
  command.add_option("--threads", o.threads, "Threads; 0 means all cores");
  command.add_flag("--quiet", o.quiet, "Print nothing but errors");
}

std::string names_of(const std::vector<std::string>& vis) {
  std::string names;
  for (const std::string& name : vis) names += (names.empty() ? "" : ", ") + name;
  return names;
}

ms_io::Selection selection_of(const ImageOptions& o) {
  ms_io::Selection selection = o.selection;
  if (o.cube.is_cube()) selection.spectral_frame = ms_io::parse_spectral_frame(o.cube.outframe);
  return o.phasecenter.empty() ? selection : ms_io::phased_to(selection, o.phasecenter, o.vis);
}

void declare(CLI::App& command, ImageOptions& o) {
  declare_scene(command, o);
  command.add_option("--imagename", o.imagename, "Names of the output files begin with this")
      ->required()
      ->type_name(path_type)
      ->check(not_empty());
  command.add_option("--stokes", o.stokes,
                     "Stokes parameters, or correlations of parallel hands, which share one PSF: I, IQUV, IV, XXYY, RR, …");
  declare(command, o.cube);
  list_kernels(*command.add_option("--kernel", o.kernel.name,
                                   "Gridding function: a name such as least-misfit or spheroidal, or a kernel-table file"));
  declare_kernel_folder(command, o.kernel.folder);
  command.add_option("--accuracy", o.accuracy,
                     "Largest error of the whole image relative to the direct transform, RMS over RMS");
  command.add_option("--psf-accuracy", o.psf_accuracy, "The same of the PSF; 0 = the larger of --accuracy and 1e-4");
  command.add_option("--kernel-width", o.kernel_width, "Cells a visibility touches per axis; chosen when 0");
  command.add_option("--padding", o.padding, "FFT size over image size; chosen when 0");
  command
      .add_option("--evaluation", o.evaluation,
                  "Kernel values from: polynomial, as short as the kernel's error allows; full polynomial; or a table, read "
                  "by interpolation (with --sampling)")
      ->check(CLI::IsMember({"polynomial", "full", "nearest", "linear", "quadratic", "cubic"}));
  command.add_option("--sampling", o.sampling, "Entries a cell of a table of kernel values");
  command.add_option("--precision", o.precision, "Of kernel values, grid and FFT: auto, single, double")
      ->check(CLI::IsMember({"auto", "single", "double"}));
  command.add_option("--deconvolver", o.deconvolver, "How components are found: hogbom, clark or multiscale")
      ->check(CLI::IsMember(imager::deconvolver_names()));
  command
      .add_option("--scales", o.scales,
                  "Of multiscale, in pixels: 0,5,15. As wide at half maximum as tclean's, 0.74 of the number; 0 = points")
      ->delimiter(',');
  command.add_option("--smallscalebias", o.smallscalebias, "The largest scale counts this part less than points");
  declare_taylor(command, o);
  command.add_option("--niter", o.niter, "CLEAN components to find at most; 0 makes the dirty image");
  command.add_option("--gain", o.gain, "Part of a peak that a component takes");
  command
      .add_option("--threshold", o.threshold,
                  "Stop when the peak residual reaches this flux density, to 1%; in Jy without a unit")
      ->check(quantity(parse_flux_jy));
  command.add_option("--nsigma", o.nsigma, "Stop when it reaches this many times the noise; 0 = never");
  command.add_option("--cyclefactor", o.cyclefactor, "Minor cycles go down to the peak times the largest sidelobe times this");
  command.add_option("--minpsffraction", o.minpsffraction, "… at most this deep, as a part of the peak");
  command.add_option("--maxpsffraction", o.maxpsffraction, "… and at least this deep");
  command.add_option("--cycleniter", o.cycleniter, "Components that a minor cycle finds at most; -1 = no limit");
  command.add_option("--nmajor", o.nmajor, "Major cycles at most; -1 = no limit");
  command
      .add_option(
          "--restoringbeam", o.restoringbeam,
          "Restore with this beam: MAJ, or MAJ,MIN,PA such as 0.5arcsec,0.4arcsec,30deg; the fitted one when empty or common")
      ->check(values_are({"common"}, Others::possible));
  command
      .add_option(
          "--mask", o.mask,
          "Where CLEAN finds components: a FITS or CASA image, not 0 there, wherever its coordinates have it, or a "
          "region file of CASA (CRTF), CARTA or DS9, or one region itself, such as 'circle [[100pix, 80pix], 20pix]'; CRTF "
          "may name planes: corr=[I, Q], range=[3chan, 7chan]")
      ->type_name(file_type);
  command
      .add_option("--usemask", o.usemask, "user: --mask, or everywhere; auto: from the residuals, as tclean's auto-multithresh")
      ->check(CLI::IsMember({"user", "auto"}));
  command.add_option("--sidelobethreshold", o.sidelobethreshold,
                     "auto: above this times the largest sidelobe times the peak …");
  command.add_option("--noisethreshold", o.noisethreshold, "… and above this times the noise");
  command.add_option("--lownoisethreshold", o.lownoisethreshold, "… grown down to this times the noise");
  command.add_option("--minbeamfrac", o.minbeamfrac, "… without regions below this part of the beam's area");
  command.add_option("--growiterations", o.growiterations, "… by this many pixels a major cycle at most");
  command
      .add_option("--startmodel", o.startmodel,
                  "Begin with this model, a FITS or CASA image in Jy/pixel of the same pixels, and of one Taylor term")
      ->type_name(file_type);
  command.add_option("--savemodel", o.savemodel, "modelcolumn: write the model's visibilities into MODEL_DATA; none")
      ->check(CLI::IsMember({"none", "modelcolumn"}));
  command.add_flag("--restart", o.restart,
                   "Go on from the last major cycle of a run that was cut, or ended, with these options");
  command.add_flag(
      "--pbcor", o.pbcor,
      "Write .image.pbcor too, the image divided by the antennas' primary beam, and .pb, the beam: Airy discs, for "
      "dishes that point alike. With --nterms 2 or 3 each term is divided by the beam's own spectrum too: .image.tt0.pbcor, "
      ".image.tt1.pbcor, …, .alpha.pbcor and .beta.pbcor");
  command.add_option("--pblimit", o.pblimit,
                     "Where the primary beam is lower, .pb and .image.pbcor have no values; 0.2 when 0. Without --pbcor .pb "
                     "alone is written. The sign makes no difference, since no other image is masked");
  command.add_option("--verify", o.verify,
                     "Compare this many random pixels, or all of a smaller image, and visibilities with the direct transform");
  command.add_flag("--check-outside", o.check_outside,
                   "Look for sources outside the image, in four times its field, whose aliases may exceed its noise");
  command.add_option("--memory", o.memory_gib, "GiB that the run may take; 0 means half of the machine's memory");
  command.add_option("--outformat", o.outformat, "Images as files of: fits, casa, both")->check(CLI::IsMember(image_formats()));
  command.add_flag("--dry-run", o.dry_run, "Print the plan and the memory it takes; read no visibilities and write nothing");
  declare(command, o.scale);
}

bool kernel_is_given(const ImageOptions& o) {
  return is_kernel_file(o.kernel) || (o.kernel_width != 0 && o.padding != 0);
}

std::optional<kernels::TableOptions> lookup_of(const ImageOptions& o) {
  const auto& names = kernels::interpolation_names;
  const auto found = std::find(names.begin(), names.end(), o.evaluation);
  if (found == names.end()) return {};
  return kernels::TableOptions{o.sampling, static_cast<kernels::Interpolation>(found - names.begin())};
}

imager::ImageGeometry geometry_of(const ImageOptions& o, const imager::SkyDirection& phase_centre) {
  return {o.imsize.front(), o.imsize.back(), parse_angle_rad(o.cell), phase_centre};
}

imager::GriddingRequest gridding_request(const ImageOptions& o, int threads) {
  imager::GriddingRequest request;
  request.accuracy = o.accuracy;
  constexpr double enough = 1e-4;  // to steer minor cycles
  request.psf_accuracy = o.psf_accuracy != 0 ? o.psf_accuracy : std::max(o.accuracy, enough);
  request.kernel = choose_kernel(o.kernel);
  request.kernel_width = o.kernel_width;
  request.padding = o.padding;
  request.gridder = o.gridder == "standard" ? imager::Gridder::standard
                    : o.gridder == "wide"   ? imager::Gridder::wide
                                            : imager::Gridder::automatic;
  request.lookup = lookup_of(o);
  request.shortest_polynomials = o.evaluation != "full";
  if (o.precision != "auto")
    request.precision = o.precision == "single" ? imager::Precision::single_precision : imager::Precision::double_precision;
  request.threads = threads;
  return request;
}

std::optional<imager::Beam> restoring_beam(const ImageOptions& o) {
  if (o.restoringbeam.empty() || o.restoringbeam == "common") return std::nullopt;
  const auto expect = [&](bool holds) {
    if (!holds)
      refuse_option("restoringbeam", o.restoringbeam,
                    "common, MAJ, or MAJ,MIN,PA such as 0.5arcsec,0.4arcsec,30deg with MAJ at least MIN, and MIN above 0");
  };
  const auto angle = [&](std::string_view part) {
    const std::string text(part);
    expect(has_unit(text) && quantity(parse_angle_rad)(text).empty());
    return parse_angle_rad(text);
  };
  const std::vector<std::string_view> parts = split_at_commas(o.restoringbeam);
  expect(parts.size() == 1 || parts.size() == 3);
  imager::Beam beam;
  beam.major_rad = angle(parts[0]);
  beam.minor_rad = parts.size() == 1 ? beam.major_rad : angle(parts[1]);
  // Half a turn leaves the ellipse as it is.
  beam.position_angle_rad = parts.size() == 1 ? 0 : std::remainder(angle(parts[2]), M_PI);
  expect(beam.minor_rad > 0 && beam.major_rad >= beam.minor_rad && beam.major_rad < 1);
  return beam;
}

imager::CleanOptions clean_options(const ImageOptions& o, int threads) {
  imager::CleanOptions clean;
  clean.max_iterations = o.niter;
  clean.gain = o.gain;
  clean.threshold_jy = parse_flux_jy(o.threshold);
  clean.nsigma = o.nsigma;
  clean.cycle_factor = o.cyclefactor;
  clean.min_psf_fraction = o.minpsffraction;
  clean.max_psf_fraction = o.maxpsffraction;
  clean.cycle_iterations = o.cycleniter;
  clean.max_major_cycles = o.nmajor;
  clean.threads = threads;
  if (o.usemask == "auto")
    clean.automask = imager::AutoMaskOptions{.sidelobe_threshold = o.sidelobethreshold,
                                             .noise_threshold = o.noisethreshold,
                                             .low_noise_threshold = o.lownoisethreshold,
                                             .min_beam_fraction = o.minbeamfrac,
                                             .grow_iterations = o.growiterations};
  return clean;
}

imager::DeconvolverChoice deconvolver_choice(const ImageOptions& o, int threads) {
  imager::DeconvolverChoice choice;
  choice.name = o.deconvolver;
  choice.scale_pixels.clear();
  for (const double scale : o.scales) choice.scale_pixels.push_back(imager::tclean_scale_width * scale);
  choice.small_scale_bias = o.smallscalebias;
  choice.threads = threads;
  return choice;
}

nlohmann::json option_values(const CLI::App& command) {
  nlohmann::json values = nlohmann::json::object();
  for (const auto& [name, value] : options_in_force(command)) values[name] = value;
  return values;
}

}  // namespace misfit::tools
