// Lists of components, as predict --components and simulate --sky read them.
#include <cmath>

#include "tests/fuzz/fuzzing.h"
#include "tools/formats/component_list.h"

using namespace misfit;
using namespace misfit::fuzz;

namespace {

using Sources = std::vector<imager::Source>;

void require_promises(const Sources& sources) {
  for (const imager::Source& s : sources) {
    require(std::hypot(s.position.l, s.position.m) <= 1, "sources lie above the horizon");
    require(std::isfinite(s.flux_jy) && std::isfinite(s.fwhm_rad) && s.fwhm_rad >= 0, "sources have fluxes and widths");
    require(std::isfinite(s.spectral_index) && std::isfinite(s.reference_hz), "sources have spectra");
  }
}

/// What can be written, too, comes back.
void require_written_again(const InputFile& file, const Sources& sources, const imager::SkyDirection& centre) {
  const std::string again = (file.folder() / "again.csv").string();
  if (!read_or_refused(again, [&] { return tools::write_component_list(again, sources, centre), true; })) return;
  const auto reread = read_or_refused(again, [&] { return tools::read_component_list(again, centre); });
  if (!reread) return;  // a source at the horizon itself, rounded to beyond
  require(reread->size() == sources.size(), "a list that was written has as many sources");
  for (std::size_t i = 0; i < sources.size(); ++i)
    require((*reread)[i].flux_jy == sources[i].flux_jy, "a list that was written has the same fluxes");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const InputFile file(data, size, "sky.csv");
  const imager::SkyDirection centre{0.2, 0.7, "FK5"};
  const auto sources = read_or_refused(file.path(), [&] { return tools::read_component_list(file.path(), centre); });
  const auto polarised = read_or_refused(file.path(), [&] { return tools::read_stokes_components(file.path(), centre); });
  require(!sources || polarised, "a list of Stokes I is a list of Stokes parameters");
  if (polarised)
    for (const Sources& each : *polarised) require_promises(each);
  if (!sources) return 0;
  require_promises(*sources);
  require_written_again(file, *sources, centre);
  return 0;
}
