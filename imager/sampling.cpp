#include "imager/sampling.h"

namespace misfit::imager {

std::vector<char> samples_inside(const VisibilityBlock& block, double cell_rad, SampleSums& sums) {
  std::vector<char> inside(block.samples());
  std::size_t i = 0;
  for (std::size_t row = 0; row < block.rows(); ++row) {
    for (const double frequency : block.frequency_hz) {
      const double turns = frequency / speed_of_light_m_s * cell_rad;
      if (block.weight[i] != 0) {
        inside[i] = inside_grid(block.uvw_m[3 * row] * turns, block.uvw_m[3 * row + 1] * turns);
        ++(inside[i] ? sums.used : sums.outside_grid);
      }
      ++i;
    }
  }
  return inside;
}

}  // namespace misfit::imager
