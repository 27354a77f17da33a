#include "tools/run/dish_beams.h"

#include <algorithm>
#include <filesystem>

#include "tools/base/option_checks.h"
#include "tools/formats/beam_file.h"

namespace misfit::tools {
namespace {

constexpr char voltage_prefix[] = "voltage:";

bool is_voltage(const std::string& beam) {
  return beam.rfind(voltage_prefix, 0) == 0;
}

/// The file that --beam names; empty where it names none.
std::string beam_path(const std::string& beam) {
  if (beam.empty() || imager::is_beam_name(beam)) return "";
  return is_voltage(beam) ? beam.substr(sizeof voltage_prefix - 1) : beam;
}

}  // namespace

DishBeams::DishBeams(const std::string& beam) : beam_(beam) {
  const std::string path = beam_path(beam);
  if (path.empty()) return;
  of_file_ = read_beam_file(path, is_voltage(beam) ? BeamPixels::voltage : BeamPixels::power);
}

imager::BeamModel DishBeams::of(const imager::AntennaSort& antennas) const {
  if (of_file_) return {of_file_, "--beam " + beam_};
  return beam_.empty() ? imager::beam_model(antennas) : imager::named_beam(beam_, antennas);
}

std::vector<imager::Pattern> patterns_of(const std::vector<imager::AntennaSort>& antennas, const WantedPatterns& wanted,
                                         std::vector<std::string>& doubts) {
  std::vector<imager::BeamModel> models;
  for (const imager::AntennaSort& sort : wanted.sorts) {
    models.push_back(wanted.beams.of(sort));
    const std::string doubt = models.back().doubt_at(wanted.frequency_hz);
    if (!doubt.empty() && std::find(doubts.begin(), doubts.end(), doubt) == doubts.end()) doubts.push_back(doubt);
  }
  std::vector<imager::Pattern> patterns;
  for (const imager::AntennaSort& antenna : antennas) {
    const auto sort = std::find_if(wanted.sorts.begin(), wanted.sorts.end(),
                                   [&](const imager::AntennaSort& one) { return imager::alike(one, antenna); });
    if (sort != wanted.sorts.end()) {
      patterns.push_back(models[static_cast<std::size_t>(sort - wanted.sorts.begin())].pattern);
      continue;
    }
    try {
      patterns.push_back(wanted.beams.of(antenna).pattern);
    } catch (const imager::NoSimpleBeam&) {
      patterns.push_back(nullptr);
    }
  }
  return patterns;
}

double narrowest_rad(const std::vector<imager::Pattern>& patterns, double frequency_hz) {
  double narrowest = 1;
  for (const imager::Pattern& pattern : patterns)
    if (pattern) narrowest = std::min(narrowest, pattern->detail_sine(frequency_hz));
  return narrowest;
}

void check_beam(const std::string& beam) {
  const std::string path = beam_path(beam);
  if (path.empty() || std::filesystem::is_regular_file(path)) return;
  refuse_option("beam", "'" + beam + "'",
                imager::expected_beam_names() + "; or a FITS file, or voltage:FILE, and there is no file " + path);
}

}  // namespace misfit::tools
