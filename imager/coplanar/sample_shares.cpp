#include "imager/coplanar/sample_shares.h"

namespace misfit::imager {

ShareTable::ShareTable(std::size_t images, const std::vector<double>& shares) : images_(images) {
  constexpr std::size_t in_vector = 16;
  stride_ = (images + in_vector - 1) / in_vector * in_vector;
  const std::size_t parts = shares.size() / images;
  last_ = parts / 2 - points;
  double_.resize(parts * stride_ + most_shared_images);  // vectors from a later image on reach behind the last
  for (std::size_t part = 0; part < parts; ++part)
    for (std::size_t k = 0; k < images; ++k) double_[part * stride_ + k] = shares[part * images + k];
  single_.assign(double_.begin(), double_.end());
}

}  // namespace misfit::imager
