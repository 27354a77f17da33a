#pragma once

#include <vector>

#include "tools/report/report_folder.h"
#include "tools/scene/measure.h"
#include "tools/scene/programs.h"

namespace misfit::tools {

/// Sections of the report of a scene.
ReportSection front_section(const ImageOptions& scene, const Scene& measured, const std::vector<PointResult>& results);
ReportSection theory_section(const std::vector<PointResult>& results);  ///< expected errors and bounds beside the measured
ReportSection programs_section(const ProgramComparison& programs);
ReportSection points_section(const ImageOptions& scene, const std::vector<PointResult>& results);  ///< every point

}  // namespace misfit::tools
