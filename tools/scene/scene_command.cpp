#include "tools/scene/scene_command.h"

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "ms_io/measurement_set.h"
#include "tools/base/numbers.h"
#include "tools/base/option_checks.h"
#include "tools/base/quantity.h"
#include "tools/base/text.h"
#include "tools/base/value_checks.h"
#include "tools/kernel_choice/kernel_choice.h"
#include "tools/run/data_columns.h"
#include "tools/run/named_data.h"
#include "tools/scene/scene_memory.h"
#include "tools/scene/scene_report.h"

namespace misfit::tools {
namespace {

struct Options {
  SceneReportOptions report;
  std::string output;
};

/// The columns that are named, one for all sets or one for each.
std::vector<ms_io::DataColumn> named_columns_of(const ImageOptions& scene) {
  const std::vector<std::string_view> names = split_at_commas(scene.datacolumn);
  std::vector<ms_io::DataColumn> columns;
  for (std::size_t i = 0; i < scene.vis.size(); ++i)
    columns.push_back({scene.vis[i], std::string(names[names.size() == 1 ? 0 : i]), {}, {}});
  return columns;
}

/// Checks the values that are given.
void check_values(const Options& o) {
  check(o.report.scene);
  if (o.report.scene.makes_mosaic())
    refuse_option("gridder", "mosaic", "auto, standard or wide, since images of one pointing are compared");
  for (const std::string& kernel : o.report.kernels) choose_kernel({kernel, o.report.scene.gridding.kernel.folder});
  if (!(o.report.seconds >= 0 && std::isfinite(o.report.seconds)))
    throw std::invalid_argument("--seconds " + significant(o.report.seconds, 6) + ": expected 0 or more");
}

void write(const Options& o) {
  check_values(o);
  check_scene_memory(o.report.scene);
  prepare_report_folder(o.output);
  SceneReportOptions options = o.report;
  if (!has_unit(options.scene.cell)) options.scene.cell += "arcsec";
  options.scene.datacolumn = ms_io::named_columns(options.scene.vis, options.scene.datacolumn);
  const std::string unlike = unlike_columns_warning(named_columns_of(options.scene), o.report.scene.datacolumn);
  options.results_file = (std::filesystem::path(o.output) / "measured.json").string();
  ProgressLine progress(options.scene.quiet);
  if (!unlike.empty()) progress.say("warning: " + unlike);
  const Report report = naming(names_of(options.scene.vis), [&] { return scene_report(options, progress); });
  progress.begin("draw");
  write_report(report, o.output);
  progress.end();
  std::filesystem::remove(options.results_file);
  if (!options.scene.quiet)
    std::printf("%s\n%s/index.html\n", report.sections.front().paragraphs.front().c_str(), o.output.c_str());
}

}  // namespace

void add_scene_report(CLI::App& reports) {
  CLI::App* command = reports.add_subcommand(
      "scene", "Error against run time for these data and this image, over kernels, widths, paddings and evaluations");
  const auto o = std::make_shared<Options>();
  o->report.scene.imagename = "image";
  declare_scene(*command, o->report.scene);
  list_kernels(*command->add_option("--kernel", o->report.kernels,
                                    "Kernels to compare besides the usual ones: names or kernel-table files"));
  declare_kernel_folder(*command, o->report.scene.gridding.kernel.folder);
  command->add_flag("--quick", o->report.quick,
                    "Compare fewer points in fewer runs; the report of a million visibilities is done within two minutes");
  command->add_option("--seconds", o->report.seconds,
                      "Seconds for the runs of all points together. Each point is run in two rounds with --quick, five "
                      "without, and in more while this time lasts; 0 means 75 with --quick and 600 without");
  command
      ->add_option("--output", o->output,
                   "Folder for index.html, SVG, CSV and report.json; a run that was stopped goes on from there")
      ->required()
      ->type_name(folder_type)
      ->check(not_empty());
  check_before_missing(*command, [o] { check_values(*o); });
  command->callback([o] { write(*o); });
}

}  // namespace misfit::tools
