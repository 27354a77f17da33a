#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace misfit::tools {

/// A program goes on to its end when the user asks this one to stop, or is asked to end too.
enum class OnInterrupt { finish, stop };

/// Runs a program found on PATH, or at a path, in `folder`, without input; what it says on both streams is left in the file
/// "said" there. Returns the status that waitpid tells, 0 only where the program succeeded; nothing where there is no such
/// program.
std::optional<int> run_program(std::vector<std::string> words, const std::filesystem::path& folder,
                               OnInterrupt on_interrupt = OnInterrupt::finish);

}  // namespace misfit::tools
