#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <variant>
#include <vector>

namespace misfit::tools {

/// A table of text and numbers. All text is plain UTF-8; a number that is not finite is one that does not exist.
struct DataTable {
  using Cell = std::variant<std::string, double>;

  std::string name;  ///< stem of its file: letters, digits and hyphens
  std::string title;
  std::string caption;
  std::vector<std::string> columns;
  std::vector<std::vector<Cell>> rows;  ///< as long as `columns` (std::logic_error where they are written)
  int digits = 3;                       ///< significant ones, in HTML
  std::vector<std::string> code{};      ///< columns of text to copy: as typed, each in one line
};

/// As an HTML table; columns without text are aligned as numbers.
std::string table_html(const DataTable& table);

/// A line of column names and one for each row, numbers with as many digits as doubles need.
std::string table_csv(const DataTable& table);

/// {name, title, caption, columns, rows}.
nlohmann::json table_json(const DataTable& table);

/// `text` as a field of a CSV file (RFC 4180).
std::string csv_field(const std::string& text);

/// A number with 17 digits, as a field of a CSV file; empty where it is not finite.
std::string csv_number(double value);

}  // namespace misfit::tools
