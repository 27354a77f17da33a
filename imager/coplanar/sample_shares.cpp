#include "imager/coplanar/sample_shares.h"

namespace misfit::imager {

namespace {

std::size_t stride_of(std::size_t images) {
  constexpr std::size_t in_vector = 16;
  return (images + in_vector - 1) / in_vector * in_vector;
}

}  // namespace

double ShareTable::bytes(std::size_t images, std::size_t points) {
  return static_cast<double>((2 * points * stride_of(images) + most_shared_images) * (sizeof(float) + sizeof(double)));
}

ShareTable::ShareTable(std::size_t images, const std::vector<double>& shares) : stride_(stride_of(images)) {
  const std::size_t parts = shares.size() / images;
  last_ = parts / 2 - points;
  double_.resize(parts * stride_ + most_shared_images);  // vectors from a later image on reach behind the last
  for (std::size_t part = 0; part < parts; ++part)
    for (std::size_t k = 0; k < images; ++k) double_[part * stride_ + k] = shares[part * images + k];
  single_.assign(double_.begin(), double_.end());
}

}  // namespace misfit::imager
