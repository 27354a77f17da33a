#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/emit/divisor_series.h"
#include "tools/emit/realised_error.h"

namespace misfit::tools {

/// A gridding function in a host: all that is stated of it and written for it.
struct Emission {
  const Host* host = nullptr;
  HostKernel table;
  DivisorSeries divisor;               ///< 1/h, optimal for the taps that the host makes
  RealisedError realised;              ///< with the correction of the file, and rounding
  double rounding = 0;                 ///< about the part of `realised` that is rounding
  std::optional<RealisedError> own;    ///< with the correction that the host works out by itself
  std::optional<RealisedError> stock;  ///< the host's error with its own function
  RealisedError function;              ///< the function's own, without the host
};

/// Computes Emission::realised alone. Throws std::invalid_argument where the host cannot hold the kernel: its width, degree,
/// table or padding.
RealisedError realised_in(const Host& host, const HostKernel& table);

/// Throws as realised_in() does.
Emission emission(const Host& host, const HostKernel& table);

/// Refuses, by std::invalid_argument, a kernel that was made for another part of the FFT image than the host keeps:
/// |2·x0·padding − 1| > 1e-3.
void check_padding(const Host& host, double x0, double padding);

/// The lines that are printed, and stand at the head of every file.
std::vector<std::string> statement(const Emission& emission);

}  // namespace misfit::tools
