#pragma once

#include <string>

#include "imager/plan/gridding_choice.h"

namespace misfit::imager {

/// Why the accuracy asked cannot be had, in one line, where the best choice is but the most exact one: what limits it (tables,
/// the precision, or the kernel), an accuracy that will be granted, and what to change. `what` the accuracy is of comes first.
std::string out_of_reach(const GriddingRequest& request, const GriddingChoice& choice, const std::string& what = "accuracy");

}  // namespace misfit::imager
