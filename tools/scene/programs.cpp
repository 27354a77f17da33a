#include "tools/scene/programs.h"

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "imager/fits_image.h"
#include "imager/stage_times.h"
#include "tools/gnuplot.h"
#include "tools/quantity.h"
#include "tools/run_program.h"

namespace misfit::tools {
namespace {

namespace fs = std::filesystem;

struct Program {
  ProgramResult result;
  std::string image;  ///< the file with the dirty image
};

std::string number(double value) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", value);
  return text;
}

Program misfit(const ImageOptions& scene, const std::string& accuracy, int threads) {
  std::vector<std::string> words{"misfit", "image", "--vis", scene.vis, "--imagename", "misfit-" + accuracy, "--imsize"};
  for (const int side : scene.imsize) words.push_back(std::to_string(side));
  const auto add = [&](const std::string& option, const std::string& value) {
    if (!value.empty()) words.insert(words.end(), {option, value});
  };
  add("--cell", scene.cell);
  add("--field", scene.selection.field);
  add("--spw", scene.selection.spectral_window);
  add("--datacolumn", scene.datacolumn);
  add("--gridder", scene.gridder);
  add("--accuracy", accuracy);
  add("--threads", std::to_string(threads));
  words.emplace_back("--quiet");
  return {{"misfit image, to " + accuracy, words, {}, {}}, "misfit-" + accuracy + ".residual.fits"};
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
                                 number(scale_asec) + "asec",
                                 "-niter",
                                 "0",
                                 "-weight",
                                 "natural",
                                 "-pol",
                                 "I",
                                 "-no-update-model-required",
                                 "-j",
                                 std::to_string(threads)};
  words.insert(words.end(), {"-data-column", scene.datacolumn == "corrected" ? "CORRECTED_DATA" : "DATA"});
  words.insert(words.end(), gridder.begin(), gridder.end());
  words.push_back(scene.vis);
  return {{"wsclean, " + name, words, {}, {}}, "wsclean-dirty.fits"};
}

bool same_for_wsclean(const ImageOptions& scene) {
  return scene.selection.field.empty() && scene.selection.spectral_window.empty() &&
         (scene.datacolumn == "data" || scene.datacolumn == "corrected");
}

bool is_installed(const std::string& program) {
  const WorkFolder folder(fs::temp_directory_path());
  return run_program({program, "--version"}, folder.path()).has_value();
}

std::string first_line(const fs::path& file) {
  std::ifstream said(file);
  std::string line;
  while (line.find_first_not_of(" \t") == std::string::npos && std::getline(said, line)) {
  }
  return line;
}

void run_once(Program& program, const std::string& vis, const SceneTruth& truth) {
  const WorkFolder folder(fs::temp_directory_path());
  std::vector<std::string> words = program.result.words;
  if (words.front() == "misfit") words.front() = fs::read_symlink("/proc/self/exe").string();
  for (std::string& word : words)
    if (word == vis) word = fs::absolute(vis).string();
  const imager::Stopwatch watch;
  const std::optional<int> status = run_program(words, folder.path());
  if (!status || *status != 0)
    throw std::runtime_error(program.result.command() + " failed: " + first_line(folder.path() / "said"));
  program.result.seconds.push_back(watch.seconds());
  if (program.result.seconds.size() == 1)
    program.result.errors = truth.errors_of(imager::read_fits(folder.path() / program.image).image);
}

}  // namespace

std::string ProgramResult::command() const {
  std::string line;
  for (const std::string& word : words) line += (line.empty() ? "" : " ") + word;
  return line;
}

std::vector<ProgramResult> run_programs(const ImageOptions& scene, const SceneTruth& truth, int threads, int rounds,
                                        ProgressLine& progress) {
  std::vector<Program> programs{misfit(scene, "1e-4", threads), misfit(scene, "1e-6", threads)};
  if (same_for_wsclean(scene) && is_installed("wsclean")) {
    programs.push_back(wsclean(scene, "w-stacking with a Kaiser–Bessel kernel (its default)", {}, threads));
    programs.push_back(wsclean(scene, "w-stacking, nearest cell", {"-grid-mode", "nn"}, threads));
    for (const std::string accuracy : {"1e-4", "1e-6"})
      programs.push_back(wsclean(scene, "w-gridder to " + accuracy,
                                 {"-use-wgridder", "-wgridder-accuracy", accuracy, "-no-small-inversion"}, threads));
  }
  std::uint64_t done = 0;
  for (int round = 0; round < rounds; ++round)
    for (Program& program : programs) {
      run_once(program, scene.vis, truth);
      progress.update(++done, programs.size() * static_cast<std::uint64_t>(rounds));
    }
  std::vector<ProgramResult> results;
  for (Program& program : programs) results.push_back(std::move(program.result));
  return results;
}

}  // namespace misfit::tools
