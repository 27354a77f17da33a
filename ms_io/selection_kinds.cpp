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

std::string to_text(const Selection& selection) {
  std::string text;
  for (const SelectionKind& kind : selection_kinds) {
    const std::string& expression = selection.*kind.expression;
    if (!expression.empty()) text += (text.empty() ? "--" : " --") + std::string(kind.option) + " '" + expression + "'";
  }
  return text;
}

}  // namespace misfit::ms_io
