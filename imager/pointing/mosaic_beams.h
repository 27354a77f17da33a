#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <tuple>
#include <vector>

#include "imager/beams/radial_function.h"
#include "imager/beams/row_beams.h"
#include "imager/data/image.h"
#include "imager/pointing/beam_terms.h"
#include "imager/pointing/curved_terms.h"

namespace misfit::imager {

/// What a mosaic is made of.
struct MosaicScene {
  ImageGeometry geometry;
  RowBeams beams;
  std::vector<double> frequency_hz;  ///< that samples have
  bool at_each = false;              ///< whether beams are made at each frequency itself: samples may have any between these
  double cut = 1e-3;                 ///< over its peak: beams are 0 beyond where they first fall to this
  /// To which beams follow from terms, see beam_spans(), in parts of the largest that they are at any frequency. Those that are
  /// not round are turned wrongly by four times that, over their peak.
  double tolerance = 1e-7;
  /// The largest |w| of any sample, in wavelengths; none where it is not known, and there are no CurvedTerms then.
  std::optional<double> max_abs_w = {};
};

/// A rectangle of an image's pixels.
struct Window {
  int first_row = 0;
  int first_column = 0;
  ImageGeometry geometry;  ///< of these pixels alone
};

/// The beams of a mosaic, and the windows on its image that they see. A beam is that of its pair of dishes up to the radius at
/// which the pair's main lobe falls to the cut at the lowest frequency, and 0 beyond it, at all frequencies: its sidelobes
/// within that radius count at higher ones. The radius is smaller than that at which a formula ends at any of the frequencies,
/// by 3% at least.
class MosaicBeams {
 public:
  /// Throws std::invalid_argument unless the cut is above 0 and below 1.
  explicit MosaicBeams(MosaicScene scene);

  const ImageGeometry& geometry() const { return scene_.geometry; }
  const RowBeams& rows() const { return scene_.beams; }
  double low_hz() const { return scene_.frequency_hz.front(); }  ///< the lowest frequency
  double cut() const { return scene_.cut; }
  double tolerance() const { return scene_.tolerance; }
  const std::optional<double>& max_abs_w() const { return scene_.max_abs_w; }
  /// Those that hold any of these frequencies, ascending. Throws std::invalid_argument where none holds one.
  std::vector<const BeamSpan*> spans(const std::vector<double>& frequency_hz) const;
  std::size_t all_spans() const { return scene_.at_each ? 1 : spans_.size(); }
  /// [term of a span, see BeamSpan]: its size, in parts of the beams, at most of all spans.
  const std::vector<double>& term_sizes() const { return term_sizes_; }
  /// The sizes of curved terms, at most of all spans; none where |w| is not known, or takes too many of them.
  const std::vector<double>& curved_sizes() const { return curved_sizes_; }
  /// Memory that their shares take at all frequencies.
  double curved_bytes() const;
  /// The curved terms of a span, of which there must be any.
  const CurvedTerms& curved(const BeamSpan& span) const { return curved_span(span).terms; }
  /// The rows that see alike.
  std::vector<RowBeams::Group> groups(const SampleCoordinates& at) const { return scene_.beams.groups(at, turn_rad_); }

  /// sin θ of the radius.
  double reach(const PairBeam& beam) const;
  double largest_reach() const;  ///< of any pair of dishes
  /// The beam in a direction.
  double power(const PairBeam& beam, DirectionCosines at, double frequency_hz) const;
  /// The pixels among which all are that the beam sees; none where it sees no pixel. Windows of a pair have one size.
  std::optional<Window> window(const PairBeam& beam) const;
  /// The terms of a beam in each pixel of a window. What follows from them is right to 1e-9 of power() for round beams, but for
  /// the tolerance.
  std::vector<Image> terms(const PairBeam& beam, const Window& window, const BeamSpan& span, int threads) const;
  /// Σ_jk weight_jk t_j t_k of the terms t of a beam in each pixel of a window; weight is [term][term], of which j ≤ k count.
  Image squares(const PairBeam& beam, const Window& window, const BeamSpan& span, const std::vector<double>& weight,
                int threads) const;
  /// `count` of a span's curved terms, from `first` on, in each pixel of a window.
  std::vector<Image> curved_images(const PairBeam& beam, const Window& window, const BeamSpan& span, std::size_t first,
                                   std::size_t count, int threads) const;
  /// The terms of a beam in a direction.
  std::vector<double> terms(const PairBeam& beam, DirectionCosines at, const BeamSpan& span) const;

 private:
  using Pair = std::tuple<const VoltagePattern*, const VoltagePattern*>;

  /// The curved terms of a span, and their tables for pairs of round beams. Where beams are made at each frequency, all spans
  /// have one, of waves alone: the terms of a span are those times its beam.
  struct CurvedSpan {
    const BeamSpan* span;
    CurvedTerms terms;
    std::mutex mutex;  ///< of tables
    std::map<Pair, std::unique_ptr<const RadialTables>> tables;
  };

  /// [term], of a round beam.
  const RadialTables& tables(const PairBeam& beam, const BeamSpan& span, int threads) const;
  const RadialTables& curved_tables(const PairBeam& beam, CurvedSpan& curved, int threads) const;
  CurvedSpan& curved_span(const BeamSpan& span) const;
  /// Images whose pixels `write`, given sin θ and the direction, sets where the beam reaches them.
  template <typename Write>
  std::vector<Image> images(const PairBeam& beam, const Window& window, std::size_t count, int threads,
                            const Write& write) const;
  double found_reach(const VoltagePattern& one, const VoltagePattern& other) const;
  std::vector<double> seen(double frequency_hz) const;
  BeamDirections directions(const std::vector<double>& frequency_hz) const;
  void find_curved_terms();

  MosaicScene scene_;
  std::map<Pair, double> reach_;
  std::vector<BeamSpan> spans_;  ///< none where beams are made at each frequency
  std::vector<double> term_sizes_;
  double turn_rad_ = 0;
  double most_abs_w_ = 0;  ///< over tangent planes at the axes of all pointings that see the image
  std::vector<double> curved_sizes_;
  std::vector<std::unique_ptr<CurvedSpan>> curved_;
  mutable std::mutex mutex_;  ///< of what follows
  mutable std::map<std::tuple<const VoltagePattern*, const VoltagePattern*, const BeamSpan*>,
                   std::unique_ptr<const RadialTables>>
      tables_;
  mutable std::map<double, BeamSpan> at_each_;
};

}  // namespace misfit::imager
