#include "tools/scene/scene_command.h"

#include <cstdio>
#include <filesystem>
#include <memory>

#include "tools/base/option_checks.h"
#include "tools/base/quantity.h"
#include "tools/kernel_choice/kernel_choice.h"
#include "tools/run/named_data.h"
#include "tools/scene/scene_report.h"

namespace misfit::tools {
namespace {

struct Options {
  SceneReportOptions report;
  std::string output;
};

void write(const Options& o) {
  check(o.report.scene);
  for (const std::string& kernel : o.report.kernels) choose_kernel(kernel);
  prepare_report_folder(o.output);
  SceneReportOptions options = o.report;
  if (!has_unit(options.scene.cell)) options.scene.cell += "arcsec";
  options.results_file = (std::filesystem::path(o.output) / "measured.json").string();
  ProgressLine progress(options.scene.quiet);
  const Report report = naming(options.scene.vis, [&] { return scene_report(options, progress); });
  progress.begin("draw");
  write_report(report, o.output);
  progress.end();
  std::filesystem::remove(options.results_file);
  if (!options.scene.quiet)
    std::printf("%s\n%s/index.html\n", report.sections.front().paragraphs.front().c_str(), o.output.c_str());
}

}  // namespace

void add_scene_report(CLI::App& reports) {
  CLI::App* command =
      reports.add_subcommand("scene", "Error against run time for this data and image: kernels, widths, paddings, evaluations");
  const auto o = std::make_shared<Options>();
  o->report.scene.imagename = "image";
  declare_scene(*command, o->report.scene);
  command->add_option("--kernel", o->report.kernels, "Kernels to compare besides the usual ones: names or kernel-table files");
  command->add_flag("--quick", o->report.quick, "Fewer points, each run twice rather than five times");
  command
      ->add_option("--output", o->output,
                   "Folder for index.html, SVG, CSV and report.json; a run that was stopped goes on there")
      ->required()
      ->check(not_empty());
  command->callback([o] { write(*o); });
}

}  // namespace misfit::tools
