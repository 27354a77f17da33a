#include "tools/base/option_checks.h"

#include <stdexcept>

namespace misfit::tools {

CLI::Validator quantity(double (*parse)(const std::string&)) {
  return CLI::Validator(
      [parse](const std::string& value) -> std::string {
        try {
          parse(value);
          return "";
        } catch (const std::invalid_argument& error) {
          return error.what();
        }
      },
      "");
}

CLI::Validator not_empty() {
  return CLI::Validator([](const std::string& value) -> std::string { return value.empty() ? "'': expected a name" : ""; }, "");
}

}  // namespace misfit::tools
