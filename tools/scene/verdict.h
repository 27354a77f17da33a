#pragma once

#include <string>
#include <vector>

#include "tools/scene/measure.h"
#include "tools/scene/pareto.h"

namespace misfit::tools {

/// Cost and error of each result.
std::vector<CostAndError> image_costs(const std::vector<PointResult>& results);
std::vector<CostAndError> predict_costs(const std::vector<PointResult>& results);

/// How well times and errors are known, in a sentence.
std::string words_on_noise(const std::vector<PointResult>& results);

/// How much the machine's speed changed, in a sentence. `results` are as they were measured, not pooled.
std::string words_on_speed(const std::vector<PointResult>& results);

/// A verdict on the front of error against seconds where errors lie within [1e-7, 1e-3]: that it consists of least-misfit and
/// minimax kernels, or which others are on it and by how much they are faster; or that times are too noisy to say.
std::string verdict_on(const std::vector<PointResult>& results);

}  // namespace misfit::tools
