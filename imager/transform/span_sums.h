#pragma once

#include <complex>
#include <cstddef>

#include "imager/transform/transform.h"

namespace misfit::imager {

/// Adds `count` consecutive samples whose weight is not 0 to the sums, as add_to_sums does, without counting them.
void add_span_to_sums(const float* weight, const std::complex<float>* visibility, std::size_t count, SampleSums& sums);
void add_span_to_sums(const float* weight, const std::complex<double>* visibility, std::size_t count, SampleSums& sums);

}  // namespace misfit::imager
