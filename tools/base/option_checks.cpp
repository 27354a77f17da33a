#include "tools/base/option_checks.h"

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <stdexcept>

namespace misfit::tools {
namespace {

std::string name_of(OptionMark mark) {
  return "mark " + std::to_string(static_cast<int>(mark));
}

}  // namespace

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

CLI::Validator not_zero(const std::string& expected) {
  return CLI::Validator(
      [expected](const std::string& value) -> std::string {
        char* end = nullptr;
        const bool zero = std::strtod(value.c_str(), &end) == 0 && end != value.c_str() && *end == '\0';
        return zero ? value + ": expected " + expected : "";
      },
      "");
}

CLI::Validator not_empty() {
  return CLI::Validator([](const std::string& value) -> std::string { return value.empty() ? "'': expected a name" : ""; }, "");
}

CLI::Validator also_named(const std::map<std::string, std::string>& names) {
  return CLI::Validator(
      [names](std::string& value) -> std::string {
        if (const auto found = names.find(value); found != names.end()) value = found->second;
        return "";
      },
      "");
}

CLI::Validator whole_number() {
  return CLI::Validator(
      [](std::string& value) -> std::string {
        constexpr double exact = 9007199254740992;  // 2^53
        char* end = nullptr;
        const double number = std::strtod(value.c_str(), &end);
        const bool is_number = end != value.c_str() && *end == '\0';
        if (is_number && std::abs(number) <= exact && number == std::floor(number) &&
            value.find_first_of(".eE") != std::string::npos && value.find_first_of("xX") == std::string::npos)
          value = std::to_string(static_cast<long long>(number));
        return "";
      },
      "");
}

CLI::Validator values_are(const std::vector<std::string>& names, Others others) {
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ",") + name;
  if (others == Others::possible) list += std::string(",") + and_others;
  return CLI::Validator([](const std::string&) -> std::string { return ""; }, "{" + list + "}");
}

// CLI11 keeps no marks, but validators with names, of which those that are not active do nothing and are not shown.
CLI::Option* mark(CLI::Option* option, OptionMark mark) {
  return option->check(CLI::Validator("").name(name_of(mark)).active(false));
}

bool has(const CLI::Option& option, OptionMark mark) {
  try {
    return const_cast<CLI::Option&>(option).get_validator(name_of(mark)) != nullptr;
  } catch (const CLI::OptionNotFound&) {
    return false;
  }
}

void refuse_option(const std::string& option, const std::string& value, const std::string& expected) {
  throw std::invalid_argument("--" + option + " " + value + ": expected " + expected);
}

std::string typed(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%g", value);
  return buffer;
}

}  // namespace misfit::tools
