#include "imager/beams/main_lobe.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace misfit::imager {
namespace {

constexpr int samples_per_pixel = 12;

/// The main lobe of a PSF that is sampled `per_pixel` times a pixel.
MainLobe connected_samples(const Image& psf, int per_pixel) {
  struct Place {
    int row, column;
  };
  const Place centre{psf.height / 2, psf.width / 2};
  std::vector<char> seen(psf.pixel.size());
  std::vector<Place> queue;
  const auto visit = [&](int row, int column) {
    if (row < 0 || row >= psf.height || column < 0 || column >= psf.width || !(psf.at(row, column) > MainLobe::cutoff)) return;
    char& mark = seen[static_cast<std::size_t>(row) * static_cast<std::size_t>(psf.width) + static_cast<std::size_t>(column)];
    if (!mark) queue.push_back({row, column});
    mark = 1;
  };
  MainLobe lobe;
  visit(centre.row, centre.column);
  for (std::size_t i = 0; i < queue.size(); ++i) {
    const auto [row, column] = queue[i];
    const int east = centre.column - column, north = row - centre.row;
    lobe.samples.push_back({double(east), double(north), psf.at(row, column)});
    lobe.reach = std::max({lobe.reach, std::abs(east) / per_pixel, std::abs(north) / per_pixel});
    visit(row - 1, column);
    visit(row + 1, column);
    visit(row, column - 1);
    visit(row, column + 1);
  }
  const double radius = std::sqrt(static_cast<double>(queue.size()) / M_PI);
  for (LobeSample& sample : lobe.samples) sample = {sample.east / radius, sample.north / radius, sample.value};
  lobe.scale = radius / per_pixel;
  return lobe;
}

/// [pixel][sample]: the part of a pixel in each sample, for pixels up to `half` and samples up to `reach` pixels from the
/// centre.
Eigen::MatrixXd sinc_matrix(int half, int reach) {
  const int last = reach * samples_per_pixel;
  return Eigen::MatrixXd::NullaryExpr(2 * half + 1, 2 * last + 1, [&](Eigen::Index pixel, Eigen::Index sample) {
    const double t = M_PI * (double(sample - last) / samples_per_pixel - double(pixel - half));
    return t == 0 ? 1 : std::sin(t) / t;
  });
}

/// The PSF between pixels, up to `reach` pixels from its centre.
Image refined(const Image& psf, int reach) {
  constexpr int most = 511;
  const int rows = std::min((psf.height - 1) / 2, most), columns = std::min((psf.width - 1) / 2, most);
  using Pixels = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  Pixels window(2 * rows + 1, 2 * columns + 1);
  for (int r = -rows; r <= rows; ++r)
    for (int c = -columns; c <= columns; ++c) {
      const double value = psf.at(psf.height / 2 + r, psf.width / 2 + c);
      window(r + rows, c + columns) = std::isfinite(value) ? value : 0;
    }
  const int size = 2 * reach * samples_per_pixel + 1;
  Image fine(size, size);
  Eigen::Map<Pixels>(fine.pixel.data(), size, size) =
      sinc_matrix(rows, reach).transpose() * (window * sinc_matrix(columns, reach));
  return fine;
}

}  // namespace

MainLobe main_lobe(const Image& psf) {
  constexpr std::size_t enough = 30;
  MainLobe lobe = connected_samples(psf, 1);
  if (lobe.samples.empty() || lobe.samples.size() >= enough) return lobe;
  const int border = (std::min(psf.width, psf.height) - 1) / 2;
  for (int reach = 4; reach <= std::min(border, 32); reach *= 2) {
    MainLobe finer = connected_samples(refined(psf, reach), samples_per_pixel);
    if (finer.reach < reach) return finer;
  }
  return lobe;
}

}  // namespace misfit::imager
