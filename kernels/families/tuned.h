#pragma once

#include <functional>
#include <string>

#include "kernels/catalogue.h"

namespace misfit::kernels {

/// A gridding function with one parameter β, the taps for each width and β.
using TapsOfParameter = std::function<TapFunction(int width, double parameter)>;

/// The β for which E, the mean of the map error over |x| ≤ x0 with the optimal correction, is smallest.
double tune_parameter(const TapsOfParameter& taps, int width, double x0);

/// The family whose kernels are tuned so; Origin::parameter says to what.
KernelFamily tuned_family(const std::string& name, const std::string& description, const TapsOfParameter& taps);

}  // namespace misfit::kernels
