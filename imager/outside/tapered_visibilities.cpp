#include "imager/outside/tapered_visibilities.h"

#include <cmath>

#include "imager/numerics/constants.h"

namespace misfit::imager {
namespace {

class TaperedStream : public BlockStream {
 public:
  TaperedStream(std::unique_ptr<BlockStream> from, double cell_rad) : from_(std::move(from)), cell_rad_(cell_rad) {}

  std::shared_ptr<const VisibilityBlock> next() override {
    const auto block = from_->next();
    if (!block) return nullptr;
    const auto tapered = std::make_shared<VisibilityBlock>(*block);
    float* weight = tapered->weight.data();
    for (std::size_t row = 0; row < block->rows(); ++row) {
      const double u_m = block->uvw_m[3 * row], v_m = block->uvw_m[3 * row + 1];
      for (const double frequency_hz : block->frequency_hz) {
        const double turns = 2 * cell_rad_ * frequency_hz / speed_of_light_m_s;
        if (*weight != 0) *weight *= static_cast<float>(std::exp(-std::log(100.0) * (u_m * u_m + v_m * v_m) * turns * turns));
        ++weight;
      }
    }
    return tapered;
  }

 private:
  std::unique_ptr<BlockStream> from_;
  double cell_rad_;
};

}  // namespace

std::unique_ptr<BlockStream> TaperedVisibilities::open() const {
  return std::make_unique<TaperedStream>(from_.open(), cell_rad_);
}

}  // namespace misfit::imager
