#include "imager/pointing/seen_image.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "imager/beams/radial_function.h"
#include "imager/numerics/constants.h"
#include "imager/numerics/parallel.h"

namespace misfit::imager {
namespace {

/// sin θ of the pixel that is farthest from where antennas of any field point.
double farthest_sine(const ImageGeometry& geometry, const std::vector<AxisFrame>& frames) {
  double farthest = 0;
  for (const AxisFrame& frame : frames)
    for (const DirectionCosines corner : geometry.corners()) {
      const double sine = frame.sine(corner);
      farthest = sine <= 1 ? std::max(farthest, sine) : 1;  // beyond a horizon there is none
    }
  return farthest;
}

/// About as many bytes as a prediction of an image holds: a padded grid, or the image itself.
std::size_t prediction_bytes(const Image& model) {
  return std::max<std::size_t>(1, 32 * model.pixel.size());
}

/// True where a table of a round beam is as good as the beam itself over an image that reaches so far from the axis, and
/// quicker.
bool takes_table(const PairBeam& beam, const Image& model, double reach, double frequency_hz) {
  constexpr double points_of_detail = 60, points = 1024;
  constexpr std::ptrdiff_t many = 1 << 14;
  const double detail = std::min(beam.one->detail_sine(frequency_hz), beam.other->detail_sine(frequency_hz));
  const double ends = std::min(beam.one->continuous_sine(frequency_hz), beam.other->continuous_sine(frequency_hz));
  if (!beam.is_round() || ends < reach || reach / points > detail / points_of_detail) return false;
  return std::count_if(model.pixel.begin(), model.pixel.end(), [](double value) { return value != 0; }) > many;
}

}  // namespace

Image seen_by(const PairBeam& beam, const Image& model, const ImageGeometry& geometry, double frequency_hz, int threads) {
  Image seen(model.width, model.height);
  const double reach = farthest_sine(geometry, {beam.frame});
  std::optional<RadialTable> table;
  if (takes_table(beam, model, reach, frequency_hz))
    table.emplace(reach, threads,
                  [&](double sine) { return beam.one->voltage(sine, frequency_hz) * beam.other->voltage(sine, frequency_hz); });
  const auto power = [&](DirectionCosines at) {
    const double sine = table ? beam.frame.sine(at) : 2;
    return sine <= reach ? (*table)(sine) : beam.power(at, frequency_hz);
  };
  parallel_for(static_cast<std::size_t>(model.height), threads, [&](std::size_t r) {
    const int row = static_cast<int>(r);
    for (int column = 0; column < model.width; ++column)
      if (model.at(row, column) != 0) seen.at(row, column) = model.at(row, column) * power(geometry.at(row, column));
  });
  return seen;
}

SeenImage::SeenImage(const Transform& transform, const Image& model, const ImageGeometry& geometry, const RowBeams& beams,
                     const std::vector<double>& frequency_hz, const SeenImageOptions& options)
    : transform_(transform),
      model_(model),
      geometry_(geometry),
      beams_(beams),
      options_(options),
      steps_(beam_steps(beams, farthest_sine(geometry, beams.of_fields()), frequency_hz, options.tolerance)),
      most_kept_(std::max<std::size_t>(1, options.bytes / prediction_bytes(model))),
      samples_at_once_(transform.predict(model)->samples_at_once()) {}

const Prediction& SeenImage::prediction(const RowBeams::Group& group, double frequency_hz) {
  const PairBeam& beam = group.beam;
  const Key key{beam.one.get(), beam.other.get(), group.field, beam.zenith_rad, frequency_hz};
  const auto found = std::find_if(kept_.begin(), kept_.end(), [&](const Kept& kept) { return kept.key == key; });
  if (found != kept_.end()) {
    kept_.splice(kept_.begin(), kept_, found);
  } else {
    if (kept_.size() >= most_kept_) kept_.pop_back();
    kept_.push_front({key, transform_.predict(seen_by(beam, model_, geometry_, frequency_hz, options_.threads))});
  }
  return *kept_.front().prediction;
}

bool SeenImage::shines_at_steps(const RowBeams::Group& group, const FrequencySpan& span) {
  const PairBeam& beam = group.beam;
  const auto [known, is_new] =
      shines_at_steps_.insert({{beam.one.get(), beam.other.get(), group.field, beam.zenith_rad, span.low_hz}, false});
  if (!is_new) return known->second;
  const std::array<double, 4> hz{span.low_hz, span.node_hz.front(), span.node_hz.back(), span.high_hz};
  double within = 1;
  for (const double at : hz) within = std::min({within, beam.one->continuous_sine(at), beam.other->continuous_sine(at)});
  if (within == 1) return false;
  std::vector<char> shines(static_cast<std::size_t>(model_.height));
  parallel_for(shines.size(), options_.threads, [&](std::size_t r) {
    const int row = static_cast<int>(r);
    for (int column = 0; column < model_.width && shines[r] == 0; ++column) {
      const DirectionCosines at = geometry_.at(row, column);
      if (model_.at(row, column) == 0 || !(beam.frame.sine(at) > within)) continue;
      shines[r] = std::any_of(hz.begin(), hz.end(), [&](double f) { return beam.power(at, f) != 0; }) ? 1 : 0;
    }
  });
  return known->second = std::count(shines.begin(), shines.end(), 1) > 0;
}

void SeenImage::add(const RowBeams::Group& group, const FrequencySpan& span, const SampleCoordinates& at,
                    std::vector<std::complex<double>>& visibilities) {
  std::vector<std::size_t> channels;
  for (std::size_t c = 0; c < at.channels(); ++c)
    if (span.holds(at.frequency_hz[c])) channels.push_back(c);
  if (channels.empty()) return;
  const SampleCoordinates rows = rows_of(at, group.rows);
  const auto add_of = [&](double hz, const std::vector<std::size_t>& of_channels, const auto& weight) {
    SampleCoordinates here{rows.uvw_m, {}};
    for (const std::size_t c : of_channels) here.frequency_hz.push_back(at.frequency_hz[c]);
    const std::vector<std::complex<double>> seen = prediction(group, hz).at(here);
    for (std::size_t r = 0; r < group.rows.size(); ++r)
      for (std::size_t c = 0; c < of_channels.size(); ++c)
        visibilities[group.rows[r] * at.channels() + of_channels[c]] += weight(c) * seen[r * of_channels.size() + c];
  };
  if (span.is_exact() || shines_at_steps(group, span)) {
    for (const std::size_t c : channels) add_of(at.frequency_hz[c], {c}, [](std::size_t) { return 1.0; });
    return;
  }
  std::vector<std::vector<double>> weight;  // [channel][node]
  for (const std::size_t c : channels) weight.push_back(span.weights(at.frequency_hz[c]));
  for (std::size_t k = 0; k < span.node_hz.size(); ++k)
    add_of(span.node_hz[k], channels, [&](std::size_t c) { return weight[c][k]; });
}

std::vector<std::complex<double>> SeenImage::at(const SampleCoordinates& coordinates) {
  for (const double hz : coordinates.frequency_hz)
    if (std::none_of(steps_.spans.begin(), steps_.spans.end(), [hz](const FrequencySpan& span) { return span.holds(hz); }))
      throw std::invalid_argument("an image seen at " + std::to_string(hz) +
                                  " Hz; expected one of the frequencies it was made for");
  std::vector<std::complex<double>> visibilities(coordinates.samples());
  for (const RowBeams::Group& group : beams_.groups(coordinates, steps_.turn_rad))
    for (const FrequencySpan& span : steps_.spans) add(group, span, coordinates, visibilities);
  return visibilities;
}

}  // namespace misfit::imager
