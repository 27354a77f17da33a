#pragma once

#include "tools/base/progress.h"
#include "tools/report/kernel_curves.h"
#include "tools/report/report_folder.h"

namespace misfit::tools {

/// The figures and tables of Ye, Gull, Tan & Nikolic 2020 (MNRAS 491, 1146) from our own numbers, and what they did not show,
/// all computed when called; `with_experiments` adds those of paper_experiments.h. Throws Interrupted.
Report kernel_report(ProgressLine& progress, bool with_experiments);

/// The report's sections.
ReportSection paper_section(SolvedKernels& solved);         ///< statements of the paper beside our numbers
ReportSection classical_section(SolvedKernels& solved);     ///< what was in use before
ReportSection spheroidal_section(SolvedKernels& solved);    ///< W = 6…14, and its two corrections
ReportSection least_misfit_section(SolvedKernels& solved);  ///< ℓ(x) by W and by x0, C(u), h(x)
ReportSection rivals_section(SolvedKernels& solved);        ///< ratios in RMS and in max norm
ReportSection evaluation_section(SolvedKernels& solved);    ///< lookup tables, and all ways to evaluate
ReportSection cost_section(SolvedKernels& solved);          ///< operations and seconds against visibilities

}  // namespace misfit::tools
