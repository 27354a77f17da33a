#pragma once

#include <complex>
#include <list>
#include <memory>
#include <tuple>
#include <vector>

#include "imager/beams/frequency_nodes.h"
#include "imager/beams/row_beams.h"
#include "imager/transform/transform.h"

namespace misfit::imager {

struct SeenImageOptions {
  double tolerance = 1e-7;  ///< to which beams between frequencies follow, over their peak
  double turn_rad = 0;      ///< beams that are not round are turned by steps of this; 0: for each zenith anew
  int threads = 1;
};

/// The model image times B(l, m) in each pixel.
Image seen_by(const PairBeam& beam, const Image& model, const ImageGeometry& geometry, double frequency_hz, int threads);

/// The forward transform of a model image that dishes see through their beams, V = A (B · I) with the beam B of each row and
/// channel. Beams are made at a few frequencies, from which all others follow. By one thread at a time.
class SeenImage {
 public:
  /// To be asked for these frequencies. The transform, the model and the beams are kept by reference.
  SeenImage(const Transform& transform, const Image& model, const ImageGeometry& geometry, const RowBeams& beams,
            const std::vector<double>& frequency_hz, const SeenImageOptions& options);

  /// [row][channel], in Jy; the coordinates have the sights of their rows.
  std::vector<std::complex<double>> at(const SampleCoordinates& coordinates);
  /// See Prediction.
  std::size_t samples_at_once() const { return samples_at_once_; }

 private:
  using Key = std::tuple<const VoltagePattern*, const VoltagePattern*, int, double, double>;
  struct Kept {
    Key key;
    std::unique_ptr<Prediction> prediction;
  };

  /// Of the model that a group sees at a frequency.
  const Prediction& prediction(const RowBeams::Group& group, double frequency_hz);
  void add(const RowBeams::Group& group, const FrequencySpan& span, const SampleCoordinates& at,
           std::vector<std::complex<double>>& visibilities);

  const Transform& transform_;
  const Image& model_;
  const ImageGeometry geometry_;
  const RowBeams& beams_;
  const SeenImageOptions options_;
  std::vector<FrequencySpan> spans_;
  std::list<Kept> kept_;  ///< the one used last comes first
  std::size_t samples_at_once_;
};

}  // namespace misfit::imager
