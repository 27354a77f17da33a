#include "tools/run_page/outside_section.h"

#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "imager/geometry.h"
#include "tools/base/numbers.h"
#include "tools/report/html.h"
#include "tools/report/html_elements.h"
#include "tools/report/report_values.h"

namespace misfit::tools {
namespace {

using html::Row;
using html::tag;
using nlohmann::json;

double number(const json& object, const char* key) {
  const json& value = member(object, key);
  return value.is_number() ? value.get<double>() : NAN;
}

/// Of the largest number under `key`, so that all rows compare at a glance.
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
    rows.push_back({html_escaped(sexagesimal(at)), significant(number(source, "l_arcsec"), 5),
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
  const std::string found = "Sources above " + with_unit(member(search, "least_jy"), "Jy", 2) +
                            " outside the image, in a field four times as wide and high: " + whole(member(search, "found")) +
                            ". ";
  const std::string noise = "the image's noise of " + with_unit(member(search, "noise_jy"), "Jy/beam", 2);
  const std::string sidelobes =
      " Their sidelobes are those of the PSF, which no kernel removes: only a wider image does, or a model taken off the data.";
  if (sources.empty()) return tag("p", found + "No alias exceeds " + noise + "." + sidelobes);
  return tag("p", found + "The aliases of these may exceed " + noise +
                      "; a smaller --accuracy, a wider kernel or more padding keeps them out." + sidelobes) +
         "\n" + table_of(sources);
}

}  // namespace misfit::tools
