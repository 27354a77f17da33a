#include "tools/manual/prose.h"

#include <map>

#include "tools/program.h"

namespace misfit::tools {
namespace {

Prose program_prose() {
  Prose prose;
  prose.description = {
      "misfit images radio-interferometry MeasurementSets, predicts the visibilities of models, and makes gridding functions. "
      "It "
      "grids with least-misfit functions, which make the FFT image differ least from the direct Fourier transform, solved for "
      "the width and the padding that an image calls for; and it says how wrong its images are.",
      "Options have the names of CASA's tclean where they mean the same, and select as its tasks do. Each command has a page "
      "of "
      "its own."};
  prose.examples = {{"Simulate an hour of the VLA, then image and CLEAN it",
                     "misfit simulate --output card.ms --hours 1 --interval 30 --noise 50mJy\n"
                     "misfit image --vis card.ms --imagename card --imsize 1024 --cell 0.05arcsec --niter 10000 --nsigma 4"}};
  return prose;
}

Prose image_prose() {
  Prose prose;
  prose.description = {
      "Images one MeasurementSet or several, which are opened read-only, and with --niter cleans. What was asked for by "
      "--accuracy holds for the whole image, its borders included; the plan of the run says by which gridding function, width, "
      "padding and precision, and why. --dry-run prints that plan alone.",
      "Stopped by Ctrl-C, it finishes the major cycle and writes everything; --restart goes on from there."};
  prose.files = {{"NAME.psf.fits, NAME.residual.fits", "The PSF; the dirty image, or what CLEAN leaves of it."},
                 {"NAME.model.fits, NAME.image.fits", "What CLEAN found, in Jy/pixel; the restored image. Both with --niter."},
                 {"NAME.mask.fits", "Where CLEAN looked, with --mask, --usemask or --pbmask."},
                 {"NAME.components.csv", "The components that CLEAN found, which misfit predict takes."},
                 {"NAME.clean.state", "The last major cycle, which --restart goes on from."},
                 {"NAME.report.html, NAME.report.json", "The run with its plan, pictures and times; the same for machines."},
                 {"NAME.last.ini", "The options of the run, which --config takes to repeat it."},
                 {"NAME.lock", "There while the run goes on: keeps other runs from the same name."}};
  prose.examples = {
      {"The dirty image and the PSF of two sets",
       "misfit image --vis a.ms b.ms --imagename both --imsize 2048 --cell 0.2arcsec"},
      {"CLEAN to four times the noise, and compare 200 pixels with the direct transform",
       "misfit image --vis my.ms --imagename out --imsize 1024 --cell 0.2arcsec --niter 5000 --nsigma 4 --verify 200"},
      {"A cube of a line",
       "misfit image --vis my.ms --imagename line --imsize 512 --cell 1arcsec --specmode cube --start 1.42GHz "
       "--nchan 64"}};
  return prose;
}

Prose predict_prose() {
  Prose prose;
  prose.description = {
      "Writes what a model's visibilities are at the samples of a MeasurementSet, flagged or not, into a column; or the data "
      "without them. A run that was stopped leaves a set that opens, and the same command goes on where it was."};
  prose.examples = {{"Fill MODEL_DATA from an image", "misfit predict --vis my.ms --model out.model.fits"},
                    {"Take sources out of the data", "misfit predict --vis my.ms --components sky.csv --subtract"},
                    {"The same of sources with the fluxes of the sky, in a mosaic's data",
                     "misfit predict --vis my.ms --components sky.csv --apply-beam --phasecenter 0 --subtract"}};
  return prose;
}

Prose mosaic_prose() {
  Prose prose;
  prose.description = {
      "Makes one image of those of several pointings, which misfit, tclean or WSClean made and did not divide by the primary "
      "beam: "
      "in each pixel sum(B D / s^2) / sum(B^2 / s^2), of the images D with beams B and noises s. Pointings take part where "
      "their beam is 0.05 or more, and images are regridded exactly, in whatever projection, frame and turn they are.",
      "Images whose restoring beams differ by more than a thousandth are convolved to the least beam that encloses all. The "
      "axis "
      "of a beam that no image .pb shows is the header's reference direction. CLEAN each image as deep as the mosaic "
      "is to be: what is left of sources does not average down."};
  prose.files = {{"NAME.image.fits", "The mosaic, in Jy/beam."},
                 {"NAME.weight.fits", "The sum of B^2 / s^2, in 1/(Jy/beam)^2."},
                 {"NAME.noise.fits", "One over its root, the noise of the mosaic in Jy/beam."},
                 {"NAME.pb.fits", "Its root over the largest, the joint beam; below --pblimit all four have no values."}};
  prose.examples = {{"Three pointings, each with its .pb and .residual beside it",
                     "misfit mosaic a.image.fits b.image.fits c.image.fits --output field"},
                    {"Images without .pb, of dishes of 22 m, with noises that are known",
                     "misfit mosaic a.fits b.fits --output field --beam airy:22 --rms 20uJy,31uJy"}};
  return prose;
}

Prose kernel_prose() {
  Prose prose;
  prose.description = {
      "Solves a gridding function of a width, for images that keep the part 2 x0 of their FFT, and writes it as a FITS file: "
      "its "
      "polynomials, a lookup table, the correction of its taper, and its error across the image. --emit writes it as another "
      "imager holds it, and says what that will err by with it; --accuracy chooses width and padding; --inspect shows a file."};
  prose.files = {
      {"LIBRARIES/misfit/libmisfit_wsclean.so",
       "Preloaded into WSClean, puts what --emit wsclean wrote, and $MISFIT_WSCLEAN_KERNEL names, in place of its table."}};
  prose.examples = {
      {"A function of seven cells for padding 2", "misfit kernel --width 7 --padding 2 --output k.fits"},
      {"The cheapest width and padding for an image", "misfit kernel --accuracy 1e-6 --imsize 4096 --samples 2e7"},
      {"For WSClean, with its error there", "misfit kernel --emit wsclean --width 7 --output k.h"}};
  return prose;
}

Prose simulate_prose() {
  Prose prose;
  prose.description = {
      "Makes a MeasurementSet of one field, whose visibilities are direct sums over points and Gaussians, with noise of their "
      "own "
      "if asked for. The track is symmetric about the transit of the phase centre."};
  prose.examples = {{"A snapshot of the test card", "misfit simulate --output card.ms"},
                    {"Sources of a list, w included, over two hours",
                     "misfit simulate --output sky.ms --sky sky.csv --array vla-b --hours 2 --interval 30 --channels 16 "
                     "--channel-width 4MHz"}};
  return prose;
}

Prose report_prose(const std::string& description, const std::string& shows, const std::string& line) {
  Prose prose;
  prose.description = {description};
  prose.files = {{"FOLDER/index.html", "The page."},
                 {"FOLDER/report.json, FOLDER/*.csv", "The numbers behind it, all of them and by figure or table."}};
  prose.examples = {{shows, line}};
  return prose;
}

}  // namespace

Prose prose_of(const std::string& command) {
  static const std::map<std::string, Prose> pages{
      {"misfit", program_prose()},
      {"misfit image", image_prose()},
      {"misfit predict", predict_prose()},
      {"misfit mosaic", mosaic_prose()},
      {"misfit kernel", kernel_prose()},
      {"misfit simulate", simulate_prose()},
      {"misfit report kernels",
       report_prose("Draws how wrong gridding functions are, by width, padding and place in the image, beside their rivals.",
                    "The paper's figures, and its experiments made again",
                    "misfit report kernels --paper --output paper-report")},
      {"misfit report scene",
       report_prose(
           "Measures the error of each kernel, width, padding, precision and evaluation on given data and image against "
           "the direct transform, with its time, and shows which are worth it. Called again after it was stopped, it "
           "goes on.",
           "An answer within two minutes or so",
           "misfit report scene --vis my.ms --imsize 1024 --cell 0.2arcsec --quick --output scene-report")},
      {"misfit report stability",
       report_prose("Measures what rounding does to kernels, gridding, sums and whole runs, up to where they fail.",
                    "Fewer samples, and less time", "misfit report stability --quick --output stability-report")},
  };
  const auto found = pages.find(command);
  return found == pages.end() ? Prose{} : found->second;
}

const std::vector<std::pair<std::string, std::string>>& environment_prose() {
  static const std::vector<std::pair<std::string, std::string>> variables{
      {"MISFIT_CACHE",
       "Folder where solved gridding functions are kept, and what this machine's runs took; misfit in $XDG_CACHE_HOME or in "
       "~/.cache where it is not set. The same bits come from there as from solving anew."},
      {"MISFIT_KERNEL_FOLDER", "Folder with kernels from outside, where --kernel-folder is not given."},
      {"PATH", "Where gnuplot is looked for, which draws pictures, and by reports wsclean, to compare with."}};
  return variables;
}

const std::vector<std::pair<std::string, std::string>>& exit_status_prose() {
  static const std::vector<std::pair<std::string, std::string>> codes{
      {std::to_string(done), "Done."},
      {std::to_string(unusable_data), "The data or a file cannot be used; a line on stderr says which, and what was expected."},
      {std::to_string(wrong_usage), "Wrong usage; a line on stderr says what was expected."},
      {std::to_string(stopped_by_user), "Stopped by the user; all that was finished is valid."}};
  return codes;
}

}  // namespace misfit::tools
