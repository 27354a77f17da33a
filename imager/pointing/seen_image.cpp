#include "imager/pointing/seen_image.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "imager/beams/radial_function.h"
#include "imager/numerics/constants.h"
#include "imager/numerics/parallel.h"

namespace misfit::imager {
namespace {

constexpr std::size_t most_kept = 24;  ///< predictions, each as large as a padded image

/// sin θ of the pixel that is farthest from the phase centre.
double farthest_sine(const ImageGeometry& geometry) {
  double farthest = 0;
  for (const DirectionCosines corner : geometry.corners()) farthest = std::max(farthest, std::hypot(corner.l, corner.m));
  return std::min(farthest, 1.0);
}

/// Voltages of all patterns, and their squares, at radii and angles.
ValuesAtFrequency sampled_patterns(const RowBeams& beams, double reach) {
  constexpr int radii = 96, angles = 8;
  std::set<const VoltagePattern*> different;
  for (const Pattern& pattern : beams.of_antenna()) different.insert(pattern.get());
  return [different, reach](double hz) {
    std::vector<double> values;
    for (const VoltagePattern* pattern : different)
      for (int r = 1; r <= radii; ++r)
        for (int a = 0; a < (pattern->is_round() ? 1 : angles); ++a) {
          const double sine = reach * r / radii, angle_rad = 2 * pi * a / angles;
          const double seen = pattern->is_round() ? pattern->voltage(sine, hz) : pattern->voltage_at(sine, angle_rad, hz);
          values.push_back(seen);
          values.push_back(seen * seen);
        }
    return values;
  };
}

/// Whether a table of a round beam is as good as the beam itself over an image that reaches so far from the axis, and quicker.
bool takes_table(const PairBeam& beam, const Image& model, double reach, double frequency_hz) {
  constexpr double points_of_detail = 60, points = 1024;
  constexpr std::ptrdiff_t many = 1 << 14;
  const double detail = std::min(beam.one->detail_sine(frequency_hz), beam.other->detail_sine(frequency_hz));
  if (!beam.is_round() || reach / points > detail / points_of_detail) return false;
  return std::count_if(model.pixel.begin(), model.pixel.end(), [](double value) { return value != 0; }) > many;
}

}  // namespace

Image seen_by(const PairBeam& beam, const Image& model, const ImageGeometry& geometry, double frequency_hz, int threads) {
  Image seen(model.width, model.height);
  double reach = 0;
  for (const DirectionCosines corner : geometry.corners()) reach = std::max(reach, beam.frame.sine(corner));
  const bool by_table = reach <= 1 && takes_table(beam, model, reach, frequency_hz);
  const RadialTable table(by_table ? reach : 1, by_table ? threads : 1, [&](double sine) {
    return by_table ? beam.one->voltage(sine, frequency_hz) * beam.other->voltage(sine, frequency_hz) : 0;
  });
  parallel_for(static_cast<std::size_t>(model.height), threads, [&](std::size_t r) {
    const int row = static_cast<int>(r);
    for (int column = 0; column < model.width; ++column) {
      const double value = model.at(row, column);
      if (value == 0) continue;
      const DirectionCosines at = geometry.at(row, column);
      seen.at(row, column) = value * (by_table ? table(beam.frame.sine(at)) : beam.power(at, frequency_hz));
    }
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
      spans_(frequency_spans(frequency_hz, sampled_patterns(beams, farthest_sine(geometry)), options.tolerance)),
      samples_at_once_(transform.predict(model)->samples_at_once()) {}

const Prediction& SeenImage::prediction(const RowBeams::Group& group, double frequency_hz) {
  const PairBeam& beam = group.beam;
  const Key key{beam.one.get(), beam.other.get(), group.field, beam.zenith_rad, frequency_hz};
  const auto found = std::find_if(kept_.begin(), kept_.end(), [&](const Kept& kept) { return kept.key == key; });
  if (found != kept_.end()) {
    kept_.splice(kept_.begin(), kept_, found);
  } else {
    if (kept_.size() == most_kept) kept_.pop_back();
    kept_.push_front({key, transform_.predict(seen_by(beam, model_, geometry_, frequency_hz, options_.threads))});
  }
  return *kept_.front().prediction;
}

void SeenImage::add(const RowBeams::Group& group, const FrequencySpan& span, const SampleCoordinates& at,
                    std::vector<std::complex<double>>& visibilities) {
  std::vector<std::size_t> channels;
  SampleCoordinates here = rows_of(at, group.rows);
  here.frequency_hz.clear();
  for (std::size_t c = 0; c < at.channels(); ++c)
    if (span.holds(at.frequency_hz[c])) {
      channels.push_back(c);
      here.frequency_hz.push_back(at.frequency_hz[c]);
    }
  if (channels.empty()) return;
  std::vector<std::vector<double>> weight;  // [channel][node]
  for (const double hz : here.frequency_hz) weight.push_back(span.weights(hz));
  for (std::size_t k = 0; k < span.node_hz.size(); ++k) {
    const std::vector<std::complex<double>> of_node = prediction(group, span.node_hz[k]).at(here);
    for (std::size_t r = 0; r < group.rows.size(); ++r)
      for (std::size_t c = 0; c < channels.size(); ++c)
        visibilities[group.rows[r] * at.channels() + channels[c]] += weight[c][k] * of_node[r * channels.size() + c];
  }
}

std::vector<std::complex<double>> SeenImage::at(const SampleCoordinates& coordinates) {
  std::vector<std::complex<double>> visibilities(coordinates.samples());
  for (const RowBeams::Group& group : beams_.groups(coordinates.sights, options_.turn_rad))
    for (const FrequencySpan& span : spans_) add(group, span, coordinates, visibilities);
  return visibilities;
}

}  // namespace misfit::imager
