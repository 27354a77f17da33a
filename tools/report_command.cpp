#include <cstdio>
#include <memory>
#include <string>

#include "tools/command.h"
#include "tools/kernel_report.h"
#include "tools/progress.h"
#include "tools/report_folder.h"
#include "tools/scene/scene_command.h"
#include "tools/stability_report.h"

namespace misfit::tools {
namespace {

struct ReportOptions {
  std::string output;
  bool paper = false;
  bool quiet = false;
};

using MakeReport = Report (*)(ProgressLine&, const ReportOptions&);

void write(const ReportOptions& o, MakeReport make) {
  prepare_report_folder(o.output);
  ProgressLine progress(o.quiet);
  const Report report = make(progress, o);
  progress.begin("draw");
  write_report(report, o.output);
  progress.end();
  if (!o.quiet) std::printf("%s/index.html\n", o.output.c_str());
}

CLI::App* add_report(CLI::App& reports, const std::string& name, const std::string& description,
                     const std::shared_ptr<ReportOptions>& o, MakeReport make) {
  CLI::App* command = reports.add_subcommand(name, description);
  command->add_option("--output", o->output, "Folder for index.html, SVG, CSV and report.json; made where there is none")
      ->required();
  command->add_flag("--quiet", o->quiet, "Print nothing");
  command->callback([o, make] { write(*o, make); });
  return command;
}

}  // namespace

void add_report_command(CLI::App& program) {
  CLI::App* reports = program.add_subcommand("report", "Write pages of figures and tables, with the numbers behind them");
  reports->require_subcommand(1);
  const auto kernels = std::make_shared<ReportOptions>();
  add_report(*reports, "kernels", "Gridding functions: the figures of Ye et al. 2020 from our own numbers, and rivals", kernels,
             [](ProgressLine& progress, const ReportOptions& o) { return kernel_report(progress, o.paper); })
      ->add_flag("--paper", kernels->paper,
                 "Add the paper's experiments made again: images and visibilities by gridding against direct sums");
  add_scene_report(*reports);
  add_report(*reports, "stability", "What rounding does to kernels, gridding and sums", std::make_shared<ReportOptions>(),
             [](ProgressLine& progress, const ReportOptions& /*o*/) { return stability_report(progress); });
}

}  // namespace misfit::tools
