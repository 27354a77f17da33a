#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace misfit::tools {

struct PagePicture {
  std::string title;
  std::string png;  ///< the file's bytes
};

/// SVG elements, or nothing where there is no such drawing.
struct PageDrawings {
  std::string histogram;  ///< that of pixel_histogram.h
  std::string spectrum;   ///< of a cube's planes
};

/// The run's page: one self-contained HTML5 file without scripts or links, built from the content of report.json.
/// Beyond the keys that DESIGN.md names it reads, where they are there: `warnings` (a list of sentences, shown on top),
/// `command_line`, `noise.predicted_jy`, `timings_s.total` (the wall clock), `timings_expected_s` (as `timings_s`),
/// `clean.major_cycles_log` (a list of {iterations, peak_residual_jy, rms_jy, model_flux_jy, cycle_threshold_jy, ended}),
/// `clean.kept_cycle` (its element whose model was kept), and `residual_histogram`, see pixel_histogram.h. Values that are null
/// or absent are shown as not measured, or left out with their section. For a cube it reads `planes` and `spectral_axis`.
std::string report_page(const nlohmann::json& report, const std::vector<PagePicture>& pictures,
                        const PageDrawings& drawings = {});

}  // namespace misfit::tools
