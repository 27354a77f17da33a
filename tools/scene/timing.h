#pragma once

#include <map>
#include <vector>

#include "tools/scene/measure.h"

namespace misfit::tools {

/// The median of the values; NaN where there are none.
double median(std::vector<double> values);

/// The slowness of each stretch: how many times as long as usual the machine took. It is the median, over the stretch's runs,
/// of a run's seconds over the usual seconds of its work; these are the median, over the work's runs, of seconds over the
/// slowness of their stretches, and so on by turns. The median over all runs is 1; a stretch of fewer than three runs is taken
/// as 1.
std::map<int, double> slowness(const std::vector<PointResult>& results);

/// The results that were run, each with the runs of all that do the same work: kernels of one width differ in their numbers,
/// not in what they cost. Seconds are divided by the slowness of their stretches.
std::vector<PointResult> pooled_by_work(const std::vector<PointResult>& results);

/// Seconds of the image and of the prediction, medians over a point's runs.
double image_seconds(const PointResult& result);
double predict_seconds(const PointResult& result);

/// (slowest − fastest) / median of the image.
double spread(const PointResult& result);

/// The uncertainty of each result's median seconds, one standard error as a part of them: 1.25 σ/√n, with σ from the median
/// deviation of its runs. No less than in the middle of all results, since a few runs may agree by chance.
std::vector<double> time_noise(const std::vector<PointResult>& results, double (SceneSeconds::*seconds)() const);

}  // namespace misfit::tools
