#pragma once

#include <vector>

#include "kernels/least_misfit.h"
#include "tools/base/progress.h"
#include "tools/report/report_folder.h"
#include "tools/stability/stability_runs.h"

namespace misfit::tools {

/// The effect of rounding on gridding functions, gridding, sums and whole runs, all computed when called. Throws
/// Interrupted, and std::runtime_error when the MeasurementSet cannot be used.
Report stability_report(const StabilityOptions& options, ProgressLine& progress);

/// The effect of rounding on one gridding function, as E over |x| ≤ x0.
struct RoundingLoss {
  int width = 0;
  double x0 = 0;
  kernels::Origin optimum;      ///< in the arithmetic that it takes
  double normal_equations = 0;  ///< C solved in double for the optimal h, by normal equations …
  double orthogonal = 0;        ///< … and by QR
  double stored_in_double = 0;  ///< the optimal C as a polynomial of doubles
  double stored_in_single = 0;  ///< its values rounded to floats
  double noise_gain = 0;        ///< see kernels::noise_gain
  double correction_range = 0;  ///< largest h over the smallest

  /// The E that is left when every value of C is off by half a unit in the last place of 1.
  double floor() const;
};

/// Over widths 1 … 20 and x0 from 0.01 to 0.49, widths innermost; quickly, three x0 alone.
std::vector<RoundingLoss> rounding_losses(bool quick, ProgressLine& progress);

/// Sections of the report, each in a file of its own or with its like.
ReportSection conditioning_section(const std::vector<RoundingLoss>& losses);  ///< condition, and what each arithmetic loses
ReportSection limits_section(const std::vector<RoundingLoss>& losses);        ///< x0 towards 0 and ½
ReportSection boundaries_section();                                           ///< where cells meet, grid points, half points
ReportSection coordinates_section();                                          ///< coordinates of many cells
ReportSection magnitudes_section();                                           ///< denormal and huge visibilities
ReportSection accumulation_section();                                         ///< long sums

}  // namespace misfit::tools
