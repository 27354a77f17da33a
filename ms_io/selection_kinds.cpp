#include <algorithm>
#include <stdexcept>

#include "ms_io/selection.h"

namespace misfit::ms_io {

const std::array<SelectionKind, 8> selection_kinds{{
    {"field", &Selection::field, "fields by id, name or pattern, such as 0,2~4 or 3C*"},
    {"spw", &Selection::spectral_window,
     "spectral windows and their channels by index or frequency, such as 0:4~60,2 or *:1.4~1.5GHz"},
    {"timerange", &Selection::time_range, "times, such as 2012/03/04/10:00:00~11:30:00 or >10:00:00"},
    {"uvrange", &Selection::uv_range, "ranges of uv distance, such as 0~500m, <5klambda or >100m"},
    {"antenna", &Selection::antenna, "antennas or baselines by id or name, such as 0,2 or DA41&DA42 or !DV01"},
    {"scan", &Selection::scan, "scan numbers, such as 1,3~5"},
    {"intent", &Selection::intent, "scan intents or patterns of them, such as *TARGET*"},
    {"observation", &Selection::observation, "observations by id, such as 0 or 1~2"},
}};

PerSet::PerSet(std::vector<std::string> of_set) : of_set_(std::move(of_set)) {
  if (of_set_.empty()) of_set_.emplace_back();
}

bool PerSet::empty() const {
  return std::all_of(of_set_.begin(), of_set_.end(), [](const std::string& one) { return one.empty(); });
}

Selection Selection::of_set(std::size_t set) const {
  Selection selection = *this;
  for (const SelectionKind& kind : selection_kinds) selection.*kind.expression = (this->*kind.expression).of(set);
  return selection;
}

void require_one_or_each(const Selection& selection, std::size_t sets) {
  for (const SelectionKind& kind : selection_kinds)
    if (const PerSet& expression = selection.*kind.expression; !expression.fits(sets))
      throw std::invalid_argument(std::string("--") + kind.option + ": " + std::to_string(expression.values().size()) +
                                  " expressions for " + std::to_string(sets) + (sets == 1 ? " set" : " sets") +
                                  "; expected one for all, or one for each");
}

std::string to_text(const Selection& selection) {
  std::string text;
  for (const SelectionKind& kind : selection_kinds) {
    const PerSet& expression = selection.*kind.expression;
    if (expression.empty()) continue;
    text += (text.empty() ? "--" : " --") + std::string(kind.option);
    for (const std::string& value : expression.values()) text += " '" + value + "'";
  }
  return text;
}

}  // namespace misfit::ms_io
