#include "tools/base/value_checks.h"

#include <stdexcept>
#include <utility>

namespace misfit::tools {

std::string CheckingProgram::wrong_value(const CLI::App& command) const {
  const auto found = checks_.find(&command);
  if (found == checks_.end()) return "";
  try {
    found->second();
  } catch (const std::invalid_argument& wrong) {
    return wrong.what();
  } catch (const std::runtime_error&) {  // of files, which are looked at once all is there
  }
  return "";
}

void check_before_missing(CLI::App& command, std::function<void()> check) {
  CLI::App* root = &command;
  while (root->get_parent() != nullptr) root = root->get_parent();
  if (auto* const program = dynamic_cast<CheckingProgram*>(root)) program->checks_[&command] = std::move(check);
}

}  // namespace misfit::tools
