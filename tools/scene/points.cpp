#include "tools/scene/points.h"

#include <algorithm>
#include <cstdio>

#include "tools/base/text.h"

namespace misfit::tools {
namespace {

std::string text(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%g", value);
  return buffer;
}

const std::vector<std::string> compared_kernels{"least-misfit", "minimax", "spheroidal", "kaiser-bessel", "exp-semicircle"};

/// The accuracies that most people ask for come first: a quick comparison may end before the rest.
void add_plans(const std::vector<std::string>& kernels, std::vector<ScenePoint>& points) {
  for (const double accuracy : {1e-4, 1e-6, 1e-2, 1e-8, 1e-3, 1e-5, 1e-7})
    for (const std::string& kernel : kernels) points.push_back({.kernel = kernel, .accuracy = accuracy});
}

/// Adds points in the precisions that matter: single where a kernel of this width may limit the error, double where single may.
void add_grid(const std::string& kernel, int width, double padding, std::vector<ScenePoint>& points) {
  constexpr int widest_in_single = 8;
  constexpr int narrowest_in_double = 7;
  if (width <= widest_in_single)
    points.push_back({.kernel = kernel, .width = width, .padding = padding, .precision = "single"});
  if (width >= narrowest_in_double)
    points.push_back({.kernel = kernel, .width = width, .padding = padding, .precision = "double"});
}

struct Table {
  const char* interpolation;
  int sampling;
};

void add_evaluations(int width, double padding, const std::vector<Table>& tables, std::vector<ScenePoint>& points) {
  const std::string precision = width <= 5 ? "single" : "double";
  points.push_back({.width = width, .padding = padding, .precision = precision, .evaluation = "full"});
  for (const Table& table : tables)
    points.push_back({.width = width,
                      .padding = padding,
                      .precision = precision,
                      .evaluation = table.interpolation,
                      .sampling = table.sampling});
}

}  // namespace

std::vector<ScenePoint> scene_points(bool quick, const std::vector<std::string>& more) {
  std::vector<std::string> kernels = compared_kernels;
  for (const std::string& kernel : more)
    if (std::find(kernels.begin(), kernels.end(), kernel) == kernels.end()) kernels.push_back(kernel);
  std::vector<ScenePoint> points;
  add_plans(kernels, points);
  points.push_back({.kernel = "nearest", .width = 1, .padding = 2, .precision = "single"});
  if (quick) {
    add_evaluations(7, 2, {{"nearest", 10000}, {"linear", 1000}, {"cubic", 64}}, points);
    for (const double padding : {1.4, 2.0, 1.6, 1.25})
      for (const int width : {3, 4, 5, 6, 7, 8, 10, 12})
        for (const char* kernel : {"least-misfit", "minimax"}) add_grid(kernel, width, padding, points);
    return points;
  }
  for (const double padding : {1.2, 1.5, 2.0})
    for (const int width : {2, 3, 4, 5, 6, 7, 8, 9, 10, 12, 14})
      for (const std::string& kernel : kernels) add_grid(kernel, width, padding, points);
  const std::vector<Table> tables{{"nearest", 100},    {"nearest", 10000}, {"nearest", 1000000},
                                  {"linear", 100},     {"linear", 10000},  {"quadratic", 100},
                                  {"quadratic", 1000}, {"cubic", 64},      {"cubic", 512}};
  for (const int width : {3, 5, 7, 9}) add_evaluations(width, 2, tables, points);
  return points;
}

ImageOptions options_of(const ImageOptions& scene, const ScenePoint& point) {
  ImageOptions options = scene;
  options.gridding.kernel.name = point.kernel;
  options.gridding.accuracy = point.accuracy;
  options.gridding.kernel_width = point.width;
  options.gridding.padding = point.padding;
  options.gridding.precision = point.precision;
  options.gridding.evaluation = point.evaluation;
  options.gridding.sampling = point.sampling;
  return options;
}

std::string options_text(const ScenePoint& point) {
  std::string line = "--kernel " + shell_quoted(point.kernel);
  if (point.accuracy != 0) line += " --accuracy " + text(point.accuracy);
  if (point.width != 0) line += " --kernel-width " + std::to_string(point.width);
  if (point.padding != 0) line += " --padding " + text(point.padding);
  if (point.precision != "auto") line += " --precision " + point.precision;
  if (point.evaluation != "polynomial") line += " --evaluation " + point.evaluation;
  if (point.sampling != 0) line += " --sampling " + std::to_string(point.sampling);
  return line;
}

}  // namespace misfit::tools
