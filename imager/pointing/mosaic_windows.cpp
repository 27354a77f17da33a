#include "imager/pointing/mosaic_windows.h"

#include <utility>

#include "imager/transform/unit_source.h"

namespace misfit::imager {

std::shared_ptr<const Transform> MosaicWindows::transform(const Window& window, std::size_t term) const {
  const TermTransforms& transforms = of_term_[term];
  ImageGeometry of = window.geometry;
  const auto place = transforms.on_planes ? std::pair(0, 0) : std::pair(window.first_row, window.first_column);
  if (transforms.on_planes) of.centre = {};
  const auto key = std::tuple(term, of.width, of.height, place.first, place.second);
  {
    const std::lock_guard lock(mutex_);
    const auto found = made_.find(key);
    if (found != made_.end()) return found->second;
  }
  std::shared_ptr<const Transform> made = transforms.make(of);
  const std::lock_guard lock(mutex_);
  return made_.try_emplace(key, std::move(made)).first->second;
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
  return place->second = std::make_shared<const SeenWindow>(SeenWindow{beam, *window, plane});
}

WindowSamples MosaicWindows::samples(const SampleCoordinates& block, const std::vector<std::size_t>& rows,
                                     const BeamSpan& span) const {
  WindowSamples s{rows, {}, {}, {}};
  for (std::size_t c = 0; c < block.channels(); ++c) {
    const double hz = block.frequency_hz[c];
    if (!span.holds(hz)) continue;
    s.channels.push_back(c);
    s.share.push_back(span.shares(hz));
    s.at.frequency_hz.push_back(hz);
  }
  s.at.uvw_m = rows_of(block, rows).uvw_m;
  return s;
}

SamplesOnPlane MosaicWindows::on_plane(const SeenWindow& seen, const SampleCoordinates& at) const {
  std::vector<double> uvw_m(at.uvw_m.size());
  for (std::size_t r = 0; r < at.rows(); ++r) {
    const double* const from = &at.uvw_m[3 * r];
    uvw_m[3 * r] = from[0] + seen.plane.slope_l * from[2];
    uvw_m[3 * r + 1] = from[1] + seen.plane.slope_m * from[2];
  }
  const DirectionCosines middle = seen.plane.geometry.centre;
  return {{std::move(uvw_m), at.frequency_hz},
          unit_source(at, {middle.l, middle.m, seen.plane.middle}, options_.threads_of_each())};
}

bool MosaicWindows::sees_psf(const SeenWindow& seen) const {
  return seen.beam.frame.sine(psf_direction()) <= beams_->reach(seen.beam);
}

std::vector<std::complex<double>> MosaicWindows::psf_source(const SeenWindow& seen, const BeamSpan& span,
                                                            const WindowSamples& samples) const {
  if (!sees_psf(seen)) return std::vector<std::complex<double>>(samples.size());
  const std::vector<double> terms = beams_->terms(seen.beam, psf_direction(), span);
  std::vector<double> power;  // [channel]
  for (const std::vector<double>& share : samples.share) {
    double sum = 0;
    for (std::size_t k = 0; k < terms.size(); ++k) sum += share[k] * terms[k];
    power.push_back(sum);
  }
  std::vector<std::complex<double>> source =
      unit_source(samples.at, phase_position(psf_direction()), options_.threads_of_each());
  for (std::size_t i = 0; i < source.size(); ++i) source[i] *= power[i % power.size()];
  return source;
}

}  // namespace misfit::imager
