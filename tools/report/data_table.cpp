#include "tools/report/data_table.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "tools/base/numbers.h"
#include "tools/report/html.h"
#include "tools/report/html_elements.h"

namespace misfit::tools {
namespace {

void check(const DataTable& table) {
  for (const auto& row : table.rows)
    if (row.size() != table.columns.size())
      throw std::logic_error("table " + table.name + " has a row of " + std::to_string(row.size()) + " cells; expected " +
                             std::to_string(table.columns.size()));
}

bool is_text(const DataTable::Cell& cell) {
  return std::holds_alternative<std::string>(cell);
}

std::string cell_html(const DataTable::Cell& cell, int digits) {
  if (is_text(cell)) return html_escaped(std::get<std::string>(cell));
  const double value = std::get<double>(cell);
  if (std::abs(value) < 1e9 && value == std::round(value)) return grouped(std::llround(value));
  return std::isfinite(value) ? html_power(value, digits) : "–";
}

std::string cell_csv(const DataTable::Cell& cell) {
  return is_text(cell) ? csv_field(std::get<std::string>(cell)) : csv_number(std::get<double>(cell));
}

template <typename Cells, typename Text>
std::string csv_line(const Cells& cells, Text text) {
  std::string line;
  for (const auto& cell : cells) line += "," + text(cell);
  return line.erase(0, 1) + "\n";
}

}  // namespace

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string field = "\"";
  for (const char c : text) field += c == '"' ? std::string("\"\"") : std::string(1, c);
  return field + "\"";
}

std::string csv_number(double value) {
  return std::isfinite(value) ? all_digits(value) : "";
}

std::string table_html(const DataTable& table) {
  check(table);
  html::Row headings;
  for (std::size_t k = 0; k < table.columns.size(); ++k) {
    const bool text = std::any_of(table.rows.begin(), table.rows.end(), [k](const auto& row) { return is_text(row[k]); });
    headings.push_back((text ? "" : "#") + html_escaped(table.columns[k]));
  }
  std::vector<html::Row> rows;
  for (const auto& row : table.rows) {
    rows.emplace_back();
    for (std::size_t k = 0; k < row.size(); ++k) {
      const bool code = std::find(table.code.begin(), table.code.end(), table.columns[k]) != table.code.end();
      const std::string text = cell_html(row[k], table.digits);
      rows.back().push_back(code ? html::tag("code", text) : text);
    }
  }
  return html::table(headings, rows);
}

std::string table_csv(const DataTable& table) {
  check(table);
  std::string text = csv_line(table.columns, csv_field);
  for (const auto& row : table.rows) text += csv_line(row, cell_csv);
  return text;
}

nlohmann::json table_json(const DataTable& table) {
  nlohmann::json rows = nlohmann::json::array();
  for (const auto& row : table.rows) {
    nlohmann::json cells = nlohmann::json::array();
    for (const DataTable::Cell& cell : row) std::visit([&](const auto& value) { cells.push_back(value); }, cell);
    rows.push_back(cells);
  }
  return {{"name", table.name}, {"title", table.title}, {"caption", table.caption}, {"columns", table.columns}, {"rows", rows}};
}

}  // namespace misfit::tools
