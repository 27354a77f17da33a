#pragma once

#include <string>
#include <vector>

#include "tools/run/image_options.h"

namespace misfit::tools {

/// One way to ask `misfit image` for the image of a scene.
struct ScenePoint {
  std::string kernel = "least-misfit";
  double accuracy = 0;  ///< asked, and all else left to the plan; 0 = width, padding and precision are given
  int width = 0;
  double padding = 0;
  std::string precision = "auto";
  std::string evaluation = "polynomial";
  int sampling = 0;

  bool operator==(const ScenePoint&) const = default;
};

/// The points to compare: each kernel at accuracies from 1e-2 to 1e-8 as its plan chooses, and over a grid of widths, paddings
/// and precisions; for some least-misfit kernels other evaluations. `more` are kernels besides those of the catalogue. A quick
/// comparison leaves out most of the grid.
std::vector<ScenePoint> scene_points(bool quick, const std::vector<std::string>& more);

/// The options of the scene with those of the point.
ImageOptions options_of(const ImageOptions& scene, const ScenePoint& point);

/// The options of `misfit image` that make a point, as they are typed: "--kernel minimax --accuracy 1e-05".
std::string options_text(const ScenePoint& point);

}  // namespace misfit::tools
