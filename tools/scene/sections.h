#pragma once

#include <vector>

#include "tools/report/report_folder.h"
#include "tools/scene/measure.h"
#include "tools/scene/programs.h"

namespace misfit::tools {

/// Sections of the report of a scene.
ReportSection front_section(const ImageOptions& scene, const Scene& measured, const std::vector<PointResult>& results);
ReportSection theory_section(const std::vector<PointResult>& results);  ///< expected errors and bounds beside the measured
ReportSection programs_section(const std::vector<ProgramResult>& programs);
ReportSection points_section(const ImageOptions& scene, const std::vector<PointResult>& results);  ///< every point

/// The results that were not refused, each with the runs of all that do the same work: kernels of one width differ in their
/// numbers, not in what they cost.
std::vector<PointResult> pooled_by_work(const std::vector<PointResult>& results);

/// Seconds of the image, median over a point's runs.
double image_seconds(const PointResult& result);

/// What the medians of seconds are uncertain by, as a part of them: half the spread of a point's runs over the root of their
/// number, in the middle of all points; at most a tenth.
double time_noise(const std::vector<PointResult>& results);

/// Which of the results are on the front of error against seconds, within the noise of these.
std::vector<bool> front_of(const std::vector<PointResult>& results);

/// What the front says of least-misfit and minimax kernels where errors lie within [1e-7, 1e-3]: that it consists of them, or
/// which others are on it and by how much they are faster.
std::string verdict_on(const std::vector<PointResult>& results);

}  // namespace misfit::tools
