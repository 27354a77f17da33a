#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace misfit::tools {

/// The member `key` of an object, or null.
const nlohmann::json& member(const nlohmann::json& object, const std::string& key);

/// The member `key` where it is a number, or else NaN.
double number(const nlohmann::json& object, const std::string& key);

/// A value of report.json as HTML: strings as they are, lists separated by commas, null as "not measured".
std::string plain(const nlohmann::json& value);

/// A count as HTML, with thin spaces between groups of digits.
std::string whole(const nlohmann::json& value);

/// A quantity in `unit` as HTML, with the prefix that suits it.
std::string with_unit(const nlohmann::json& value, const std::string& unit, int digits = 3);

/// The words for a value that is null.
extern const std::string not_measured;

}  // namespace misfit::tools
