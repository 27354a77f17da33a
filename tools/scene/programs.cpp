#include "tools/scene/programs.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <fstream>

#include "imager/files/fits_image.h"
#include "imager/numerics/stage_times.h"
#include "ms_io/measurement_set.h"
#include "tools/base/interrupt.h"
#include "tools/base/numbers.h"
#include "tools/base/quantity.h"
#include "tools/base/run_program.h"
#include "tools/base/text.h"
#include "tools/drawing/gnuplot.h"
#include "tools/run/selection_options.h"
#include "tools/run/weighting_options.h"

namespace misfit::tools {
namespace {

namespace fs = std::filesystem;

/// Names in the folder where predictions are made.
constexpr const char* copied_set = "copy.ms";
constexpr const char* model_name = "sky";
constexpr const char* model_file = "sky-model.fits";

struct Program {
  ProgramResult result;
  std::string image;                 ///< the file with the dirty image
  std::vector<std::string> predict;  ///< the command that writes the model's visibilities into the copy of the set
};

Program misfit(const ImageOptions& scene, const std::string& accuracy, int threads) {
  std::vector<std::string> words{"misfit", "image", "--vis"};
  words.insert(words.end(), scene.vis.begin(), scene.vis.end());
  words.insert(words.end(), {"--imagename", "misfit-" + accuracy, "--imsize"});
  for (const int side : scene.imsize) words.push_back(std::to_string(side));
  const auto add = [&](const std::string& option, const std::string& value) {
    if (!value.empty()) words.insert(words.end(), {option, value});
  };
  add("--cell", scene.cell);
  const std::vector<std::string> selection = words_of(scene.selection);
  words.insert(words.end(), selection.begin(), selection.end());
  add("--phasecenter", scene.phasecenter);
  add("--datacolumn", scene.datacolumn);
  const std::vector<std::string> weighting = weighting_arguments(scene.weighting);
  words.insert(words.end(), weighting.begin(), weighting.end());
  add("--gridder", scene.gridding.gridder);
  if (scene.force_average) words.emplace_back("--force-average");
  add("--accuracy", accuracy);
  add("--threads", std::to_string(threads));
  words.emplace_back("--quiet");
  std::vector<std::string> predict{"misfit",   "predict",    "--vis",  copied_set,  "--model",
                                   model_file, "--accuracy", accuracy, "--threads", std::to_string(threads),
                                   "--quiet"};
  predict.insert(predict.end(), selection.begin(), selection.end());
  return {{"misfit image, to " + accuracy, words, {}, {}, ""}, "misfit-" + accuracy + ".residual.fits", predict};
}

Program wsclean(const ImageOptions& scene, const std::string& name, const std::vector<std::string>& gridder, int threads) {
  const double scale_asec = parse_angle_rad(scene.cell) * 180 / M_PI * 3600;
  std::vector<std::string> words{"wsclean",
                                 "-quiet",
                                 "-name",
                                 "wsclean",
                                 "-size",
                                 std::to_string(scene.imsize.front()),
                                 std::to_string(scene.imsize.back()),
                                 "-scale",
                                 all_digits(scale_asec) + "asec",
                                 "-niter",
                                 "0",
                                 "-weight",
                                 "natural",
                                 "-pol",
                                 "I",
                                 "-no-update-model-required",
                                 "-reorder",
                                 "-j",
                                 std::to_string(threads)};
  words.insert(words.end(), {"-data-column", scene.datacolumn});
  words.insert(words.end(), gridder.begin(), gridder.end());
  words.insert(words.end(), scene.vis.begin(), scene.vis.end());
  std::vector<std::string> predict{"wsclean", "-quiet",   "-predict", "-reorder",
                                   "-name",   model_name, "-j",       std::to_string(threads)};
  predict.insert(predict.end(), gridder.begin(), gridder.end());
  predict.emplace_back(copied_set);
  return {{"wsclean, " + name, words, {}, {}, ""}, "wsclean-dirty.fits", predict};
}

bool is_installed(const std::string& program) {
  const WorkFolder folder(fs::temp_directory_path());
  return run_program({program, "--version"}, folder.path()).has_value();
}

/// The last line that holds words.
std::string last_words(const fs::path& file) {
  std::ifstream said(file);
  std::string line, last = "without a word";
  while (std::getline(said, line))
    if (std::any_of(line.begin(), line.end(), [](unsigned char c) { return std::isalpha(c) != 0; })) last = line;
  return last;
}

std::string in_a_line(const std::vector<std::string>& words) {
  std::string line;
  for (const std::string& word : words) line += (line.empty() ? "" : " ") + shell_quoted(word);
  return line;
}

/// Runs a program, and returns whether it succeeded; if not, its result says why.
bool run_in(const WorkFolder& folder, std::vector<std::string> words, ProgramResult& result) {
  if (words.front() == "misfit") words.front() = fs::read_symlink("/proc/self/exe").string();
  const std::optional<int> status = run_program(words, folder.path(), OnInterrupt::stop);
  if (interrupted()) throw Interrupted();
  if (status && *status == 0) return true;
  result.failure = last_words(folder.path() / "said");
  result.seconds.clear();
  result.errors = SceneErrors::none();
  return false;
}

void run_once(Program& program, const std::vector<std::string>& vis, const SceneTruth& truth) {
  if (!program.result.failure.empty()) return;
  const WorkFolder folder(fs::temp_directory_path());
  std::vector<std::string> words = program.result.words;
  for (std::string& word : words)
    if (std::find(vis.begin(), vis.end(), word) != vis.end()) word = fs::absolute(word).string();
  const imager::Stopwatch watch;
  if (!run_in(folder, words, program.result)) return;
  program.result.seconds.push_back(watch.seconds());
  if (program.result.seconds.size() == 1)
    program.result.errors = truth.errors_of(imager::read_fits(folder.path() / program.image).image);
}

/// The reason why WSClean cannot be given the same samples; empty where it can.
std::string why_not_wsclean(const ImageOptions& scene) {
  if (!words_of(scene.selection).empty()) return "it selects in a way of its own, and might take other samples";
  if (!scene.phasecenter.empty()) return "it is not given --phasecenter";
  if (scene.datacolumn != "DATA" && scene.datacolumn != "CORRECTED_DATA")
    return "it is not given --datacolumn " + scene.datacolumn;
  if (!weighting_options(scene.weighting).none()) return "it is given natural weights alone";
  return is_installed("wsclean") ? "" : "it is not installed";
}

void add_wsclean(const ImageOptions& scene, int threads, std::vector<Program>& programs) {
  for (const std::string accuracy : {"1e-4", "1e-6"})
    programs.push_back(wsclean(scene, "w-gridder to " + accuracy,
                               {"-use-wgridder", "-wgridder-accuracy", accuracy, "-no-small-inversion"}, threads));
  programs.push_back(wsclean(scene, "w-stacking with a Kaiser–Bessel kernel (its default)", {}, threads));
  programs.push_back(wsclean(scene, "w-stacking, nearest cell", {"-grid-mode", "nn"}, threads));
}

std::uintmax_t bytes_of(const fs::path& folder) {
  std::uintmax_t bytes = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) bytes += entry.is_regular_file() ? entry.file_size() : 0;
  return bytes;
}

/// The time after which no run is begun.
struct Limit {
  double seconds = HUGE_VAL;
  imager::Stopwatch watch{};
  bool reached() const { return watch.seconds() > seconds; }
};

/// Compares the predictions of all programs in turn, into one copy of the set.
void compare_predictions(const ImageOptions& scene, const SceneTruth& truth, const Limit& limit,
                         std::vector<Program>& programs) {
  const WorkFolder folder(fs::temp_directory_path());
  const fs::path set = folder.path() / copied_set;
  fs::copy(scene.vis.front(), set, fs::copy_options::recursive);
  fs::permissions(set, fs::perms::owner_all, fs::perm_options::add);
  for (const auto& entry : fs::recursive_directory_iterator(set))
    fs::permissions(entry.path(), fs::perms::owner_all, fs::perm_options::add);
  {
    const ms_io::MeasurementSet opened(set, scene.selection.of_set(0), scene.datacolumn);
    imager::SkyImage sky;
    sky.image = truth.model();
    sky.observation = opened.observation();
    sky.geometry = geometry_of(scene, sky.observation.phase_centre);
    sky.unit = "Jy/pixel";
    imager::write_fits(sky, folder.path() / model_file, imager::PixelFormat::float32);
  }
  for (Program& program : programs) {
    const bool called_for = program.result.failure.empty() && !program.result.seconds.empty() && !limit.reached();
    if (!called_for || !run_in(folder, program.predict, program.result)) continue;
    const ms_io::MeasurementSet written(set, scene.selection.of_set(0), "MODEL_DATA");
    const auto stream = written.open();
    std::size_t index = 0;
    while (const auto block = stream->next())
      truth.compare(index++, {block->visibility.begin(), block->visibility.end()}, program.result.errors);
    truth.finish(program.result.errors);
  }
}

}  // namespace

