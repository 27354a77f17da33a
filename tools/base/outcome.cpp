#include "tools/base/outcome.h"

#include <cstdio>
#include <utility>

namespace misfit::tools {

void conclude(Outcome&& outcome, bool quiet, Outcome* caller) {
  if (caller != nullptr)
    *caller = std::move(outcome);
  else if (!quiet)
    std::fputs(outcome.words.c_str(), stdout);
}

}  // namespace misfit::tools
