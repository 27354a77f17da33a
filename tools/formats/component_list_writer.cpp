#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <stdexcept>

#include "imager/data/phase_shift.h"
#include "tools/base/files.h"
#include "tools/base/numbers.h"
#include "tools/formats/component_list.h"

namespace misfit::tools {
namespace {

using imager::Source;

constexpr double one_degree = M_PI / 180, one_arcsec = one_degree / 3600;

[[noreturn]] void refuse_source(const std::string& message) {
  throw std::runtime_error(message);
}

/// The shortest text that reads as `value`.
void append_number(double value, std::string& text) {
  std::array<char, 32> digits;
  const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), value);
  text.append(digits.data(), end);
}

std::string flux_column(imager::Stokes stokes) {
  if (stokes == imager::Stokes::I) return "flux_jy";
  std::string name = "flux_" + stokes_name(stokes) + "_jy";
  std::transform(name.begin(), name.end(), name.begin(), [](unsigned char letter) { return std::tolower(letter); });
  return name;
}

/// The Stokes parameters of the lists that have columns, after I.
std::vector<imager::Stokes> flux_columns(const std::vector<SourcesOf>& lists) {
  std::vector<imager::Stokes> columns{imager::Stokes::I};
  for (const SourcesOf& list : lists)
    if (list.stokes != imager::Stokes::I) columns.push_back(list.stokes);
  return columns;
}

/// The position's two values, see write_stokes_components().
std::vector<double> position_values(const imager::DirectionCosines& at,
                                    const std::optional<imager::SkyDirection>& phase_centre) {
  if (!phase_centre) return {at.l / one_arcsec, at.m / one_arcsec};
  const imager::SkyDirection direction = imager::sky_direction(at, *phase_centre);
  const double ra_deg = direction.ra_rad / one_degree;
  return {ra_deg < 360 ? ra_deg : 0, direction.dec_rad / one_degree};
}

/// The name of the frame in lists; empty where none is written.
std::string listed_name(const std::optional<imager::SkyDirection>& phase_centre) {
  for (const auto& [listed, radesys] : frames_of_lists)
    if (phase_centre && phase_centre->frame == radesys) return listed;
  return "";
}

/// Appends a line with `fluxes`, one of which is the source's own; the others are 0.
void append_line(const Source& source, const std::vector<double>& fluxes,
                 const std::optional<imager::SkyDirection>& phase_centre, std::string& text) {
  const auto& [l, m] = source.position;
  if (!(std::hypot(l, m) < 1))
    refuse_source("l " + significant(l, 9) + ", m " + significant(m, 9) + ": beyond the horizon, expected l² + m² below 1");
  if (!std::isfinite(source.flux_jy) || !std::isfinite(source.fwhm_rad) || source.fwhm_rad < 0)
    refuse_source("flux " + std::to_string(source.flux_jy) + " Jy and width " + std::to_string(source.fwhm_rad) +
                  " rad, expected finite numbers, and a width of 0 or more");
  std::vector<double> values = position_values(source.position, phase_centre);
  values.insert(values.end(), fluxes.begin(), fluxes.end());
  values.push_back(source.fwhm_rad / one_arcsec);
  for (const double value : values) {
    append_number(value, text);
    text += ',';
  }
  const std::string frame = listed_name(phase_centre);
  text += frame;
  if (frame.empty()) text.pop_back();
  text += '\n';
}

}  // namespace

void write_component_list(const std::string& path, const std::vector<Source>& sources,
                          const imager::SkyDirection& phase_centre) {
  write_stokes_components(path, {{imager::Stokes::I, sources}}, phase_centre);
}

void write_stokes_components(const std::string& path, const std::vector<SourcesOf>& lists,
                             const std::optional<imager::SkyDirection>& phase_centre) {
  const std::vector<imager::Stokes> columns = flux_columns(lists);
  std::string text = phase_centre ? "ra_deg,dec_deg" : "l_arcsec,m_arcsec";
  for (const imager::Stokes column : columns) text += "," + flux_column(column);
  text += std::string(",scale_arcsec") + (listed_name(phase_centre).empty() ? "\n" : ",frame\n");
  int line = 1;
  for (const SourcesOf& list : lists)
    for (const Source& source : list.sources) try {
        ++line;
        std::vector<double> fluxes;
        for (const imager::Stokes column : columns) fluxes.push_back(column == list.stokes ? source.flux_jy : 0);
        append_line(source, fluxes, phase_centre, text);
      } catch (const std::runtime_error& error) {
        refuse_source(path + ", line " + std::to_string(line) + ": " + error.what());
      }
  write_file(path, text);
}

}  // namespace misfit::tools
