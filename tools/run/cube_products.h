#pragma once

#include <string>
#include <vector>

#include "tools/run/cube_batches.h"
#include "tools/run/cube_files.h"
#include "tools/run/plane_run.h"
#include "tools/run/primary_beam_stage.h"

namespace misfit::tools {

/// From what is done for a plane of a cube to its images. With --restoringbeam common, restored images follow once all planes
/// are there. Stages timed: "restore", "statistics", "primary beam", "write images", which counts in what a plane waits for
/// others.
class CubeProducts {
 public:
  /// `primary_beam` is null where none is wanted; options and it are kept by reference.
  CubeProducts(const ImageOptions& options, const imager::ImageHeader& header, const PrimaryBeamStage* primary_beam,
               const PlaneWorkers& workers, const CubeFiles::Open& open);

  /// Writes the plane that its report names, in any order, and adds to the report what its pixels tell. May be called for
  /// several planes at the same time. Returns what the user should know of its primary beam; empty if nothing.
  std::string write(PlaneRun& plane);
  CubeFiles& files() { return files_; }
  /// After the last plane, with numbers for the headers. Tells reports of the common beam, where there is one. Returns the
  /// names of files that an earlier run left and this one removed.
  std::vector<std::string> finish(std::vector<PlaneReport>& planes, const std::vector<imager::HeaderCard>& cards,
                                  imager::StageTimes& times);

 private:
  struct Written;

  void write(std::size_t stokes, const imager::Image& primary_beam, PlaneRun& plane);
  imager::Image restore(const imager::Image& model, const imager::Image& residual, const imager::Beam& beam) const;
  void restore_in_common(std::vector<PlaneReport>& planes);
  void restore_plane(PlaneReport& plane, const imager::Beam& common, const Written& written);

  const ImageOptions& o_;
  imager::ImageHeader header_;
  CubeFiles files_;
  const PrimaryBeamStage* primary_beam_;
  PlaneWorkers workers_;
  bool in_common_;  ///< whether all planes are restored with one beam, known only once they are there
};

}  // namespace misfit::tools
