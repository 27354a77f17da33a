#include "tools/drawing/uv_picture.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "tools/base/numbers.h"
#include "tools/drawing/picture_layout.h"
#include "tools/drawing/sketch.h"

namespace misfit::tools {
namespace {

namespace fs = std::filesystem;
using imager::UvCoverage;

constexpr int middle = UvCoverage::side / 2;

/// The cells shown, `half` to either side of 0.
struct Scene {
  imager::Image counts;
  int half = 0;
  double cell_lambda = 0;
  std::uint64_t samples = 0;
  double most = 0;  ///< in a cell

  double reach_lambda() const { return half * cell_lambda; }
};

Scene scene_of(const UvCoverage& coverage) {
  const std::vector<std::uint64_t> counts = coverage.counts();
  int occupied = 0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (counts[i] == 0) continue;
    const int row = static_cast<int>(i) / UvCoverage::side, column = static_cast<int>(i) % UvCoverage::side;
    occupied = std::max({occupied, row + 1 - middle, column + 1 - middle});  // the mirror images reach as far down
  }
  Scene scene;
  scene.half = std::clamp(occupied + occupied / 16 + 1, 4, middle);
  scene.cell_lambda = 2 * coverage.reach_lambda() / UvCoverage::side;
  scene.samples = std::accumulate(counts.begin(), counts.end(), std::uint64_t{0}) / 2;
  scene.counts = imager::Image(2 * scene.half, 2 * scene.half);
  for (int row = 0; row < scene.counts.height; ++row)
    for (int column = 0; column < scene.counts.width; ++column) {
      const int at = (row + middle - scene.half) * UvCoverage::side + column + middle - scene.half;
      scene.counts.at(row, column) = static_cast<double>(counts[static_cast<std::size_t>(at)]);
    }
  scene.most = *std::max_element(scene.counts.pixel.begin(), scene.counts.pixel.end());
  return scene;
}

/// Logarithms of counts as 32-bit floats, NaN for empty cells, rows from v = −reach on.
void write_shades(const fs::path& path, const imager::Image& counts) {
  constexpr double few = 0.03;
  const auto occupied = std::count_if(counts.pixel.begin(), counts.pixel.end(), [](double count) { return count > 0; });
  const bool sparse = static_cast<double>(occupied) < few * static_cast<double>(counts.pixel.size());
  const imager::Image shown = sparse ? spread_points(counts, 1) : counts;
  std::vector<float> shades;
  for (const double count : shown.pixel)
    shades.push_back(count > 0 ? static_cast<float>(std::log10(count)) : std::numeric_limits<float>::quiet_NaN());
  std::ofstream file(path, std::ios::binary);
  file.write(reinterpret_cast<const char*>(shades.data()), static_cast<std::streamsize>(shades.size() * sizeof(float)));
  if (!file.flush()) throw std::runtime_error("cannot write pictures in " + path.parent_path().string());
}

ColourBar colour_bar(const Scene& scene) {
  ColourBar bar{.palette = "0 '#fdd884', 1 '#f98e09', 2 '#e35933', 3 '#bb3754', 4 '#88226a', 5 '#550f6d', 6 '#1f0c48'",
                .low = 0,
                .high = std::max(1.0, std::log10(scene.most)),
                .ticks = {},
                .notes = {"samples a cell", "log scale"}};
  for (int power = 0; power <= bar.high; ++power) bar.ticks.push_back({1.0 * power, power_of_ten(std::pow(10.0, power), 1)});
  return bar;
}

}  // namespace

void write_uv_script(const UvCoverage& coverage, const fs::path& folder) {
  const Scene scene = scene_of(coverage);
  write_shades(folder / "data", scene.counts);
  const double reach = scene.reach_lambda();
  const ScaledUnit unit = uv_unit(reach), cell_unit = uv_unit(scene.cell_lambda);
  const double shown = reach / unit.size, cell = scene.cell_lambda / unit.size;
  const PictureLayout layout(1, 1);
  std::ofstream script(folder / "script");
  write_beginning(script, layout);
  write_titles(script, layout,
               {"uv coverage", grouped(static_cast<long long>(scene.samples)) + " samples and their mirror images",
                "in cells of " + significant(scene.cell_lambda / cell_unit.size, 3) + " " + cell_unit.name});
  write_axes(script, layout, {'x', "u, " + unit.name, -shown, shown}, {'y', "v, " + unit.name, -shown, shown});
  write_colour_bar(script, layout, colour_bar(scene));
  script << "plot 'data' binary array=(" << scene.counts.width << ',' << scene.counts.height << ") format='%float' origin=("
         << cell / 2 - shown << ',' << cell / 2 - shown << ") dx=" << cell << " dy=" << cell << " with image\nunset output\n";
}

}  // namespace misfit::tools
