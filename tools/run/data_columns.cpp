#include "tools/run/data_columns.h"

#include <algorithm>

#include "tools/base/numbers.h"

namespace misfit::tools {
namespace {

constexpr const char* automatic = "auto";

bool alike(const std::vector<ms_io::DataColumn>& columns) {
  return std::all_of(columns.begin(), columns.end(), [&](const auto& column) { return column.name == columns.front().name; });
}

/// "field 2 of spectral window 1 (1 200 rows)"
std::string words_on(const ms_io::SelectionPart& part) {
  const std::string window = "spectral window " + std::to_string(part.window), field = "field " + std::to_string(part.field);
  const std::string name = part.field == ms_io::SelectionPart::all    ? window
                           : part.window == ms_io::SelectionPart::all ? field
                                                                      : field + " of " + window;
  return name + " (" + grouped(static_cast<long long>(part.rows)) + (part.rows == 1 ? " row)" : " rows)");
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
  if (columns.size() == 1) because += "; the set has " + columns.front().there;
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

std::string zeros_warning(const ms_io::ZeroColumn& column) {
  const std::string data = column.name == "DATA" ? "" : "; --datacolumn data takes DATA";
  if (column.zeros.everywhere)
    return "all that was read of " + column.name + " of " + column.path + " is 0: it was never filled" + data;
  constexpr std::size_t most_listed = 20;
  const std::vector<ms_io::SelectionPart>& parts = column.zeros.parts;
  std::string list;
  for (std::size_t i = 0; i < std::min(parts.size(), most_listed); ++i) list += (i == 0 ? "" : ", ") + words_on(parts[i]);
  if (parts.size() > most_listed) list += " and " + std::to_string(parts.size() - most_listed) + " more";
  return "all that was read of " + list + " is 0 in " + column.name + " of " + column.path +
         ": it was never filled there; leave it out by --spw or --field" + (data.empty() ? "" : ", or" + data.substr(1));
}

}  // namespace misfit::tools
