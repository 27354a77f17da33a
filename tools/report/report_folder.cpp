#include "tools/report/report_folder.h"

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "kernels/version.h"
#include "tools/base/files.h"
#include "tools/base/json_text.h"
#include "tools/report/html.h"
#include "tools/report/html_elements.h"

namespace misfit::tools {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

void check_names(const Report& report) {
  std::set<std::string> names{"index", "report"};
  const auto add = [&](const std::string& name) {
    if (!names.insert(name).second) throw std::logic_error("report has two parts named " + name + "; expected one");
  };
  for (const ReportSection& section : report.sections) {
    for (const Figure& figure : section.figures) add(figure.name);
    for (const DataTable& table : section.tables) add(table.name);
  }
}

std::string paragraph(const std::string& text) {
  return text.empty() ? "" : html::tag("p", html_escaped(text)) + "\n";
}

std::string caption(const std::string& title, const std::string& text, const std::string& name) {
  return html::tag("figcaption", html::tag("b", html_escaped(title) + ".") + " " + html_escaped(text) + " " +
                                     html::tag("span", name + ".csv", "none")) +
         "\n";
}

std::string section_html(const ReportSection& section, const std::map<std::string, std::string>& drawing) {
  std::string content;
  for (const std::string& text : section.paragraphs) content += paragraph(text);
  for (const Figure& figure : section.figures)
    content +=
        html::tag("figure", drawing.at(figure.name) + caption(figure.title, figure.caption, figure.name), "drawing") + "\n";
  for (const DataTable& table : section.tables)
    content += html::tag("figure", caption(table.title, table.caption, table.name) + table_html(table), "data") + "\n";
  return html::section(html_escaped(section.heading), content);
}

json report_json(const Report& report) {
  json sections = json::array();
  for (const ReportSection& section : report.sections) {
    json part{{"heading", section.heading},
              {"paragraphs", section.paragraphs},
              {"figures", json::array()},
              {"tables", json::array()}};
    for (const Figure& figure : section.figures) part["figures"].push_back(figure_json(figure));
    for (const DataTable& table : section.tables) part["tables"].push_back(table_json(table));
    sections.push_back(part);
  }
  return {{"title", report.title}, {"version", MISFIT_VERSION}, {"introduction", report.introduction}, {"sections", sections}};
}

/// An SVG element as a file of its own.
std::string svg_file(const std::string& element) {
  return "<?xml version=\"1.0\" encoding=\"utf-8\" standalone=\"no\"?>\n" + element;
}

}  // namespace

void prepare_report_folder(const std::string& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (!fs::is_directory(folder))
    throw std::runtime_error("output folder " + folder +
                             " cannot be made: " + (error ? error.message() : "there is a file of that name"));
  check_writable_folder(fs::path(folder) / "index.html");
  Figure trial;
  trial.name = "trial";
  trial.series = {{.label = "trial", .x = {0, 1}, .y = {0, 1}}};
  draw_svg(trial);
}

void write_report(const Report& report, const std::string& folder) {
  check_names(report);
  const auto path = [&](const std::string& name) { return (fs::path(folder) / name).string(); };
  std::map<std::string, std::string> drawing;
  std::string content = html::header(html_escaped(report.title), "misfit " MISFIT_VERSION) + paragraph(report.introduction);
  for (const ReportSection& section : report.sections) {
    for (const Figure& figure : section.figures) {
      drawing[figure.name] = draw_svg(figure);
      write_file(path(figure.name + ".svg"), svg_file(drawing[figure.name]));
      write_file(path(figure.name + ".csv"), figure_csv(figure));
    }
    for (const DataTable& table : section.tables) write_file(path(table.name + ".csv"), table_csv(table));
    content += section_html(section, drawing);
  }
  write_file(path("report.json"), json_text(report_json(report), 1) + "\n");
  write_file(path("index.html"), html::page(html_escaped(report.title) + " — misfit", content));
}

}  // namespace misfit::tools
