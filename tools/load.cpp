#include "tools/load.h"

#include <stdexcept>

#include "imager/stored_visibilities.h"
#include "tools/memory.h"
#include "tools/numbers.h"

namespace misfit::tools {
namespace {

/// Of a block in memory: a visibility and a weight per sample, UVW per row.
double bytes_of(const ms_io::MeasurementSet& set) {
  return static_cast<double>(set.samples()) * (sizeof(std::complex<float>) + sizeof(float)) +
         static_cast<double>(set.rows()) * 3 * sizeof(double);
}

void require_usable(const imager::SampleCounts& c) {
  if (c.used > 0) return;
  const auto count = [](std::uint64_t n) { return std::to_string(n); };
  throw std::runtime_error("no visibility is left of " + count(c.samples_read) + ": " + count(c.autocorrelations) +
                           " auto-correlations, " + count(c.flagged) + " flagged, " + count(c.nonfinite) + " not finite, " +
                           count(c.zero_weight) + " of zero weight");
}

}  // namespace

LoadedVisibilities load_visibilities(const ms_io::MeasurementSet& set, const imager::Progress& progress,
                                     imager::StageTimes& times) {
  const double bytes = bytes_of(set);
  const bool keep = bytes < physical_memory_bytes() / 2;
  LoadedVisibilities loaded;
  auto memory = std::make_unique<imager::StoredVisibilities>();
  std::uint64_t done = 0;
  const auto stream = set.open();
  const imager::StageTimer timer(times, "read");
  while (const auto block = stream->next()) {
    loaded.counts += block->counts;
    loaded.w_spread.add(*block);
    done += block->samples();
    if (keep && block->counts.used > 0) memory->append(block);
    progress(done, set.samples());
  }
  require_usable(loaded.counts);
  loaded.decisions = {{"visibilities", keep ? "kept in memory" : "read again in every pass",
                       significant(bytes / gib, 2) + " GiB against half of the machine's " +
                           significant(physical_memory_bytes() / gib, 3) + " GiB"},
                      {"columns and correlations", "only what Stokes I needs",
                       "UVW, antennas, flags, weights and one data column, each read once"}};
  if (keep) loaded.memory = std::move(memory);
  loaded.source = keep ? loaded.memory.get() : static_cast<const imager::VisibilitySource*>(&set);
  return loaded;
}

}  // namespace misfit::tools
