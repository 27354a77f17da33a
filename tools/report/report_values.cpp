#include "tools/report/report_values.h"

#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "tools/base/json_text.h"
#include "tools/base/numbers.h"
#include "tools/report/html.h"

namespace misfit::tools {

using nlohmann::json;

const std::string not_measured = "<span class=\"none\">not measured</span>";

const json& member(const json& object, const std::string& key) {
  static const json none;
  if (!object.is_object()) return none;
  const auto found = object.find(key);
  return found == object.end() ? none : *found;
}

double number(const json& object, const std::string& key) {
  const json& value = member(object, key);
  return value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN();
}

std::string plain(const json& value) {
  if (value.is_string()) return html_escaped(value.get<std::string>());
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (value.is_number_float()) return significant(value.get<double>(), 6);
  if (!value.is_array()) return value.is_null() ? not_measured : html_escaped(json_text(value));
  std::string text;
  for (const json& element : value) text += (text.empty() ? "" : ", ") + plain(element);
  return text;
}

std::string whole(const json& value) {
  return value.is_number() ? grouped(std::llround(value.get<double>())) : not_measured;
}

std::string with_unit(const json& value, const std::string& unit, int digits) {
  return value.is_number() ? with_prefix(value.get<double>(), unit, digits) : not_measured;
}

}  // namespace misfit::tools
