#include <CLI/CLI.hpp>
#include <cstdio>
#include <functional>
#include <memory>
#include <string>

#include "tools/base/option_checks.h"
#include "tools/base/progress.h"
#include "tools/command.h"
#include "tools/kernel_report/kernel_report.h"
#include "tools/report/report_folder.h"
#include "tools/scene/scene_command.h"
#include "tools/stability/stability_report.h"

namespace misfit::tools {
namespace {

using MakeReport = std::function<Report(ProgressLine&)>;

struct ReportOptions {
  std::string output;
  bool quiet = false;
};

void write(const ReportOptions& o, const MakeReport& make) {
  prepare_report_folder(o.output);
  ProgressLine progress(o.quiet);
  const Report report = make(progress);
  progress.begin("draw");
  write_report(report, o.output);
  progress.end();
  if (!o.quiet) std::printf("%s/index.html\n", o.output.c_str());
}

CLI::App* add_report(CLI::App& reports, const std::string& name, const std::string& description, const MakeReport& make) {
  CLI::App* command = reports.add_subcommand(name, description);
  const auto o = std::make_shared<ReportOptions>();
  command->add_option("--output", o->output, "Folder for index.html, SVG, CSV and report.json; created if it does not exist")
      ->required()
      ->type_name(folder_type)
      ->check(not_empty());
  command->add_flag("--quiet", o->quiet, "Print nothing but errors");
  command->callback([o, make] { write(*o, make); });
  return command;
}

void add_kernel_report(CLI::App& reports) {
  const auto o = std::make_shared<KernelReportOptions>();
  CLI::App* command =
      add_report(reports, "kernels",
                 "Gridding functions: the figures of Ye et al. 2020 with our own numbers, and other functions beside them",
                 [o](ProgressLine& progress) { return kernel_report(*o, progress); });
  command->add_flag("--quick", o->quick, "Leave out the comparison with other families, which takes most of the time");
  command->add_flag("--paper", o->paper,
                    "Repeat the paper's experiments too: compare gridded images and visibilities with direct sums");
}

void add_stability_report(CLI::App& reports) {
  const auto o = std::make_shared<StabilityOptions>();
  CLI::App* command = add_report(reports, "stability", "Effect of rounding on kernels, gridding, sums and whole runs",
                                 [o](ProgressLine& progress) { return stability_report(*o, progress); });
  command
      ->add_option("--vis", o->vis,
                   "MeasurementSet whose uv coverage and weights the runs start from; when empty, one is simulated")
      ->type_name(folder_type);
  command->add_flag("--quick", o->quick, "Take fewer samples; the report is done within a minute or so");
}

}  // namespace

void add_report_command(CLI::App& program) {
  CLI::App* reports = program.add_subcommand("report", "Write pages of figures and tables, with the numbers behind them");
  reports->require_subcommand(1);
  add_kernel_report(*reports);
  add_scene_report(*reports);
  add_stability_report(*reports);
}

}  // namespace misfit::tools
