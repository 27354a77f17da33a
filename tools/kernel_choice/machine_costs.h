#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "imager/plan/cost_model.h"

namespace misfit::tools {

/// The name of the machine that timings hold for: processor and version of misfit.
std::string machine_name();

/// The cost constants of this machine: measured once for a processor and version of misfit, and kept as costs.json in `folder`.
/// A file that is damaged, of another machine or of another version is measured anew; where nothing can be kept, they are
/// measured each time, which `measure` does.
imager::CostModel machine_costs(const std::filesystem::path& folder,
                                const std::function<imager::CostModel()>& measure = imager::measure_costs);

/// The cost constants kept in `folder`, if there are any of this machine.
std::optional<imager::CostModel> kept_costs(const std::filesystem::path& folder);

}  // namespace misfit::tools