std::string ProgramResult::command() const {
  return in_a_line(words);
}

ProgramComparison run_programs(const ImageOptions& scene, const SceneTruth& truth, int threads, bool quick,
                               ProgressLine& progress) {
  std::vector<Program> programs{misfit(scene, "1e-4", threads), misfit(scene, "1e-6", threads)};
  ProgramComparison comparison{.results = {}, .rounds = quick ? 1 : 3, .left_out = {}};
  const std::string against_wsclean = why_not_wsclean(scene);
  if (against_wsclean.empty())
    add_wsclean(scene, threads, programs);
  else
    comparison.left_out.push_back("WSClean was left out: " + against_wsclean + ".");
  const Limit limit{.seconds = quick ? 40 : HUGE_VAL};
  std::uint64_t done = 0;
  for (int round = 0; round < comparison.rounds; ++round)
    for (Program& program : programs) {
      if (!limit.reached()) run_once(program, scene.vis, truth);
      progress.update(++done, programs.size() * static_cast<std::uint64_t>(comparison.rounds));
    }
  constexpr std::uintmax_t largest_copy = std::uintmax_t{2} << 30;
  if (scene.vis.size() > 1 || !scene.phasecenter.empty())
    comparison.left_out.emplace_back(
        "Predictions were left out: they are made in a copy of one set, about its own phase centre.");
  else if (bytes_of(scene.vis.front()) > largest_copy)
    comparison.left_out.emplace_back("Predictions were left out: the set takes more than 2 GiB, and they are made in a copy.");
  else
    compare_predictions(scene, truth, limit, programs);
  if (limit.reached())
    comparison.left_out.emplace_back("With --quick no program is begun after 40 s; what is missing was left out.");
  for (Program& program : programs) comparison.results.push_back(std::move(program.result));
  return comparison;
}

}  // namespace misfit::tools
