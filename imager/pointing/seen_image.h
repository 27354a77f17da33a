#pragma once

#include <complex>
#include <list>
#include <map>
#include <memory>
#include <tuple>
#include <vector>

#include "imager/beams/row_beams.h"
#include "imager/pointing/beam_steps.h"
#include "imager/transform/transform.h"

namespace misfit::imager {

struct SeenImageOptions {
  /// Over the beam's peak: to which beams follow between frequencies, and four times of which they may be turned wrongly.
  double tolerance = 1e-7;
  std::size_t bytes = std::size_t{1} << 32;  ///< that kept predictions may take, about; one is kept in any case
  int threads = 1;
};

/// The model image times B(l, m) in each pixel.
Image seen_by(const PairBeam& beam, const Image& model, const ImageGeometry& geometry, double frequency_hz, int threads);

/// The forward transform of a model image that dishes see through their beams, V = A (B · I) with the beam B of each row and
/// channel. Beams are made at a few frequencies and turns, from which all others follow; but at each channel where the model
/// shines where a formula's beam ends in a step. By one thread at a time.
class SeenImage {
 public:
  /// To be asked for these frequencies. The transform, the model and the beams are kept by reference.
  SeenImage(const Transform& transform, const Image& model, const ImageGeometry& geometry, const RowBeams& beams,
            const std::vector<double>& frequency_hz, const SeenImageOptions& options);

  /// [row][channel], in Jy; the coordinates have the sights of their rows. Throws std::invalid_argument where they have not,
  /// or another frequency.
  std::vector<std::complex<double>> at(const SampleCoordinates& coordinates);
  /// See Prediction.
  std::size_t samples_at_once() const { return samples_at_once_; }

 private:
  /// The pair, field, zenith and frequency, or lowest frequency of a span.
  using Key = std::tuple<const VoltagePattern*, const VoltagePattern*, int, double, double>;
  struct Kept {
    Key key;
    std::unique_ptr<Prediction> prediction;
  };

  /// The prediction of the model as a group sees it at a frequency.
  const Prediction& prediction(const RowBeams::Group& group, double frequency_hz);
  /// Whether the model shines where the beam of a group ends in a step at some frequency of a span.
  bool shines_at_steps(const RowBeams::Group& group, const FrequencySpan& span);
  void add(const RowBeams::Group& group, const FrequencySpan& span, const SampleCoordinates& at,
           std::vector<std::complex<double>>& visibilities);

  const Transform& transform_;
  const Image& model_;
  const ImageGeometry geometry_;
  const RowBeams& beams_;
  const SeenImageOptions options_;
  BeamSteps steps_;
  std::map<Key, bool> shines_at_steps_;
  std::size_t most_kept_;
  std::list<Kept> kept_;  ///< the one used last comes first
  std::size_t samples_at_once_;
};

}  // namespace misfit::imager
