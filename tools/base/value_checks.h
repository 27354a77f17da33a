#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <map>
#include <string>

namespace misfit::tools {

/// A program whose commands can look at the values that were given before the parser says what is missing.
class CheckingProgram : public CLI::App {
 public:
  using CLI::App::App;

  /// Says which of the values that `command` was given is wrong; empty where none is, or it has no check.
  std::string wrong_value(const CLI::App& command) const;

 private:
  friend void check_before_missing(CLI::App& command, std::function<void()> check);
  std::map<const CLI::App*, std::function<void()>> checks_;
};

/// Has `check` look at the values of `command` where an option that is required is missing: it throws std::invalid_argument, as
/// the command itself does first of all, and passes over what was not given. Nothing where `command` is not of a
/// CheckingProgram.
void check_before_missing(CLI::App& command, std::function<void()> check);

}  // namespace misfit::tools
