#pragma once

#include <string>

namespace misfit::tools {

/// The text of `misfit --version`: "misfit 0.1.0", then a line for each fact of the build and each library, as it is linked.
std::string version_text();

}  // namespace misfit::tools
