#include "tools/run_page/outside_section.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "imager/data/geometry.h"
#include "tools/base/numbers.h"
#include "tools/report/html.h"
#include "tools/report/html_elements.h"
#include "tools/report/report_values.h"

namespace misfit::tools {
namespace {

using html::Row;
using html::tag;
using nlohmann::json;

std::string text(const json& object, const char* key) {
  const json& value = member(object, key);
  return value.is_string() ? value.get<std::string>() : "";
}

/// The unit for the largest number under `key`, so that all rows compare at a glance.
ScaledUnit unit_of(const json& sources, const char* key, const std::string& base) {
  double largest = 0;
  for (const json& source : sources) largest = std::fmax(largest, std::abs(number(source, key)));
  return scaled_unit(largest, base);
}

std::string table_of(const json& sources) {
  const ScaledUnit flux = unit_of(sources, "flux_jy", "Jy"), alias = unit_of(sources, "alias_jy", "Jy/beam");
  std::vector<Row> rows;
  for (const json& source : sources) {
    imager::SkyDirection at;
    at.ra_rad = number(source, "ra_deg") * M_PI / 180;
    at.dec_rad = number(source, "dec_deg") * M_PI / 180;
    const std::string border = member(source, "at_border") == true ? tag("small", " at the border searched, or beyond") : "";
    rows.push_back({html_escaped(sexagesimal(at)) + border, significant(number(source, "l_arcsec"), 5),
                    significant(number(source, "m_arcsec"), 5), significant(number(source, "flux_jy") / flux.size, 3),
                    significant(number(source, "alias_jy") / alias.size, 2)});
  }
  return html::table({"Position", "#East" + tag("small", "arcsec"), "#North" + tag("small", "arcsec"),
                      "#Flux" + tag("small", flux.name), "#Alias" + tag("small", alias.name)},
                     rows);
}

}  // namespace

std::string outside_section(const json& report) {
  const json &sources = member(report, "outside"), &search = member(report, "outside_search");
  if (!sources.is_array() || !search.is_object()) return "";
  const std::string noise = html_escaped(text(search, "noise"));
  std::string told = "Sources above " + with_unit(member(search, "least_jy"), "Jy", 2) +
                     " outside the image, in a field four times as wide and high: " + whole(member(search, "found")) + ". ";
  if (number(search, "found") > 0)
    told += "The highest alias is " + with_unit(member(search, "highest_alias_jy"), "Jy/beam", 2) + " at most, all together " +
            with_unit(member(search, "all_aliases_jy"), "Jy/beam", 2) + ". ";
  const std::string elsewhere = html_escaped(text(search, "elsewhere"));
  std::string unknown;
  if (!elsewhere.empty()) unknown = tag("p", tag("strong", "Elsewhere:").append(" ").append(elsewhere).append("."));
  const std::string sidelobes =
      " An alias is what gridding adds to the exact image. The sources' sidelobes belong to that image, and no kernel removes"
      " them: only a wider image does, or a model taken off the data.";
  if (sources.empty())
    return tag("p", told + (unknown.empty() ? "No alias" : "No alias that is known") + " exceeds the image's noise, " + noise +
                        "." + sidelobes) +
           "\n" + unknown;
  return tag("p", told + "The aliases of these may exceed the image's noise, " + noise +
                      "; a smaller --accuracy, a wider kernel or more padding keeps them out." + sidelobes) +
         "\n" + unknown + "\n" + table_of(sources);
}

}  // namespace misfit::tools
