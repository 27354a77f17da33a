#pragma once

#include <string>

#include "imager/plan/gridding_choice.h"

namespace misfit::imager {

/// The reason why the accuracy asked cannot be had, in one line, where the choice is only the most exact one: what limits it
/// (tables, the precision, or the kernel), an accuracy that will be granted, and what to change. The line begins with `what`,
/// the name of the accuracy.
std::string out_of_reach(const GriddingRequest& request, const GriddingChoice& choice, const std::string& what = "accuracy");

}  // namespace misfit::imager
