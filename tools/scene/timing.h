#pragma once

#include <vector>

#include "tools/scene/measure.h"

namespace misfit::tools {

/// NaN of none.
double median(std::vector<double> values);

/// The results that were run, each with the runs of all that do the same work: kernels of one width differ in their numbers,
/// not in what they cost.
std::vector<PointResult> pooled_by_work(const std::vector<PointResult>& results);

/// Seconds of the image and of the prediction, medians over a point's runs.
double image_seconds(const PointResult& result);
double predict_seconds(const PointResult& result);

/// (slowest − fastest) / median of the image.
double spread(const PointResult& result);

/// What the median seconds of each result are uncertain by, one standard error as a part of them: 1.25 σ/√n, with σ from the
/// median deviation of its runs. No less than in the middle of all results, since a few runs may agree by chance.
std::vector<double> time_noise(const std::vector<PointResult>& results, double (SceneSeconds::*seconds)() const);

}  // namespace misfit::tools
