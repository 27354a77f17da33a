#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace misfit::tools {

/// A command returns this to its caller, at the first rank.
struct Outcome {
  bool complete = true;   ///< at all ranks: all was done, and the user did not stop it
  nlohmann::json report;  ///< null where there is none
  std::string words;      ///< for people, whole lines
};

/// Gives the outcome to `caller`; where that is null, prints its words on standard output unless `quiet`.
void conclude(Outcome&& outcome, bool quiet, Outcome* caller);

}  // namespace misfit::tools
