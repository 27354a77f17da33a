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

using MakeReport = Report (*)(ProgressLine&);

struct ReportOptions {
  std::string output;
  bool quiet = false;
};

void write(const ReportOptions& o, MakeReport make) {
  prepare_report_folder(o.output);
  ProgressLine progress(o.quiet);
  const Report report = make(progress);
  progress.begin("draw");
  write_report(report, o.output);
  progress.end();
  if (!o.quiet) std::printf("%s/index.html\n", o.output.c_str());
}

void add_report(CLI::App& reports, const std::string& name, const std::string& description, MakeReport make) {
  CLI::App* command = reports.add_subcommand(name, description);
  const auto o = std::make_shared<ReportOptions>();
  command->add_option("--output", o->output, "Folder for index.html, SVG, CSV and report.json; made where there is none")
      ->required();
  command->add_flag("--quiet", o->quiet, "Print nothing");
  command->callback([o, make] { write(*o, make); });
}

}  // namespace

void add_report_command(CLI::App& program) {
  CLI::App* reports = program.add_subcommand("report", "Write pages of figures and tables, with the numbers behind them");
  reports->require_subcommand(1);
  add_report(*reports, "kernels", "Gridding functions: the figures of Ye et al. 2020 from our own numbers, and rivals",
             kernel_report);
  add_scene_report(*reports);
  add_report(*reports, "stability", "What rounding does to kernels, gridding and sums", stability_report);
}

}  // namespace misfit::tools
