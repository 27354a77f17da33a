#include "tools/run/outside_stage.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "tools/base/numbers.h"

namespace misfit::tools {
namespace {

constexpr double arcsec_rad = M_PI / 180 / 3600;

std::string angle(double rad) {
  return angle_text(std::abs(rad), 3);
}

imager::SkyDirection direction_of(const imager::OutsideSource& s, const OutsideReport& report) {
  return imager::sky_direction(s.source.position, report.field.phase_centre);
}

/// "1.2 deg east and 30 arcmin south of the phase centre"
std::string offset(imager::DirectionCosines at) {
  return angle(at.l) + (at.l < 0 ? " west" : " east") + " and " + angle(at.m) + (at.m < 0 ? " south" : " north") +
         " of the phase centre";
}

/// "20 µJy/beam at most, as its pixels scatter"
std::string noise_text(const OutsideReport& r) {
  return with_prefix(r.noise_jy, "Jy/beam", 2) + " at most, as " + (r.noise_of_pixels ? "its pixels" : "visibilities") +
         " scatter";
}

/// A sentence on flux that is in no source found; empty where it does not matter.
std::string elsewhere_sentence(const OutsideReport& r) {
  if (!r.elsewhere && r.doubtful == 0) return "";
  const std::string sidelobes = std::to_string(r.doubtful) + (r.doubtful == 1 ? " that was" : " that were") +
                                " found outside the image with less than " + with_prefix(r.least_jy, "Jy", 2) +
                                " may be sidelobes of it, and " + (r.doubtful == 1 ? "is" : "are") + " not listed";
  return (r.elsewhere ? "about " : "up to ") + with_prefix(r.elsewhere_jy, "Jy", 2) +
         " of flux is in no source that was found: calibration errors, or sources beyond the field searched, of unknown alias" +
         (r.doubtful > 0 ? "; " + sidelobes : "");
}

std::string why_not_searched(const OutsideReport& r) {
  return "no usable sample lies within the |u| and |v| that pixels of " + angle(r.field.cell_rad) + " can represent";
}

/// Sidelobes of the image's PSF, and beyond it of the wider field's PSF, which has the repeating lobes of short baselines.
imager::Sidelobes sidelobes_of(const imager::Image& psf, const imager::WideSearch& search, const imager::ImageGeometry& image,
                               const imager::ImageGeometry& field) {
  imager::Sidelobes sidelobes(psf);
  sidelobes.raise_to(search.sidelobes.from(std::min(image.width, image.height) / 2 * image.cell_rad / field.cell_rad));
  return sidelobes;
}

bool brighter(const imager::OutsideSource& a, const imager::OutsideSource& b) {
  return std::abs(a.source.flux_jy) > std::abs(b.source.flux_jy);
}

/// "2 Jy at 12h30m49.4s +12d23m28s, 1.2 deg east and 30 arcmin south of the phase centre"
std::string place(const imager::OutsideSource& s, const OutsideReport& r) {
  return sexagesimal(direction_of(s, r)) + ", " + offset(s.source.position) +
         (s.at_border ? ", at the border of the field searched or beyond it" : "");
}

/// Separates sources from possible sidelobes, and sources that matter from others.
void sort_out(const std::vector<imager::OutsideSource>& all, OutsideReport& r) {
  for (const imager::OutsideSource& s : all) {
    if (std::abs(s.source.flux_jy) < r.least_jy) {
      ++r.doubtful;
      continue;
    }
    r.highest_alias_jy = std::max(r.highest_alias_jy, s.alias_jy);
    r.all_aliases_jy += s.alias_jy;
    (s.alias_jy > r.noise_jy ? r.sources : r.harmless).push_back(s);
  }
  std::stable_sort(r.harmless.begin(), r.harmless.end(), brighter);
}

/// True if there is flux elsewhere: CLEAN leaves about a hundredth of sources between pixels; three hundredths are something
/// else.
bool something_elsewhere(const imager::WideSearch& search) {
  double found_jy = 0;
  for (const imager::Component& c : search.components) found_jy += std::abs(c.flux_jy);
  return search.unexplained.sources_least_jy > 0.03 * found_jy;
}

}  // namespace

imager::Decision search_decision(const imager::WideField& field, double seconds) {
  const imager::ImageGeometry& g = field.geometry;
  return {"search outside the image",
          std::to_string(g.width) + " × " + std::to_string(g.height) + " pixels of " + angle(g.cell_rad),
          "four times the image's field; " + significant(100 * field.reaching, 2) +
              " % of the samples lie within half as far in u and v as these can represent; sources within " +
              angle(g.cell_rad / 2) + " of its border are taken as inside; takes " + duration(seconds)};
}

OutsideReport check_outside(const imager::VisibilitySource& source, const imager::GriddingPlan& plan,
                            const imager::GriddingPlan& wider, const imager::DirtyImages& images, const PixelNoise& pixels,
                            const imager::Context& context) {
  const imager::ImageGeometry &image = plan.request.geometry, &field = wider.request.geometry;
  OutsideReport report;
  report.field = field;
  report.searched = imager::can_be_imaged(field, source);
  if (!report.searched) return report;
  const imager::WideSearch search = imager::search_wide_field(source, wider, context);
  if (!source.ranks().first()) return report;
  report.least_jy = std::max(search.least_jy, search.sidelobe_jy);
  const double scatter_jy = search.unexplained.image_noise_jy(images.sums.front().weight);
  report.noise_of_pixels = pixels.alone || pixels.noise_jy <= scatter_jy;
  report.noise_jy = report.noise_of_pixels ? pixels.noise_jy : scatter_jy;
  report.elsewhere = something_elsewhere(search);
  report.elsewhere_jy = report.elsewhere ? search.unexplained.sources_least_jy : search.unexplained.sources_most_jy;
  if (plan.direct) return report;  // direct sums have no aliases
  const imager::AliasLevels aliases(plan, field, sidelobes_of(images.psf, search, image, field));
  sort_out(imager::sources_outside(search.components, field, image, aliases, search.least_jy), report);
  return report;
}

imager::Decision outside_decision(const OutsideReport& r) {
  if (!r.searched) return {"sources outside the image", "not looked for", why_not_searched(r)};
  std::string because = std::to_string(r.found()) + " above " + with_prefix(r.least_jy, "Jy", 2) + " in " +
                        angle(r.field.width * r.field.cell_rad) + " × " + angle(r.field.height * r.field.cell_rad);
  if (r.found() > 0) because += "; the highest alias is " + with_prefix(r.highest_alias_jy, "Jy/beam", 2) + " at most";
  if (r.found() > 1) because += ", all together " + with_prefix(r.all_aliases_jy, "Jy/beam", 2);
  because += "; the image's noise is " + noise_text(r);
  const std::string above = " above " + with_prefix(r.noise_jy, "Jy/beam", 2);
  const bool blind = r.elsewhere || r.doubtful > 0;
  const std::string none = blind ? "no alias known" : r.all_aliases_jy > r.noise_jy ? "no single alias" : "no alias";
  if (r.sources.empty()) return {"sources outside the image", none + above, because};
  return {"sources outside the image", std::to_string(r.sources.size()) + " may show through the kernel", because};
}

std::vector<std::string> outside_places(const OutsideReport& r) {
  constexpr std::size_t told = 10;
  std::vector<imager::OutsideSource> all = r.sources;
  all.insert(all.end(), r.harmless.begin(), r.harmless.end());
  std::stable_sort(all.begin(), all.end(), brighter);
  std::vector<std::string> lines;
  for (std::size_t i = 0; i < std::min(told, all.size()); ++i)
    lines.push_back("  " + with_prefix(all[i].source.flux_jy, "Jy", 3) + " at " + place(all[i], r) + "; alias " +
                    with_prefix(all[i].alias_jy, "Jy/beam", 2) + " at most");
  if (all.size() > told) lines.push_back("  and " + std::to_string(all.size() - told) + " more, which the report lists");
  return lines;
}

std::vector<std::string> outside_warnings(const OutsideReport& r) {
  constexpr std::size_t told = 3;
  if (!r.searched) return {"sources outside the image were not looked for: " + why_not_searched(r)};
  std::vector<std::string> warnings;
  for (const imager::OutsideSource& s : r.sources) {
    if (warnings.size() == told) break;
    warnings.push_back("a source of " + with_prefix(s.source.flux_jy, "Jy", 3) + " outside the image, at " + place(s, r) +
                       ", may leave an alias of " + with_prefix(s.alias_jy, "Jy/beam", 2));
  }
  if (r.sources.size() > told)
    warnings.back() += "; and " + std::to_string(r.sources.size() - told) + " more, which the report lists";
  if (const std::string sentence = elsewhere_sentence(r); !sentence.empty()) warnings.push_back(sentence);
  return warnings;
}

namespace {

nlohmann::json json_of(const std::vector<imager::OutsideSource>& sources, const OutsideReport& report) {
  nlohmann::json list = nlohmann::json::array();
  for (const imager::OutsideSource& s : sources) {
    const imager::SkyDirection at = direction_of(s, report);
    list.push_back({{"ra_deg", at.ra_rad * 180 / M_PI},
                    {"dec_deg", at.dec_rad * 180 / M_PI},
                    {"l_arcsec", s.source.position.l / arcsec_rad},
                    {"m_arcsec", s.source.position.m / arcsec_rad},
                    {"flux_jy", s.source.flux_jy},
                    {"alias_jy", s.alias_jy},
                    {"at_border", s.at_border}});
  }
  return list;
}

}  // namespace

nlohmann::json outside_json(const OutsideReport* report) {
  return report == nullptr || !report->searched ? nlohmann::json() : json_of(report->sources, *report);
}

nlohmann::json outside_search_json(const OutsideReport* report) {
  if (report == nullptr || !report->searched) return nullptr;
  const std::string sentence = elsewhere_sentence(*report);
  return {{"found", report->found()},
          {"harmless", json_of(report->harmless, *report)},
          {"doubtful", report->doubtful},
          {"least_jy", report->least_jy},
          {"highest_alias_jy", report->highest_alias_jy},
          {"all_aliases_jy", report->all_aliases_jy},
          {"noise_jy", report->noise_jy},
          {"noise", noise_text(*report)},
          {"elsewhere", sentence.empty() ? nlohmann::json() : nlohmann::json(sentence)},
          {"width", report->field.width},
          {"height", report->field.height},
          {"cell_arcsec", report->field.cell_rad / arcsec_rad}};
}

}  // namespace misfit::tools
