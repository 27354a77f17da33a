#include "tools/kernel_report/kernel_report.h"
#include "tools/kernel_report/paper_statements.h"

namespace misfit::tools {

ReportSection paper_section(SolvedKernels& solved) {
  std::vector<Statement> all = function_statements(solved);
  const PaperCosts costs = paper_costs(solved);
  for (const std::vector<Statement>& some : {table_statements(solved), costs.statements})
    all.insert(all.end(), some.begin(), some.end());
  return {.heading = "The paper's statements",
          .paragraphs = {},
          .figures = {},
          .tables = {statements_table("paper", "What the paper says and what we find",
                                      "Our numbers are computed by this run. Seconds are of this machine, on one core.", all),
                     costs.operations}};
}

}  // namespace misfit::tools
