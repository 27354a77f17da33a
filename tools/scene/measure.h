#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include "imager/data/extent.h"
#include "imager/data/stored_visibilities.h"
#include "imager/plan/accurate_imaging.h"
#include "tools/scene/points.h"
#include "tools/scene/truth.h"

namespace misfit::tools {

/// Seconds of one dirty image from visibilities in memory, and of one prediction of them all.
struct SceneSeconds {
  double grid = 0;
  double fft = 0;
  double degrid = 0;
  double predict_fft = 0;
  int stretch = 0;  ///< of runs one after another, in all of which the machine was equally fast, as far as can be known

  double image() const { return grid + fft; }
  double predict() const { return degrid + predict_fft; }
};

/// A point and its results: of the last pass where a plan needed two, except for seconds and work, which are of all passes.
struct PointResult {
  ScenePoint point;
  std::string refused;  ///< why it cannot be made; the other results then mean nothing
  int passes = 1;       ///< 2 where the image turned out weak against its data
  int width = 0;        ///< cells along u
  int width_w = 0;      ///< planes; 0 = w is left out
  double x0 = 0;        ///< along u
  double padding = 0;   ///< along u
  std::string evaluation;
  std::string precision;
  std::string work;         ///< its operations: points of one work differ in numbers alone, and take one time
  double memory_bytes = 0;  ///< of grids and buffers
  double expected_rms = 0;  ///< by theory, for random phases
  double bound_rms = 0;     ///< by theory, whatever the data
  double bound_max = 0;
  SceneErrors errors;
  std::vector<SceneSeconds> runs;
};

/// Σ w, Σ w|V|, Σ w Re V, Σ w Im V and a sum of UVW, which other data hardly share.
using Fingerprint = std::array<double, 5>;

/// The visibilities of a scene, in memory with the weights of its image, and what the images of them should be.
class Scene {
 public:
  /// Reads the MeasurementSet and takes direct sums, at fewer pixels where it is to be quick. Throws as MeasurementSet does.
  Scene(const ImageOptions& options, bool quick, const imager::Progress& progress);

  /// Runs a point once more, all passes of it; the first time its errors are taken.
  void run(PointResult& result, int stretch);

  /// Warnings for people on the sets and on the data read, as for an image of them.
  const std::vector<std::string>& warnings() const { return warnings_; }
  std::uint64_t samples() const { return visibilities_.samples(); }
  const Fingerprint& fingerprint() const { return fingerprint_; }
  const imager::ImageGeometry& geometry() const { return geometry_; }
  double read_s() const { return read_s_; }
  /// Seconds that direct sums would take for the image.
  double direct_s() const { return truth_->seconds_a_pixel() * static_cast<double>(geometry_.pixels()); }
  double w_phase_rad() const { return imager::max_w_phase_rad(reach_.max_abs_w, geometry_); }
  int threads() const { return threads_; }
  const SceneTruth& truth() const { return *truth_; }

 private:
  /// A plan for each pass that `misfit image` would make.
  using Plans = std::vector<imager::GriddingPlan>;

  /// Weighs the visibilities for the image.
  void weigh();
  Plans plans_of(const ScenePoint& point) const;
  imager::DirtyImages image(const imager::Transform& transform, SceneSeconds& seconds) const;
  void predict(const imager::Transform& transform, SceneSeconds& seconds, SceneErrors* errors) const;
  void describe(const Plans& plans, const imager::DirtyImages& made, PointResult& result) const;

  ImageOptions options_;
  int threads_;
  imager::ImageGeometry geometry_;
  imager::UvwReach reach_;
  std::vector<std::string> warnings_;
  imager::WSpread w_spread_;
  imager::StoredVisibilities visibilities_;
  Fingerprint fingerprint_{};
  double read_s_ = 0;
  std::unique_ptr<SceneTruth> truth_;
  std::map<std::string, Plans> plans_;  ///< by options_text
};

}  // namespace misfit::tools
