#include "imager/pointing/mosaic_windows.h"

#include <cmath>
#include <utility>

#include "imager/data/phase.h"
#include "imager/transform/unit_source.h"
#include "imager/wide/facet.h"

namespace misfit::imager {

SampleShares CurvedSamples::shares(std::size_t first, std::size_t count) const {
  SampleShares shares{{}, first, count, terms->steps_a_wavelength(), phase.data()};
  for (const double hz : at.frequency_hz) shares.of_channel.push_back(&terms->shares(hz));
  return shares;
}

std::shared_ptr<const Transform> MosaicWindows::transform(const Window& window, std::size_t term) const {
  const ImageGeometry& of = window.geometry;
  const auto key = std::tuple(term, of.width, of.height, window.first_row, window.first_column);
  {
    const std::lock_guard lock(mutex_);
    const auto found = made_.find(key);
    if (found != made_.end()) return found->second;
  }
  std::shared_ptr<const Transform> made = std::get<0>(transforms_)[term](of);
  const std::lock_guard lock(mutex_);
  return made_.try_emplace(key, std::move(made)).first->second;
}

std::shared_ptr<const SharedTransform> MosaicWindows::curved_transform(const Window& window) const {
  ImageGeometry of = window.geometry;
  of.centre = {};
  const std::lock_guard lock(mutex_);
  std::shared_ptr<const SharedTransform>& made = curved_[{of.width, of.height}];
  if (!made) made = std::get<1>(transforms_).make(of);
  return made;
}

std::shared_ptr<const SeenWindow> MosaicWindows::seen(const RowBeams::Group& group) const {
  const std::lock_guard lock(mutex_);
  const PairBeam& beam = group.beam;
  const auto [place, is_new] = seen_.insert({{beam.one.get(), beam.other.get(), group.field, beam.zenith_rad}, nullptr});
  if (!is_new) return place->second;
  const std::optional<Window> window = beams_->window(beam);
  if (!window) return nullptr;
  if (split_into_facets(window->geometry, 1, 1).front().empty) return nullptr;
  return place->second = std::make_shared<const SeenWindow>(SeenWindow{beam, *window});
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

CurvedSamples MosaicWindows::curved_samples(const SeenWindow& seen, const BeamSpan& span, const SampleCoordinates& at,
                                            std::vector<float> weight) const {
  const CurvedTerms& terms = beams_->curved(span);
  const DirectionCosines axis = seen.beam.frame.axis(), middle = seen.window.geometry.centre;
  const double n = 1 + n_minus_1(axis);
  // With n = (cos θ − l l_0 − m m_0)/n_0 and cos θ = q + 1 − terms.middle(), this is what w counts by where q = 0.
  const double by_w = -(n_minus_1(axis) + terms.middle() + axis.l * middle.l + axis.m * middle.m) / n;
  CurvedSamples samples{&terms, {}, unit_source(at, {middle.l, middle.m, by_w}, options_.threads_of_each())};
  samples.at.frequency_hz = at.frequency_hz;
  samples.at.weight = std::move(weight);
  std::vector<double>& uvw_m = samples.at.uvw_m.edit();
  uvw_m.resize(at.uvw_m.size());
  for (std::size_t r = 0; r < at.rows(); ++r) {
    const double* const from = &at.uvw_m[3 * r];
    const double w = from[2] / n;
    uvw_m[3 * r] = from[0] - w * axis.l;
    uvw_m[3 * r + 1] = from[1] - w * axis.m;
    uvw_m[3 * r + 2] = w;
  }
  return samples;
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
