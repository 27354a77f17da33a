#pragma once

#include <string>
#include <vector>

#include "tools/report/data_table.h"
#include "tools/report/figure.h"

namespace misfit::tools {

/// A part of a report: paragraphs of plain text, then figures, then tables.
struct ReportSection {
  std::string heading;
  std::vector<std::string> paragraphs;
  std::vector<Figure> figures;
  std::vector<DataTable> tables;
};

struct Report {
  std::string title;
  std::string introduction;
  std::vector<ReportSection> sections;
};

/// Makes the folder where there is none, and checks that files can be written there and gnuplot be found, so that a report that
/// takes minutes does not fail at its end. Throws std::runtime_error that names the folder or the program.
void prepare_report_folder(const std::string& folder);

/// Writes <name>.svg and <name>.csv of each figure, <name>.csv of each table, report.json with all of them, and last
/// index.html, which shows everything and needs no other file. Each appears under its name only when complete. Throws
/// std::logic_error where two have one name.
void write_report(const Report& report, const std::string& folder);

}  // namespace misfit::tools
