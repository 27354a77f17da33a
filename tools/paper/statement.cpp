#include "tools/paper/statement.h"

#include "tools/base/numbers.h"
#include "tools/report/kernel_curves.h"

namespace misfit::tools {

std::string verdict(bool agrees, const std::string& why) {
  return agrees ? "agrees" : "differs: " + why;
}

Statement hundredfold(const std::string& where, const std::string& what, const std::map<int, double>& ratio_by_width) {
  std::string numbers;
  int first = 0;  // width from which on the ratio is above 100
  for (const auto& [width, ratio] : ratio_by_width) {
    numbers += (numbers.empty() ? "" : ", ") + significant(ratio, 3) + " (" + width_label(width) + ")";
    if (ratio <= 100) {
      first = 0;
    } else if (first == 0) {
      first = width;
    }
  }
  return {where, what, "more than 100 times", numbers,
          first == 0                               ? verdict(false, "no width here reaches 100")
          : first == ratio_by_width.begin()->first ? verdict(true, "")
                                                   : "agrees from W = " + std::to_string(first)};
}

DataTable statements_table(const std::string& name, const std::string& title, const std::string& caption,
                           const std::vector<Statement>& statements) {
  DataTable table{.name = name,
                  .title = title,
                  .caption = caption,
                  .columns = {"where", "statement", "the paper", "our numbers", ""},
                  .rows = {}};
  for (const Statement& s : statements) table.rows.push_back({s.where, s.what, s.paper, s.ours, s.verdict});
  return table;
}

}  // namespace misfit::tools
