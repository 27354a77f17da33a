#pragma once

#include "tools/base/progress.h"
#include "tools/report/kernel_curves.h"
#include "tools/report/report_folder.h"

namespace misfit::tools {

struct KernelReportOptions {
  bool quick = false;  ///< without rivals, whose minimax functions take most of the time
  bool paper = false;  ///< with the experiments of paper_experiments.h
};

/// The figures and tables of Ye, Gull, Tan & Nikolic 2020 (MNRAS 491, 1146) from our own numbers, and what they did not show,
/// all computed when called. Throws Interrupted.
Report kernel_report(const KernelReportOptions& options, ProgressLine& progress);

/// The report's sections.
ReportSection paper_section(SolvedKernels& solved);         ///< statements of the paper beside our numbers
ReportSection classical_section(SolvedKernels& solved);     ///< what was in use before
ReportSection spheroidal_section(SolvedKernels& solved);    ///< W = 6…14, and its two corrections
ReportSection least_misfit_section(SolvedKernels& solved);  ///< ℓ(x) by W and by x0, C(u), h(x)
ReportSection rivals_section(SolvedKernels& solved);        ///< ratios in RMS and in max norm
ReportSection evaluation_section(SolvedKernels& solved);    ///< lookup tables, and all ways to evaluate
ReportSection cost_section(SolvedKernels& solved);          ///< operations and seconds against visibilities

}  // namespace misfit::tools
