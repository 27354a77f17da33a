#include "imager/transform/sampling.h"

#include <algorithm>

#include "imager/numerics/parallel.h"

namespace misfit::imager {

std::vector<float> imaging_weights(const VisibilityBlock& block, const ImagedSamples& imaged, SampleSums& sums) {
  std::vector<double> turns;  // a metre's, per cell
  for (const double frequency : block.frequency_hz) turns.push_back(frequency / speed_of_light_m_s * imaged.geometry.cell_rad);
  const double aspect = imaged.geometry.pixel_aspect;
  std::vector<float> weight(block.samples());
  constexpr std::size_t rows_a_piece = 4096;
  std::vector<SampleSums> part((block.rows() + rows_a_piece - 1) / rows_a_piece);
  parallel_for(part.size(), imaged.threads, [&](std::size_t p) {
    for (std::size_t row = p * rows_a_piece; row < std::min((p + 1) * rows_a_piece, block.rows()); ++row)
      for (std::size_t channel = 0; channel < turns.size(); ++channel) {
        const std::size_t i = row * turns.size() + channel;
        if (block.weight[i] == 0) continue;
        const bool inside = imaged.beyond_grid || inside_grid(block.uvw_m[3 * row] * turns[channel],
                                                              block.uvw_m[3 * row + 1] * aspect * turns[channel]);
        if (inside) weight[i] = block.weight[i];
        ++(inside ? part[p].used : part[p].outside_grid);
      }
  });
  for (const SampleSums& of_piece : part) sums += of_piece;
  return weight;
}

}  // namespace misfit::imager
