#pragma once

#include <map>
#include <string>
#include <vector>

#include "tools/report/data_table.h"

namespace misfit::tools {

/// A statement of Ye, Gull, Tan & Nikolic 2020 (MNRAS 491, 1146) beside what this program finds.
struct Statement {
  std::string where;  ///< in the paper, such as "§6.2"
  std::string what;
  std::string paper;    ///< what it says
  std::string ours;     ///< what this program computes
  std::string verdict;  ///< "agrees", or "differs" and why
};

/// "agrees" or "differs: " and why.
std::string verdict(bool agrees, const std::string& why);

/// The statement that the spheroidal function errs by more than 100 times what the least-misfit function does, given the ratio
/// by width.
Statement hundredfold(const std::string& where, const std::string& what, const std::map<int, double>& ratio_by_width);

/// A table with a row for each statement.
DataTable statements_table(const std::string& name, const std::string& title, const std::string& caption,
                           const std::vector<Statement>& statements);

}  // namespace misfit::tools
