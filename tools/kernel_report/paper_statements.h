#pragma once

#include <vector>

#include "tools/paper/statement.h"
#include "tools/report/kernel_curves.h"
#include "tools/report/report_folder.h"

namespace misfit::tools {

/// The paper's statements, by subject, beside our numbers.
std::vector<Statement> function_statements(SolvedKernels& solved);  ///< §2.2, §3, §4.1, appendices A to C
std::vector<Statement> table_statements(SolvedKernels& solved);     ///< §6.1, §6.2, appendix F

/// The operations of §6.3 by pairs of W and x0, and what the paper says of them.
struct PaperCosts {
  DataTable operations;
  std::vector<Statement> statements;
};
PaperCosts paper_costs(SolvedKernels& solved);

}  // namespace misfit::tools
