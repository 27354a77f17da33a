#include "tools/run/data_columns.h"

#include <algorithm>

namespace misfit::tools {
namespace {

constexpr const char* automatic = "auto";

bool alike(const std::vector<ms_io::DataColumn>& columns) {
  return std::all_of(columns.begin(), columns.end(), [&](const auto& column) { return column.name == columns.front().name; });
}

}  // namespace

std::string columns_text(const std::vector<ms_io::DataColumn>& columns) {
  if (alike(columns)) return columns.front().name;
  std::string text;
  for (const ms_io::DataColumn& column : columns) text += (text.empty() ? "" : ", ") + column.name + " of " + column.path;
  return text;
}

imager::Decision data_column_decision(const std::vector<ms_io::DataColumn>& columns, const std::string& asked) {
  std::string because = asked == automatic ? "CORRECTED_DATA where a set has it, else DATA" : "--datacolumn " + asked;
  for (const ms_io::DataColumn& column : columns)
    for (const std::string& command : column.subtracted)
      because += "; " + column.name + " of " + column.path + " lacks the model that was subtracted by " + command;
  return {"data column", columns_text(columns), because};
}

std::string unlike_columns_warning(const std::vector<ms_io::DataColumn>& columns, const std::string& asked) {
  if (asked != automatic || alike(columns)) return "";
  return "some sets have calibrated data and others have not: imaged are " + columns_text(columns) +
         "; --datacolumn data takes DATA of all";
}

std::vector<std::string> history_of(const std::string& command_line, const std::vector<ms_io::DataColumn>& columns) {
  return {command_line, "data column: " + columns_text(columns)};
}

std::string zeros_warning(const ms_io::DataColumn& column) {
  return "all that was read of " + column.name + " of " + column.path + " is 0: it was never filled" +
         (column.name == "DATA" ? "" : "; --datacolumn data takes DATA");
}

}  // namespace misfit::tools
