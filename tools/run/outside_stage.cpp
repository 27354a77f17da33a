#include "tools/run/outside_stage.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "tools/base/numbers.h"

namespace misfit::tools {
namespace {

constexpr double arcsec = M_PI / 180 / 3600;

std::string with_prefix(double value, const std::string& base, int digits) {
  const ScaledUnit unit = scaled_unit(value, base);
  return significant(value / unit.size, digits) + " " + unit.name;
}

std::string angle(double rad) {
  const ScaledUnit unit = angle_unit(std::abs(rad));
  return significant(std::abs(rad) / unit.size, 3) + " " + unit.name;
}

imager::SkyDirection direction_of(const imager::OutsideSource& s, const OutsideReport& report) {
  return imager::sky_direction(s.source.position, report.field.phase_centre);
}

/// "1.2 deg east and 30 arcmin south of the phase centre"
std::string offset(imager::DirectionCosines at) {
  return angle(at.l) + (at.l < 0 ? " west" : " east") + " and " + angle(at.m) + (at.m < 0 ? " south" : " north") +
         " of the phase centre";
}

/// Of the image's PSF, and beyond it of the wider field's, which knows what short baselines repeat.
imager::Sidelobes sidelobes_of(const imager::Image& psf, const imager::WideSearch& search, const imager::ImageGeometry& image,
                               const imager::ImageGeometry& field) {
  imager::Sidelobes sidelobes(psf);
  sidelobes.raise_to(search.sidelobes.from(std::min(image.width, image.height) / 2 * image.cell_rad / field.cell_rad));
  return sidelobes;
}

}  // namespace

OutsideReport check_outside(const imager::VisibilitySource& source, const imager::GriddingPlan& plan, const imager::Image& psf,
                            double noise_jy, const imager::Progress& progress, imager::StageTimes& times) {
  const imager::WideField field = imager::wide_field(source, plan.request.geometry);
  const imager::WideSearch search = imager::search_wide_field(source, field, plan.request.threads, progress, times);
  OutsideReport report{field.geometry, {}, 0, search.least_jy, noise_jy};
  if (plan.direct) return report;  // direct sums have no aliases
  const imager::AliasLevels aliases(plan, field.geometry, sidelobes_of(psf, search, plan.request.geometry, field.geometry));
  report.sources = imager::sources_outside(search.components, field.geometry, plan.request.geometry, aliases, search.least_jy);
  report.found = report.sources.size();
  const auto matters = [noise_jy](const imager::OutsideSource& s) { return s.alias_jy > noise_jy; };
  report.sources.erase(std::find_if_not(report.sources.begin(), report.sources.end(), matters), report.sources.end());
  return report;
}

imager::Decision outside_decision(const OutsideReport& r) {
  const std::string found = std::to_string(r.found) + " above " + with_prefix(r.least_jy, "Jy", 2) + " in " +
                            angle(r.field.width * r.field.cell_rad) + " × " + angle(r.field.height * r.field.cell_rad);
  const std::string noise = "the image's noise of " + with_prefix(r.noise_jy, "Jy/beam", 2);
  if (r.sources.empty()) return {"sources outside the image", "none matters", found + ", no alias exceeds " + noise};
  return {"sources outside the image", std::to_string(r.sources.size()) + " may show through the kernel",
          found + "; the highest alias is " + with_prefix(r.sources.front().alias_jy, "Jy/beam", 2) + ", " + noise};
}

std::vector<std::string> outside_warnings(const OutsideReport& r) {
  constexpr std::size_t told = 3;
  std::vector<std::string> warnings;
  for (const imager::OutsideSource& s : r.sources) {
    if (warnings.size() == told) break;
    warnings.push_back("a source of " + with_prefix(s.source.flux_jy, "Jy", 3) + " outside the image, at " +
                       sexagesimal(direction_of(s, r)) + ", " + offset(s.source.position) + ", may leave an alias of " +
                       with_prefix(s.alias_jy, "Jy/beam", 2));
  }
  if (r.sources.size() > told)
    warnings.back() += "; and " + std::to_string(r.sources.size() - told) + " more, which the report lists";
  return warnings;
}

nlohmann::json outside_json(const OutsideReport* report) {
  if (report == nullptr) return nullptr;
  nlohmann::json list = nlohmann::json::array();
  for (const imager::OutsideSource& s : report->sources) {
    const imager::SkyDirection at = direction_of(s, *report);
    list.push_back({{"ra_deg", at.ra_rad * 180 / M_PI},
                    {"dec_deg", at.dec_rad * 180 / M_PI},
                    {"l_arcsec", s.source.position.l / arcsec},
                    {"m_arcsec", s.source.position.m / arcsec},
                    {"flux_jy", s.source.flux_jy},
                    {"alias_jy", s.alias_jy}});
  }
  return list;
}

nlohmann::json outside_search_json(const OutsideReport* report) {
  if (report == nullptr) return nullptr;
  return {{"found", report->found},       {"least_jy", report->least_jy},   {"noise_jy", report->noise_jy},
          {"width", report->field.width}, {"height", report->field.height}, {"cell_arcsec", report->field.cell_rad / arcsec}};
}

}  // namespace misfit::tools
