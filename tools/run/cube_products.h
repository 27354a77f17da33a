#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tools/run/cube_files.h"
#include "tools/run/plane_run.h"
#include "tools/run/primary_beam_stage.h"

namespace misfit::tools {

/// From what is done for a plane of a cube to its images. With --restoringbeam common, restored images follow once all planes
/// are there. Stages timed: "restore", "statistics", "primary beam", "write images".
class CubeProducts {
 public:
  /// `primary_beam` is null where none is wanted; all are kept by reference but the header.
  CubeProducts(const PlaneScene& scene, const imager::ImageHeader& header, const PrimaryBeamStage* primary_beam);

  /// Writes a plane, and adds to its report what its pixels tell.
  void write(int channel, PlaneRun& plane);
  /// After the last plane, with numbers for the headers. Tells reports of the common beam, where there is one. Returns the
  /// names of files that an earlier run left and this one removed.
  std::vector<std::string> finish(std::vector<PlaneReport>& planes, const std::vector<imager::HeaderCard>& cards);

 private:
  imager::Image primary_beam_at(double frequency_hz);
  imager::Image restore(const imager::Image& model, const imager::Image& residual, const imager::Beam& beam) const;
  void look_at(const imager::PlaneIndex& at, const imager::Image& residual, const imager::Image& image,
               PlaneReport& plane) const;
  void restore_in_common(std::vector<PlaneReport>& planes);

  const PlaneScene& scene_;
  imager::SpectralAxis axis_;
  CubeFiles files_;
  const PrimaryBeamStage* primary_beam_;
  bool in_common_;       ///< whether all planes are restored with one beam, known only once they are there
  bool unseen_ = false;  ///< by the antennas, which was said
};

}  // namespace misfit::tools
