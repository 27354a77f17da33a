#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "kernels/kernel.h"

namespace misfit::kernels::testing {

/// The same function, scaled so that h(0) = 1 as stored kernels are.
inline TapFunction normalised(const TapFunction& taps) {
  const double scale = optimal_correction(taps, Eigen::VectorXd::Zero(1))[0];
  return [taps, scale](double t) { return Eigen::VectorXd(scale * taps(t)); };
}

inline std::uint64_t bits(double value) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  return bits;
}

/// Bit for bit; any NaN is like any other.
inline bool same(double a, double b) {
  return bits(a) == bits(b) || (std::isnan(a) && std::isnan(b));
}

/// Every number of the two has the same bits.
inline bool same(const Kernel& a, const Kernel& b) {
  bool equal = a.name == b.name && same(a.x0, b.x0) && a.width() == b.width() &&
               a.polynomial.degree() == b.polynomial.degree() && a.origin.iterations == b.origin.iterations &&
               a.origin.precision == b.origin.precision;
  const auto compare = [&equal](double x, double y) { equal = equal && same(x, y); };
  compare(a.misfit.mean, b.misfit.mean);
  compare(a.misfit.max, b.misfit.max);
  compare(a.misfit.worst_mean, b.misfit.worst_mean);
  compare(a.misfit.worst, b.misfit.worst);
  compare(a.origin.mean_error, b.origin.mean_error);
  compare(a.origin.max_error, b.origin.max_error);
  compare(a.origin.max_error_bound, b.origin.max_error_bound);
  compare(a.origin.condition, b.origin.condition);
  for (Eigen::Index i = 0; equal && i < a.polynomial.coefficient.size(); ++i)
    compare(a.polynomial.coefficient.data()[i], b.polynomial.coefficient.data()[i]);
  return equal;
}

inline std::string content(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

inline void put(const std::string& path, const std::string& bytes) {
  std::filesystem::remove(path);  // some file systems wait for the disk when a file is emptied
  std::ofstream(path, std::ios::binary) << bytes;
}

}  // namespace misfit::kernels::testing
