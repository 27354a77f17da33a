#include "tools/run/dish_beams.h"

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

void check_beam(const std::string& beam) {
  const std::string path = beam_path(beam);
  if (path.empty() || std::filesystem::is_regular_file(path)) return;
  refuse_option("beam", "'" + beam + "'",
                imager::expected_beam_names() + "; or a FITS file, or voltage:FILE, and there is no file " + path);
}

}  // namespace misfit::tools
