#pragma once

#include <vector>

#include "tools/report/data_table.h"
#include "tools/report/report_folder.h"
#include "tools/stability/stability_data.h"
#include "tools/stability/stability_run.h"

namespace misfit::tools {

/// Families of extreme observations, imposed on the places of `data`.
std::vector<StabilityCase> weight_cases(const StabilityData& data);  ///< weights over 10⁶⁰, sums beyond single precision
std::vector<StabilityCase> dynamic_range_cases(const StabilityData& data);  ///< a source of up to 10⁹ Jy beside those of 0.3 Jy
/// Up to `most` equal samples in one uv cell; CLEAN has one major cycle, which may take as long as it takes.
std::vector<StabilityCase> one_cell_cases(std::uint64_t most);
std::vector<StabilityCase> few_places_cases(const StabilityData& data);  ///< on one line, or in two or three uv cells
std::vector<StabilityCase> boundary_cases(const StabilityData& data);    ///< at 1/(2 cell) exactly, where cells meet
std::vector<StabilityCase> bandwidth_cases(const StabilityData& data);   ///< from one channel to 3:1
/// |w| up to each of `reaches`, in wavelengths, far from the phase centre.
std::vector<StabilityCase> w_cases(const StabilityData& data, const std::vector<double>& reaches);
std::vector<StabilityCase> pole_cases(const StabilityData& data);  ///< phase centres at ±90°

/// A row for each outcome.
DataTable outcome_table(const std::string& name, const std::string& title, const std::vector<StabilityOutcome>& outcomes);

struct StabilityOptions {
  std::string vis;     ///< a MeasurementSet to take places from; empty: made
  bool quick = false;  ///< fewer samples
};

/// Their sections of the report, each in a file of its own or with its like.
ReportSection values_section(const StabilityData& data, const StabilityOptions& options);  ///< weights, brightness, crowds
ReportSection places_section(const StabilityData& data);                                   ///< lines, few cells, edges, bands
ReportSection w_section(const StabilityData& data, const StabilityOptions& options);
ReportSection poles_section(const StabilityData& data);

}  // namespace misfit::tools
