#include "imager/pointing/seen_sources.h"

#include "imager/direct/source_sums.h"

namespace misfit::imager {

std::vector<std::complex<double>> predict_seen_sources(const std::vector<Source>& sources, const RowBeams& beams,
                                                       const SampleCoordinates& at, int threads) {
  const std::size_t channels = at.channels();
  std::vector<std::complex<double>> visibilities(at.samples());
  for (const RowBeams::Group& group : beams.groups(at)) {
    SampleCoordinates here = rows_of(at, group.rows);
    for (std::size_t c = 0; c < channels; ++c) {
      here.frequency_hz = {at.frequency_hz[c]};
      const auto of_channel = predict_sources(seen_by(group.beam, sources, at.frequency_hz[c]), here, threads);
      for (std::size_t r = 0; r < group.rows.size(); ++r) visibilities[group.rows[r] * channels + c] = of_channel[r];
    }
  }
  return visibilities;
}

}  // namespace misfit::imager
