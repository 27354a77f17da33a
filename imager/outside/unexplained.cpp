#include "imager/outside/unexplained.h"

#include <algorithm>
#include <cmath>

#include "imager/constants.h"
#include "imager/sampling.h"

namespace misfit::imager {
namespace {

bool lies_inside(double u_turns, double v_turns) {
  return inside_grid(2 * u_turns, 2 * v_turns);
}

/// A sample's residual and the cell that it lies in.
struct Placed {
  std::int64_t cell = 0;
  double weight = 0;
  std::complex<double> residual;
};

/// Sums over samples, and over ordered pairs of them that share a cell.
struct Sums {
  double samples = 0;
  double weight = 0;        ///< Σ w
  double power = 0;         ///< Σ w |r|²; a sample's |r|² has two parts, of which an image takes one
  double pair_weight = 0;   ///< Σ w_j w_k
  double pair_weight2 = 0;  ///< Σ (w_j w_k)²
  double pair_power = 0;    ///< Σ w_j w_k Re r_j r_k*

  /// All samples of a cell: sums over pairs are squares of sums less sums of squares.
  void add_cell(const Placed* begin, const Placed* end) {
    double w = 0, w2 = 0, w4 = 0, power2 = 0;
    std::complex<double> sum;
    for (const Placed* p = begin; p != end; ++p) {
      const double square = p->weight * p->weight;
      w += p->weight;
      w2 += square;
      w4 += square * square;
      power += p->weight * std::norm(p->residual);
      power2 += square * std::norm(p->residual);
      sum += p->weight * p->residual;
    }
    samples += static_cast<double>(end - begin);
    weight += w;
    if (end - begin < 2) return;
    pair_weight += w * w - w2;
    pair_weight2 += w2 * w2 - w4;
    pair_power += std::norm(sum) - power2;
  }
};

std::vector<Placed> placed(const VisibilityBlock& block, const std::vector<std::complex<double>>& residual,
                           const ImageGeometry& field) {
  std::vector<Placed> all;
  std::size_t i = 0;
  for (std::size_t row = 0; row < block.rows(); ++row)
    for (const double frequency_hz : block.frequency_hz) {
      const double per_m = frequency_hz / speed_of_light_m_s * field.cell_rad;
      const double u = block.uvw_m[3 * row] * per_m, v = block.uvw_m[3 * row + 1] * per_m;
      constexpr int parts = 4;
      if (block.weight[i] != 0 && lies_inside(u, v)) {
        const auto column = static_cast<std::int64_t>(std::floor(parts * field.width * u));
        const auto line = static_cast<std::int64_t>(std::floor(parts * field.height * v));
        all.push_back({line * parts * 2 * field.width + column, block.weight[i], residual[i]});
      }
      ++i;
    }
  std::sort(all.begin(), all.end(), [](const Placed& a, const Placed& b) { return a.cell < b.cell; });
  return all;
}

}  // namespace

Unexplained unexplained_by(const Image& model, const VisibilitySource& source, const Transform& transform,
                           const ImageGeometry& field, const Progress& progress, StageTimes& times) {
  Sums sums;
  for_each_residual(source, transform, model, progress, times,
                    [&](const VisibilityBlock& block, const std::vector<std::complex<double>>& residual) {
                      const StageTimer timer(times, "statistics");
                      const std::vector<Placed> all = placed(block, residual, field);
                      for (const Placed *at = all.data(), *end = at + all.size(), *next; at != end; at = next) {
                        next = std::find_if(at, end, [at](const Placed& p) { return p.cell != at->cell; });
                        sums.add_cell(at, next);
                      }
                    });
  if (sums.weight == 0) return {};
  const double square = sums.power / sums.weight;
  const double alike = sums.pair_weight == 0 ? 0 : sums.pair_power / sums.pair_weight;
  const double unsure = sums.pair_weight == 0 ? square : 3 * square * std::sqrt(sums.pair_weight2) / sums.pair_weight;
  const double least = std::clamp(alike - unsure, 0.0, square), most = std::clamp(alike + unsure, 0.0, square);
  const double noise_part = square == 0 ? 0 : 1 - least / square;
  return {std::sqrt(square), std::sqrt(least), std::sqrt(most), std::sqrt(noise_part * sums.power / sums.samples / 2)};
}

}  // namespace misfit::imager
