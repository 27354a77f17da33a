#pragma once

#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "imager/beams/primary_beam.h"
#include "imager/beams/telescopes.h"
#include "imager/plan/plan.h"
#include "imager/streaming/weight_shares.h"
#include "imager/taylor/taylor_beam.h"
#include "ms_io/measurement_set.h"
#include "tools/run/primary_beam_options.h"

namespace misfit::tools {

/// The reason why a run has no primary beam.
struct NoPrimaryBeam : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The antennas and pointings of a run's rows, and its image.
struct BeamScene {
  ms_io::BeamRows rows;
  imager::ImageGeometry geometry;
  double frequency_hz = 0;  ///< middle of the band, for what is told before weights are known
  /// Where the zenith was for each row, see MeasurementSet::zenith_turns(); called where beams are not round.
  std::function<std::vector<float>()> zenith_turns = {};
};

/// The primary beam of a run, from what its sets tell about antennas to images of it. Its stage is timed as "primary beam" by
/// who calls it.
class PrimaryBeamStage {
 public:
  /// Throws NoPrimaryBeam that names the antenna or field where antennas have no simple beam, fields point in different
  /// directions or feeds point beside them.
  PrimaryBeamStage(const TypedPrimaryBeam& options, BeamScene scene, int threads);

  /// Which beam is taken, from what, and its width in the middle of the band.
  imager::Decision decision() const;
  /// Doubts about the beam, a sentence each.
  std::vector<std::string> doubts() const;

  /// Learns by how much each pair of dishes and each frequency weigh in the image, in a pass over its samples as they are
  /// weighed. To be called before whole_band(), of_terms(), and of_image() of the whole band.
  void weigh(const imager::VisibilitySource& source);
  /// The beam of an image of the whole band: the mean over its samples, by weight.
  imager::Image whole_band() const;
  /// The beam of Taylor terms, of the same samples by the same weights.
  imager::TaylorBeam of_terms(const imager::TaylorExpansion& expansion) const;
  /// The beam of a plane of a cube: the beam at its frequency, with equal weights of all rows where dishes differ.
  imager::Image at(double frequency_hz) const;

  /// The beam of an image: whole_band() where samples were weighed, else at its frequency.
  imager::Image of_image(double frequency_hz) const { return shares_.empty() ? at(frequency_hz) : whole_band(); }

  /// A warning that the antennas see nothing of the image; else empty.
  std::string warning_of(const imager::Image& beam) const;

 private:
  /// The beam with equal weights of all rows.
  imager::PrimaryBeam nominal_beam(double frequency_hz) const;
  std::vector<imager::BeamShare> beam_shares() const;
  imager::BeamShare beam_share(std::uint32_t kind, double frequency_hz, double weight) const;
  imager::Image image_of(const imager::PrimaryBeam& beam) const;
  std::uint32_t kinds() const;
  /// A number for the row's pair of dishes and, to a degree, its turn.
  std::uint32_t kind_of(std::uint64_t row) const;
  void find_pointing();

  BeamScene scene_;
  imager::BeamOnImage view_;
  std::vector<imager::BeamModel> models_;  ///< [sort of antennas]
  std::vector<float> turn_rad_;            ///< [row], of the zenith; empty where all beams are round
  double width_rad_ = 0;                   ///< between half-power points of the nominal beam
  std::vector<imager::WeightShare> shares_;
};

}  // namespace misfit::tools
