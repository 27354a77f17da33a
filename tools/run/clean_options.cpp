#include "tools/run/clean_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <limits>

#include "imager/data/stokes.h"
#include "tools/base/option_checks.h"
#include "tools/base/quantity.h"
#include "tools/run/beam_choice.h"
#include "tools/run/image_options.h"
#include "tools/run/model_stage.h"

namespace misfit::tools {
namespace {

constexpr int most_masks = 1000;

/// The image's smaller side in pixels; the largest possible side where none is given.
int smallest_side(const ImageOptions& o) {
  return o.imsize.empty() ? std::numeric_limits<int>::max() : *std::min_element(o.imsize.begin(), o.imsize.end());
}

void check_deconvolver(const TypedClean& o, int smallest_side) {
  const bool multiscale = o.deconvolver == "multiscale";
  const std::string scales = o.scales.empty() ? "" : typed(o.scales.front()) + " …";
  if (!multiscale && !o.scales.empty()) refuse_option("scales", scales, "--deconvolver multiscale beside it");
  if (!multiscale && o.smallscalebias != 0)
    refuse_option("smallscalebias", typed(o.smallscalebias), "--deconvolver multiscale beside it");
  if (multiscale && o.scales.empty()) refuse_option("deconvolver", o.deconvolver, "--scales beside it, such as 0,5,15");
  for (std::size_t i = 0; i < o.scales.size(); ++i)
    if (!(o.scales[i] >= 0 && o.scales[i] <= smallest_side) || (i > 0 && !(o.scales[i] > o.scales[i - 1])) ||
        (o.scales[i] > 0 && o.scales[i] < 3))
      refuse_option("scales", typed(o.scales[i]), "pixels in ascending order, each 0 or from 3 to the image's size");
  if (!(o.smallscalebias >= 0 && o.smallscalebias < 1))
    refuse_option("smallscalebias", typed(o.smallscalebias), "0 or more, and below 1");
}

void check_auto_mask(const TypedClean& o) {
  if (o.usemask == "auto" && o.niter == 0) refuse_option("usemask", o.usemask, "--niter above 0 beside it");
  if (o.usemask == "auto" && !o.mask.empty()) refuse_option("mask", names_of(o.mask), "--usemask user, or no mask");
  if (!(o.sidelobethreshold >= 0)) refuse_option("sidelobethreshold", typed(o.sidelobethreshold), "0 or more");
  if (!(o.noisethreshold > 0)) refuse_option("noisethreshold", typed(o.noisethreshold), "more than 0");
  if (!(o.lownoisethreshold > 0 && o.lownoisethreshold <= o.noisethreshold))
    refuse_option("lownoisethreshold", typed(o.lownoisethreshold), "more than 0 and at most noisethreshold");
  if (!(o.minbeamfrac >= 0)) refuse_option("minbeamfrac", typed(o.minbeamfrac), "0 or more");
  if (!(o.negativethreshold >= 0)) refuse_option("negativethreshold", typed(o.negativethreshold), "0 (none) or more");
  if (!(o.smoothfactor >= 0)) refuse_option("smoothfactor", typed(o.smoothfactor), "0 or more");
  if (!(o.cutthreshold >= 0 && o.cutthreshold < 1))
    refuse_option("cutthreshold", typed(o.cutthreshold), "0 or more, and below 1");
  if (!(o.minpercentchange <= 100)) refuse_option("minpercentchange", typed(o.minpercentchange), "-1 (never) to 100");
  if (o.growiterations < 0) refuse_option("growiterations", std::to_string(o.growiterations), "0 or more");
}

}  // namespace

void declare(CLI::App& command, TypedClean& o) {
  std::vector<std::string> deconvolvers = imager::deconvolver_names();
  deconvolvers.emplace_back("mtmfs");
  mark(command
           .add_option("--deconvolver", o.deconvolver,
                       "Method of CLEAN: hogbom, clark or multiscale; or mtmfs with --nterms, 2 unless given, which is "
                       "multiscale if there are --scales, else hogbom")
           ->check(CLI::IsMember(deconvolvers)),
       OptionMark::way_of_clean);
  mark(command
           .add_option("--scales", o.scales,
                       "Scales of multiscale in pixels, such as 0,5,15; 0 means points. As in tclean, the full width at half "
                       "maximum is 0.74 times the number")
           ->delimiter(','),
       OptionMark::way_of_clean);
  mark(command.add_option("--smallscalebias", o.smallscalebias,
                          "Part, 0 or more and below 1, by which multiscale lowers the merit of the largest scale; smaller "
                          "scales are lowered in proportion, points not at all"),
       OptionMark::way_of_clean);
  mark(command.add_option(
           "--niter", o.niter,
           "Largest number of CLEAN components; 0 makes the dirty image, or with --startmodel the residual of that model"),
       OptionMark::free_of_state);
  mark(command.add_option("--gain", o.gain, "Part of a peak that a component takes away"), OptionMark::way_of_clean);
  mark(command
           .add_option("--threshold", o.threshold,
                       "Stop when the peak residual reaches this flux density, to within 1%; Jy without a unit")
           ->check(quantity(parse_flux_jy)),
       OptionMark::free_of_state);
  mark(command.add_option("--nsigma", o.nsigma, "Stop when the peak residual reaches this many times the noise; 0 means never"),
       OptionMark::free_of_state);
  mark(command.add_option(
           "--cyclefactor", o.cyclefactor,
           "A minor cycle goes down to the peak residual times the PSF's largest sidelobe times this factor. It goes on deeper "
           "while this factor times the sidelobes of the components found is fainter than the residual's peak"),
       OptionMark::way_of_clean);
  mark(
      command.add_option("--minpsffraction", o.minpsffraction, "Minor cycles go no deeper than this part of the peak residual"),
      OptionMark::way_of_clean);
  mark(command.add_option(
           "--maxpsffraction", o.maxpsffraction,
           "Minor cycles go at least as deep as this part of the peak residual; not as deep after a cycle that diverged"),
       OptionMark::way_of_clean);
  mark(command.add_option("--cycleniter", o.cycleniter,
                          "Largest number of components that a minor cycle finds; -1 means no limit"),
       OptionMark::way_of_clean);
  mark(command.add_option("--nmajor", o.nmajor, "Largest number of major cycles; -1 means no limit"),
       OptionMark::free_of_state);
  declare_restoring_beam(command, o.restoringbeam);
  mark(mark(command
                .add_option("--mask", o.mask,
                            "Find components only where one of these masks allows it: FITS or CASA images, which allow the "
                            "places where they are not 0; region files of CASA (CRTF), CARTA or DS9; or a region itself, such "
                            "as 'circle [[100pix, 80pix], 20pix]'. CRTF may name planes: corr=[I, Q], range=[3chan, 7chan]")
                ->expected(1, most_masks)
                ->type_name(file_type),
            OptionMark::way_of_clean),
       OptionMark::one_or_each);
  mark(command
           .add_option("--usemask", o.usemask,
                       "user: find components in --mask, or everywhere without it; pb: where the primary beam is at least "
                       "--pbmask; auto: in a mask that is made from the residuals, as by tclean's auto-multithresh")
           ->transform(also_named({{"auto-multithresh", "auto"}}))
           ->check(CLI::IsMember({"user", "auto", "pb"})),
       OptionMark::way_of_clean);
  mark(command.add_option("--sidelobethreshold", o.sidelobethreshold,
                          "auto: new regions exceed this factor times the largest sidelobe times the peak"),
       OptionMark::way_of_clean);
  mark(command.add_option("--noisethreshold", o.noisethreshold, "auto: new regions exceed this many times the noise"),
       OptionMark::way_of_clean);
  mark(command.add_option("--lownoisethreshold", o.lownoisethreshold,
                          "auto: regions grow into pixels that exceed this many times the noise"),
       OptionMark::way_of_clean);
  mark(
      command.add_option("--minbeamfrac", o.minbeamfrac, "auto: regions smaller than this part of the beam's area are dropped"),
      OptionMark::way_of_clean);
  mark(command.add_option("--growiterations", o.growiterations,
                          "auto: regions grow by at most this many pixels in a major cycle"),
       OptionMark::way_of_clean);
  const auto either = [](CLI::Option* option) {
    mark(option->default_str("true")->check(CLI::IsMember({"true", "false"}, CLI::ignore_case)), OptionMark::way_of_clean);
  };
  either(command.add_option("--dogrowprune", o.dogrowprune, "auto: --minbeamfrac applies to grown regions too"));
  mark(command.add_option("--smoothfactor", o.smoothfactor,
                          "auto: regions are smoothed by the beam, widened by this factor; 0 means no smoothing"),
       OptionMark::way_of_clean);
  mark(command.add_option("--cutthreshold", o.cutthreshold,
                          "auto: smoothed regions are cut at this part of their largest value"),
       OptionMark::way_of_clean);
  mark(command.add_option(
           "--negativethreshold", o.negativethreshold,
           "auto: absorption deeper than this many times the noise is in the mask too; 0 means that no absorption is"),
       OptionMark::way_of_clean);
  mark(command.add_option("--minpercentchange", o.minpercentchange,
                          "auto: once minor cycles go down to --threshold or --nsigma, a mask whose threshold follows from the "
                          "noise is final if it grows by less than this percentage; -1 means never"),
       OptionMark::way_of_clean);
  either(command.add_option(
      "--fastnoise", o.fastnoise,
      "true: auto measures the noise in all pixels; false: in pixels outside the mask and, if the primary beam is known, "
      "inside --pblimit and --pbmask; while there is no mask, in pixels that Chauvenet's criterion leaves"));
  command
      .add_option("--startmodel", o.startmodel,
                  "Begin with this model, a FITS or CASA image in Jy/pixel with the image's pixels; with --nterms 2 or 3, one "
                  "file for each term, such as a.model.tt0.fits a.model.tt1.fits")
      ->expected(1, imager::most_taylor_terms)
      ->type_name(file_type);
  mark(command
           .add_option("--savemodel", o.savemodel,
                       "modelcolumn: write the model's visibilities into MODEL_DATA; none: write nothing")
           ->check(CLI::IsMember({"none", "modelcolumn"})),
       OptionMark::free_of_state);
  mark(mark(command.add_flag("--restart", o.restart,
                             "Go on from the last major cycle of a run with these options that was stopped or has ended"),
            OptionMark::free_of_state),
       OptionMark::not_repeated);
}

/// Refuses options of automatic masks where they have no effect.
void check_of_auto_masks(const TypedClean& o) {
  if (o.usemask == "auto") return;
  const TypedClean usual;
  const auto only_auto = [](const char* option, const auto& value, const auto& unless) {
    if (value != unless) refuse_option(option, typed(1.0 * value), "--usemask auto beside it");
  };
  only_auto("sidelobethreshold", o.sidelobethreshold, usual.sidelobethreshold);
  only_auto("noisethreshold", o.noisethreshold, usual.noisethreshold);
  only_auto("lownoisethreshold", o.lownoisethreshold, usual.lownoisethreshold);
  only_auto("negativethreshold", o.negativethreshold, usual.negativethreshold);
  only_auto("minbeamfrac", o.minbeamfrac, usual.minbeamfrac);
  only_auto("growiterations", o.growiterations, usual.growiterations);
  only_auto("smoothfactor", o.smoothfactor, usual.smoothfactor);
  only_auto("cutthreshold", o.cutthreshold, usual.cutthreshold);
  only_auto("minpercentchange", o.minpercentchange, usual.minpercentchange);
  if (!o.dogrowprune) refuse_option("dogrowprune", "false", "--usemask auto beside it");
  if (!o.fastnoise) refuse_option("fastnoise", "false", "--usemask auto beside it");
}

void check_clean(const ImageOptions& o) {
  if (!(parse_flux_jy(o.clean.threshold) >= 0)) refuse_option("threshold", o.clean.threshold, "0 or more");  // as it was typed
  imager::check(clean_options(o.clean, 1), "--");
  check_of_auto_masks(o.clean);
  constexpr double largest_smoothfactor = 100;
  if (o.clean.smoothfactor > largest_smoothfactor) refuse_option("smoothfactor", typed(o.clean.smoothfactor), "0 to 100 beams");
  const WantedBeam beam = restoring_beam(o.clean.restoringbeam);
  if (!o.clean.restoringbeam.empty() && !o.clean.runs())
    refuse_option("restoringbeam", o.clean.restoringbeam, "--niter above 0, or --startmodel, beside it");
  const int smallest = smallest_side(o);
  if (o.clean.runs() && smallest < 3 && !beam.given)
    refuse_option("imsize", std::to_string(smallest), "3 pixels or more to fit a beam to, or --restoringbeam");
  if (const auto models = static_cast<int>(o.clean.startmodel.size()); models > 1 && models != o.taylor.nterms)
    refuse_option("startmodel", names_of(o.clean.startmodel),
                  o.taylor.nterms == 1 ? "one image, or --nterms " + std::to_string(models) + " beside it"
                                       : "one image, or " + std::to_string(o.taylor.nterms) + ", one for each of --nterms");
  if (o.clean.savemodel != "none" && o.cube.is_cube())
    refuse_option("savemodel", o.clean.savemodel, "none with --specmode cube");
  if (o.clean.savemodel != "none" && !saves_model(imager::parse_stokes(o.stokes)))
    refuse_option(
        "savemodel", o.clean.savemodel,
        "--stokes of I, Q, U and V, or of parallel hands, such as XXYY or RR, of which a column's correlations are made");
  if (o.clean.savemodel != "none" && !o.clean.runs())
    refuse_option("savemodel", o.clean.savemodel, "--niter above 0, or --startmodel, beside it");
  if (o.primary_beam.pbmask != 0 && !o.clean.runs())
    refuse_option("pbmask", typed(o.primary_beam.pbmask), "--niter above 0, or --startmodel, beside it");
  if (o.clean.usemask == "pb" && (o.primary_beam.pbmask == 0 || !o.clean.mask.empty()))
    refuse_option("usemask", o.clean.usemask, o.clean.mask.empty() ? "--pbmask above 0 beside it" : "user beside --mask");
  if (!o.clean.mask.empty() && !o.clean.runs())
    refuse_option("mask", names_of(o.clean.mask), "--niter above 0, or --startmodel, beside it");
  if (o.clean.restart && o.clean.niter == 0) refuse_option("restart", "true", "--niter above 0 beside it");
  check_deconvolver(o.clean, smallest_side(o));
  check_auto_mask(o.clean);
}

imager::CleanOptions clean_options(const TypedClean& o, int threads) {
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
                                             .negative_threshold = o.negativethreshold,
                                             .smooth_factor = o.smoothfactor,
                                             .cut_threshold = o.cutthreshold,
                                             .min_beam_fraction = o.minbeamfrac,
                                             .grow_iterations = o.growiterations,
                                             .grow_prune = o.dogrowprune,
                                             .min_percent_change = o.minpercentchange,
                                             .fast_noise = o.fastnoise};
  return clean;
}

imager::DeconvolverChoice deconvolver_choice(const TypedClean& o, int threads) {
  imager::DeconvolverChoice choice;
  choice.name = o.deconvolver;
  if (!o.scales.empty()) choice.scale_pixels.clear();
  for (const double scale : o.scales) choice.scale_pixels.push_back(imager::tclean_scale_width * scale);
  choice.small_scale_bias = o.smallscalebias;
  choice.threads = threads;
  return choice;
}

}  // namespace misfit::tools
