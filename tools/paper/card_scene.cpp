#include "tools/paper/card_scene.h"

#include <cmath>
#include <cstdlib>
#include <numeric>

#include "imager/direct/direct_transform.h"
#include "imager/direct/source_sums.h"
#include "imager/numerics/constants.h"
#include "tools/base/array.h"
#include "tools/formats/sky.h"

namespace misfit::tools {
namespace {

constexpr double degree_rad = imager::pi / 180;
constexpr double card_cell_rad = 0.05 / 3600 * degree_rad;
constexpr double hour_angle_span = 6 * 15 * degree_rad;
constexpr int strips = 40;

/// Sums of squares in the strips of an image that is as wide as high.
class StripSums {
 public:
  StripSums(int pixels, int fft_size) : pixels_(pixels), fft_size_(fft_size), x_(strips), sum_(strips), count_(strips) {}

  /// A mean square over the line of pixels at `offset` from the middle.
  void add_line(int offset, double mean_square) {
    const auto strip = static_cast<std::size_t>(std::abs(offset) * strips / (pixels_ / 2 + 1));
    x_[strip] += static_cast<double>(std::abs(offset)) / fft_size_;
    sum_[strip] += mean_square;
    count_[strip] += 1;
  }

  MisfitProfile profile() const {
    MisfitProfile result;
    for (std::size_t k = 0; k < x_.size(); ++k) {
      if (count_[k] == 0) continue;
      result.x.push_back(x_[k] / count_[k]);
      result.rms.push_back(std::sqrt(sum_[k] / count_[k]));
    }
    result.whole =
        std::sqrt(std::accumulate(sum_.begin(), sum_.end(), 0.0) / std::accumulate(count_.begin(), count_.end(), 0.0));
    return result;
  }

 private:
  int pixels_;
  int fft_size_;
  std::vector<double> x_;
  std::vector<double> sum_;
  std::vector<double> count_;
};

/// The profile of a square error given for every pixel.
template <typename SquareError>
MisfitProfile profile_of(const CardScene& scene, int fft_size, const SquareError& square_error) {
  const int pixels = scene.geometry.width;
  std::vector<double> rows(static_cast<std::size_t>(pixels));
  std::vector<double> columns(static_cast<std::size_t>(pixels));
  for (int row = 0; row < pixels; ++row) {
    for (int column = 0; column < pixels; ++column) {
      const double square = square_error(row, column) / pixels;
      rows[static_cast<std::size_t>(row)] += square;
      columns[static_cast<std::size_t>(column)] += square;
    }
  }
  StripSums sums(pixels, fft_size);
  for (int i = 0; i < pixels; ++i) {
    sums.add_line(i - pixels / 2, rows[static_cast<std::size_t>(i)]);
    sums.add_line(i - pixels / 2, columns[static_cast<std::size_t>(i)]);
  }
  return sums.profile();
}

imager::ImageGeometry card_geometry(const CardSceneOptions& options) {
  return {options.pixels, options.pixels, options.cells_a_pixel * card_cell_rad, {}};
}

imager::VisibilityBlock card_samples(const CardSceneOptions& options) {
  constexpr double frequency_hz = 4e9;
  constexpr double declination = 40 * degree_rad;
  const AntennaArray array = antenna_array(options.array);
  imager::VisibilityBlock block;
  block.frequency_hz = {frequency_hz};
  for (int i = 0; i < options.integrations; ++i) {
    const double hour_angle = hour_angle_span * ((i + 0.5) / options.integrations - 0.5);
    for (const double metres : uvw(array, {hour_angle, declination})) block.uvw_m.edit().push_back(metres);
  }
  for (std::size_t i = 2; i < block.uvw_m.size(); i += 3) block.uvw_m.edit()[i] = 0;
  block.visibility.resize(block.samples());
  block.weight.assign(block.samples(), 1);
  return block;
}

}  // namespace

CardScene card_scene(const CardSceneOptions& options) {
  CardScene scene;
  scene.geometry = card_geometry(options);
  scene.sources = test_card(card_cell_rad);
  scene.block = card_samples(options);
  scene.visibility = imager::predict_sources(scene.sources, scene.block, options.threads, false);
  const imager::DirectTransform direct({scene.geometry, false, options.threads});
  const auto sum = direct.adjoint({});
  sum->add(scene.block, scene.visibility);
  const imager::AdjointResult result = sum->finish();
  scene.direct = result.images.front();
  scene.random_rms = std::sqrt(result.sums.front().weight2_square / 2);
  return scene;
}

MisfitProfile measured_misfit(const imager::Image& gridded, const CardScene& scene, int fft_size) {
  return profile_of(scene, fft_size, [&](int row, int column) {
    return std::pow((gridded.at(row, column) - scene.direct.at(row, column)) / scene.random_rms, 2);
  });
}

MisfitProfile expected_misfit(const AxisErrors& errors, const CardScene& scene, int fft_size) {
  const Eigen::VectorXd variance = errors.mean_square - errors.mean.cwiseAbs2();
  const int middle = scene.geometry.width / 2;
  return profile_of(scene, fft_size, [&](int row, int column) {
    const int x = std::abs(column - middle);
    const int y = std::abs(row - middle);
    const double scaled = (errors.mean[x] + errors.mean[y]) * scene.direct.at(row, column) / scene.random_rms;
    return scaled * scaled + variance[x] + variance[y];
  });
}

Eigen::VectorXd pixel_offsets(int pixels, int fft_size) {
  const int last = pixels / 2;
  return Eigen::VectorXd::LinSpaced(last + 1, 0, static_cast<double>(last) / fft_size);
}

}  // namespace misfit::tools
