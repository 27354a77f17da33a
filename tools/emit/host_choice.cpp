#include "tools/emit/host_choice.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "tools/base/numbers.h"

namespace misfit::tools {
namespace {

HostKernel with(const HostRequest& r, const kernels::Kernel& kernel, int per_cell) {
  return {kernel, per_cell, per_cell > 0 ? r.interpolation : 0, r.padding, r.image_size};
}

double error_of(const HostRequest& r, const HostKernel& k) {
  return realised_in(*r.host, k).rms;
}

/// True if the number of entries a cell must be odd, as for tables that are read by the nearest entry: with an even number an
/// entry lies where cells meet and C may jump.
bool is_odd(const HostRequest& r) {
  return r.interpolation == 0;
}

int most_entries(const HostRequest& r) {
  const int most = r.host->table.most;
  return is_odd(r) && most % 2 == 0 ? most - 1 : most;
}

/// Rounded up to two digits.
int rounded_up(int entries, const HostRequest& r) {
  const double unit = std::max(1.0, std::pow(10.0, std::floor(std::log10(entries)) - 1));
  int rounded = static_cast<int>(std::ceil(entries / unit) * unit);
  if (is_odd(r) && rounded % 2 == 0) ++rounded;
  return std::min(rounded, most_entries(r));
}

int least_entries(const HostRequest& r) {
  return r.interpolation + 1;
}

/// The lowest degree that the host holds and that keeps the error within the target; nothing where there is none.
std::optional<HostKernel> by_degree(const HostRequest& r, const kernels::Kernel& kernel) {
  const auto [least, most] = r.host->degrees(kernel.width());
  for (int degree = least; degree <= std::min(most, kernel.polynomial.degree()); ++degree) {
    const HostKernel k = with(r, kernels::truncated(kernel, degree), 0);
    if (error_of(r, k) <= r.target_error) return k;
  }
  return {};
}

/// The best that the host can do with a kernel.
HostKernel finest(const HostRequest& r, const kernels::Kernel& kernel) {
  if (r.host->table.usual > 0) return with(r, kernel, most_entries(r));
  return with(r, kernels::truncated(kernel, r.host->degrees(kernel.width()).second), 0);
}

[[noreturn]] void out_of_reach(const HostRequest& r, const HostKernel& best, double error) {
  throw std::invalid_argument("--target-error " + significant(r.target_error, 3) + ": " + r.host->title +
                              " cannot reach it at padding " + significant(r.padding, 5) + "; expected at least " +
                              significant(error, 3) + ", which width " + std::to_string(best.kernel.width()) +
                              (best.per_cell > 0 ? " with " + std::to_string(best.per_cell) + " entries a cell" : "") + " has" +
                              r.host->otherwise);
}

/// The least number of entries, to two digits, that keeps the error within the target; 0 where the most do not.
int fewest_entries(const HostRequest& r, const kernels::Kernel& kernel) {
  const auto reaches = [&](int entries) { return error_of(r, with(r, kernel, entries)) <= r.target_error; };
  const int step = is_odd(r) ? 2 : 1;
  int enough = most_entries(r), few = least_entries(r);
  if (!reaches(enough)) return 0;
  if (reaches(few)) return few;
  while (enough - few > std::max(step, few / 50)) {  // by halves of the ratio, since the error is a power of the number
    int middle = static_cast<int>(std::sqrt(static_cast<double>(few) * enough));
    middle = std::clamp(middle - (middle - few) % step, few + step, enough - step);
    (reaches(middle) ? enough : few) = middle;
  }
  const int rounded = rounded_up(enough, r);
  return reaches(rounded) ? rounded : enough;
}

/// The kernel in the form with which the host reaches the target; nothing where it does not.
std::optional<HostKernel> reaching(const HostRequest& r, const kernels::Kernel& kernel) {
  if (r.host->table.usual == 0) return by_degree(r, kernel);
  const int entries = fewest_entries(r, kernel);
  if (entries == 0) return {};
  return with(r, kernel, entries);
}

/// True if a wider kernel is worth its width: it costs the same with a smaller table, or more with a table ten times smaller.
bool is_better(const Host& host, const HostKernel& wider, const HostKernel& found) {
  const bool as_cheap = host.taps_of(wider.kernel.width()) == host.taps_of(found.kernel.width());
  return wider.per_cell * (as_cheap ? 1 : 10) < found.per_cell;
}

}  // namespace

HostKernel choose_for_host(const HostRequest& r) {
  const Host& host = *r.host;
  const int first = std::max(host.min_width, r.family.min_width), last = std::min(host.max_width, r.family.max_width);
  if (first > last)
    throw std::invalid_argument("kernel " + r.family.name + " has no width that " + host.title + " takes; expected " +
                                std::to_string(host.min_width) + " to " + std::to_string(host.max_width));
  std::optional<HostKernel> found;
  HostKernel best;
  double best_error = INFINITY;
  for (int width = first; width <= last; ++width) {
    const kernels::Kernel kernel = r.family.make(width, 0.5 / r.padding);
    const std::optional<HostKernel> reached = reaching(r, kernel);
    if (found && !(reached && is_better(host, *reached, *found))) break;
    if (reached) {
      found = reached;
    } else if (const HostKernel k = finest(r, kernel); error_of(r, k) < best_error) {
      best = k;
      best_error = error_of(r, k);
    }
  }
  if (!found) out_of_reach(r, best, best_error);
  return *found;
}

}  // namespace misfit::tools
