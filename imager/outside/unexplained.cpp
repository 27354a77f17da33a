#include "imager/outside/unexplained.h"

#include <algorithm>
#include <cmath>

#include "imager/numerics/constants.h"
#include "imager/transform/sampling.h"

namespace misfit::imager {
namespace {

bool lies_inside(double u_turns, double v_turns) {
  return inside_grid(2 * u_turns, 2 * v_turns);
}

/// The residuals of a row's neighbouring channels within one cell: they may share their noise.
struct Placed {
  std::int64_t cell = 0;
  double weight = 0;              ///< Σ w
  std::complex<double> residual;  ///< Σ w r
};

/// Sums over means of rows within cells, and over ordered pairs of them that share a cell.
struct Sums {
  double means = 0;
  double weight = 0;        ///< Σ w
  double power = 0;         ///< Σ w |r|²; a mean's |r|² has two parts, of which an image takes one
  double shared = 0;        ///< means less cells
  double scatter = 0;       ///< Σ w |r − mean of its cell|², of which each of `shared` adds twice the noise of weight 1
  double pair_weight = 0;   ///< Σ w_j w_k
  double pair_weight2 = 0;  ///< Σ (w_j w_k)²
  double pair_power = 0;    ///< Σ w_j w_k Re r_j r_k*

  /// Adds all means of a cell: sums over pairs are squares of sums less sums of squares.
  void add_cell(const Placed* begin, const Placed* end) {
    double w = 0, w2 = 0, w4 = 0, in_power = 0, power2 = 0;
    std::complex<double> sum;
    for (const Placed* p = begin; p != end; ++p) {
      const double square = p->weight * p->weight;
      w += p->weight;
      w2 += square;
      w4 += square * square;
      in_power += std::norm(p->residual) / p->weight;
      power2 += std::norm(p->residual);
      sum += p->residual;
    }
    const auto count = static_cast<double>(end - begin);
    means += count;
    weight += w;
    power += in_power;
    if (end - begin < 2) return;
    shared += count - 1;
    scatter += std::max(0.0, in_power - std::norm(sum) / w);
    pair_weight += w * w - w2;
    pair_weight2 += w2 * w2 - w4;
    pair_power += std::norm(sum) - power2;
  }

  void add_up(const Ranks& ranks) {
    sum_over(ranks, means, weight, power, shared, scatter, pair_weight, pair_weight2, pair_power);
  }

  /// The largest noise of weight 1 in one part: by the scatter of means within cells, to three standard deviations; or by the
  /// scatter of all.
  double most_unit_noise() const {
    const double of_all = power / means / 2;
    if (shared == 0) return std::sqrt(of_all);
    return std::sqrt(std::min(of_all, scatter / shared / 2 * (1 + 3 / std::sqrt(shared))));
  }
};

std::vector<Placed> placed(const VisibilityBlock& block, const std::vector<std::complex<double>>& residual,
                           const ImageGeometry& field) {
  std::vector<Placed> all;
  std::size_t i = 0;
  for (std::size_t row = 0; row < block.rows(); ++row) {
    const std::size_t first = all.size();
    for (const double frequency_hz : block.frequency_hz) {
      const double per_m = frequency_hz / speed_of_light_m_s * field.cell_rad;
      const double u = block.uvw_m[3 * row] * per_m, v = block.uvw_m[3 * row + 1] * per_m;
      constexpr int parts = 4;
      if (block.weight[i] != 0 && lies_inside(u, v)) {
        const auto column = static_cast<std::int64_t>(std::floor(parts * field.width * u));
        const auto line = static_cast<std::int64_t>(std::floor(parts * field.height * v));
        const std::int64_t cell = line * parts * 2 * field.width + column;
        if (all.size() == first || all.back().cell != cell) all.push_back({cell, 0, 0});
        const double weight = block.weight[i];
        all.back().weight += weight;
        all.back().residual += weight * residual[i];
      }
      ++i;
    }
  }
  std::sort(all.begin(), all.end(), [](const Placed& a, const Placed& b) { return a.cell < b.cell; });
  return all;
}

}  // namespace

Unexplained unexplained_by(const Image& model, const VisibilitySource& source, const Transform& transform,
                           const ImageGeometry& field, const Context& context) {
  Sums sums;
  for_each_residual(source, transform, model, context,
                    [&](const VisibilityBlock& block, const std::vector<std::complex<double>>& residual) {
                      const StageTimer timer(context.times, stage::statistics);
                      const std::vector<Placed> all = placed(block, residual, field);
                      for (const Placed *at = all.data(), *end = at + all.size(), *next; at != end; at = next) {
                        next = std::find_if(at, end, [at](const Placed& p) { return p.cell != at->cell; });
                        sums.add_cell(at, next);
                      }
                    });
  sums.add_up(source.ranks());
  if (sums.weight == 0) return {};
  const double square = sums.power / sums.weight;
  const double alike = sums.pair_weight == 0 ? 0 : sums.pair_power / sums.pair_weight;
  const double unsure = sums.pair_weight == 0 ? square : 3 * square * std::sqrt(sums.pair_weight2) / sums.pair_weight;
  const double least = std::clamp(alike - unsure, 0.0, square), most = std::clamp(alike + unsure, 0.0, square);
  return {std::sqrt(square), std::sqrt(least), std::sqrt(most), sums.most_unit_noise()};
}

}  // namespace misfit::imager
