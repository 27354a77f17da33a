#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace misfit::tools {

/// `value` as JSON, in lines indented by `indent` blanks or, where that is -1, in one line. Names of files, and of what is in
/// files, may be bytes of any kind: those that are not UTF-8 become U+FFFD.
inline std::string json_text(const nlohmann::json& value, int indent = -1) {
  return value.dump(indent, ' ', false, nlohmann::json::error_handler_t::replace);
}

}  // namespace misfit::tools
