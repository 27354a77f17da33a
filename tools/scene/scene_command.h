#pragma once

namespace CLI {
class App;
}

namespace misfit::tools {

/// Adds `misfit report scene`; see command.h.
void add_scene_report(CLI::App& reports);

}  // namespace misfit::tools
