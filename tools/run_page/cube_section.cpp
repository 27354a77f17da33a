#include "tools/run_page/cube_section.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "tools/base/numbers.h"
#include "tools/report/html.h"
#include "tools/report/html_elements.h"
#include "tools/report/report_values.h"

namespace misfit::tools {
namespace {

using nlohmann::json;

constexpr std::size_t most_rows = 256;

std::string plane_beam(const json& beam) {
  const json &major = member(beam, "major_arcsec"), &minor = member(beam, "minor_arcsec"), &angle = member(beam, "pa_deg");
  if (!major.is_number() || !minor.is_number() || !angle.is_number()) return "";
  return significant(major.get<double>(), 4) + " × " + significant(minor.get<double>(), 4) + "″ at " +
         significant(angle.get<double>(), 3) + "°";
}

std::string frequency(const json& hz) {
  return hz.is_number() ? frequency_text(hz.get<double>(), 9) : not_measured;
}

html::Row row_of(const json& plane, bool cleaned) {
  const json& noise = member(plane, "noise");
  html::Row row{plain(member(plane, "plane")), frequency(member(plane, "frequency_hz")), whole(member(plane, "used"))};
  if (member(plane, "used") == 0) {
    row.resize(cleaned ? 9 : 6);
    return row;
  }
  row.insert(row.end(), {plane_beam(member(plane, "beam")), with_unit(member(noise, "measured_jy"), "Jy/beam"),
                         with_unit(member(plane, "brightest_jy"), "Jy/beam")});
  if (!cleaned) return row;
  const json& clean = member(plane, "clean");
  row.insert(row.end(), {whole(member(clean, "iterations")), with_unit(member(clean, "model_flux_jy"), "Jy"),
                         plain(member(clean, "stop_reason"))});
  return row;
}

/// The frame of the planes' frequencies, where they were made in one.
std::string frame_of(const json& axis) {
  const std::string frame = plain(member(axis, "frame"));
  return frame.empty() ? "" : " in " + frame;
}

}  // namespace

std::string cube_section(const json& report) {
  const json& planes = member(report, "planes");
  if (!planes.is_array() || planes.empty()) return "";
  const json& axis = member(report, "spectral_axis");
  const bool cleaned =
      std::any_of(planes.begin(), planes.end(), [](const json& plane) { return member(plane, "clean").is_object(); });
  const bool many = planes.size() > most_rows;
  std::string content = html::tag(
      "p", std::to_string(planes.size()) + " planes" + frame_of(axis) + ", from " + frequency(member(axis, "reference_hz")) +
               (many ? "; the table shows the first " + std::to_string(most_rows) : "") +
               ". What the rest of this page says of images is of the plane with the brightest pixel.");
  std::vector<std::string> heads{"#Plane", "#Frequency", "#Samples", "Beam", "#Noise", "#Brightest pixel"};
  if (cleaned) heads.insert(heads.end(), {"#Components", "#Model flux", "CLEAN ended"});
  std::vector<html::Row> rows;
  for (std::size_t i = 0; i < std::min(planes.size(), most_rows); ++i) rows.push_back(row_of(planes[i], cleaned));
  return content + html::table(heads, rows);
}

}  // namespace misfit::tools
