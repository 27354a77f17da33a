#include "tools/report/html_elements.h"

#include "tools/report/report_style.h"

namespace misfit::tools::html {

std::string tag(const std::string& name, const std::string& content, const std::string& kind) {
  return "<" + name + (kind.empty() ? "" : " class=\"" + kind + "\"") + ">" + content + "</" + name + ">";
}

std::string section(const std::string& title, const std::string& content) {
  return content.empty() ? "" : "<section>\n" + tag("h2", title) + "\n" + content + "</section>\n";
}

std::string table(const Row& headings, const std::vector<Row>& rows) {
  const auto row_of = [&](const Row& cells, const std::string& element) {
    std::string line;
    for (std::size_t k = 0; k < cells.size(); ++k) {
      const bool number = headings[k].starts_with('#');
      line += tag(element, element == "th" && number ? cells[k].substr(1) : cells[k], number ? "number" : "");
    }
    return tag("tr", line) + "\n";
  };
  std::string body;
  for (const Row& row : rows) body += row_of(row, "td");
  if (rows.empty()) return "";
  const std::string kind = headings.size() > 4 ? "scroll wide" : headings.back().starts_with('#') ? "scroll narrow" : "scroll";
  return tag("div", tag("table", tag("thead", row_of(headings, "th")) + tag("tbody", body)), kind) + "\n";
}

std::string header(const std::string& title, const std::string& made_by) {
  return tag("header", tag("h1", title) + tag("p", made_by)) + "\n";
}

std::string page(const std::string& title, const std::string& content) {
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n" +
         tag("title", title) + "\n" + tag("style", report_style) + "\n</head>\n<body>\n<main>\n" + content +
         "</main>\n</body>\n</html>\n";
}

}  // namespace misfit::tools::html
