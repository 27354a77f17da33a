#include "imager/pointing/mosaic_windows.h"

#include <algorithm>
#include <utility>

#include "imager/transform/unit_source.h"

namespace misfit::imager {

std::shared_ptr<const Transform> MosaicWindows::transform_of(const Window& window) const {
  const ImageGeometry& g = window.geometry;
  const auto place = transforms_.on_planes ? std::pair(0, 0) : std::pair(window.first_row, window.first_column);
  std::shared_ptr<const Transform>& made = made_[{g.width, g.height, place.first, place.second}];
  if (made) return made;
  ImageGeometry of = g;
  if (transforms_.on_planes) of.centre = {};
  return made = transforms_.make(of);
}

std::shared_ptr<const SeenWindow> MosaicWindows::seen(const RowBeams::Group& group) const {
  const std::lock_guard lock(mutex_);
  const PairBeam& beam = group.beam;
  const auto [place, is_new] = seen_.insert({{beam.one.get(), beam.other.get(), group.field, beam.zenith_rad}, nullptr});
  if (!is_new) return place->second;
  const std::optional<Window> window = beams_->window(beam);
  if (!window) return nullptr;
  const Facet plane = split_into_facets(window->geometry, 1, 1).front();
  if (plane.empty) return nullptr;
  return place->second = std::make_shared<const SeenWindow>(SeenWindow{beam, *window, plane, transform_of(*window)});
}

std::vector<std::complex<double>> MosaicWindows::unit_source_of(const SampleCoordinates& block, const WindowSamples& samples,
                                                                const PhasePosition& source) const {
  return unit_source({rows_of(block, samples.rows).uvw_m, samples.at.frequency_hz}, source, options_.threads);
}

std::vector<std::complex<double>> MosaicWindows::psf_source(const SeenWindow& seen, const FrequencySpan& span,
                                                            const WindowSamples& samples,
                                                            const SampleCoordinates& block) const {
  const DirectionCosines at = beams_->geometry().at(options_.psf_row, options_.psf_column);
  std::vector<double> power;  // [channel]
  for (const std::vector<double>& share : samples.share) {
    double sum = 0;
    for (std::size_t k = 0; k < share.size(); ++k) sum += share[k] * beams_->power(seen.beam, at, span.node_hz[k]);
    power.push_back(sum);
  }
  if (std::all_of(power.begin(), power.end(), [](double value) { return value == 0; }))
    return std::vector<std::complex<double>>(samples.size());
  std::vector<std::complex<double>> source = unit_source_of(block, samples, phase_position(at));
  for (std::size_t i = 0; i < source.size(); ++i) source[i] *= power[i % power.size()];
  return source;
}

WindowSamples MosaicWindows::samples(const SeenWindow& seen, const SampleCoordinates& block,
                                     const std::vector<std::size_t>& rows, const FrequencySpan& span) const {
  WindowSamples s{rows, {}, {}, {}, {}};
  for (std::size_t c = 0; c < block.channels(); ++c) {
    if (!span.holds(block.frequency_hz[c])) continue;
    s.channels.push_back(c);
    s.share.push_back(span.weights(block.frequency_hz[c]));
    s.at.frequency_hz.push_back(block.frequency_hz[c]);
  }
  if (!transforms_.on_planes) {
    s.at.uvw_m = rows_of(block, rows).uvw_m;
    return s;
  }
  std::vector<double> uvw_m(3 * rows.size());
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const double* const from = &block.uvw_m[3 * rows[r]];
    uvw_m[3 * r] = from[0] + seen.plane.slope_l * from[2];
    uvw_m[3 * r + 1] = from[1] + seen.plane.slope_m * from[2];
  }
  s.at.uvw_m = std::move(uvw_m);
  const DirectionCosines middle = seen.plane.geometry.centre;
  s.phase = unit_source_of(block, s, {middle.l, middle.m, seen.plane.middle});
  return s;
}

}  // namespace misfit::imager
