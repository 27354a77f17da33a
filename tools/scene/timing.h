#pragma once

#include <map>
#include <vector>

#include "tools/scene/measure.h"

namespace misfit::tools {

/// NaN of none.
double median(std::vector<double> values);

/// How many times as long as usual the machine took in each stretch: the median over the runs in it of a run's seconds over
/// those that its work takes, which are the median over its runs of seconds over their stretch's factor, and so on by turns.
/// The median over all runs is 1; of a stretch of fewer than three runs nothing is known, and it is taken as 1.
std::map<int, double> slowness(const std::vector<PointResult>& results);

/// The results that were run, each with the runs of all that do the same work: kernels of one width differ in their numbers,
/// not in what they cost. Seconds are divided by the slowness of their stretches.
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
