#include "tools/emit/emission_plan.h"

#include <stdexcept>

#include "tools/emit/host_choice.h"

namespace misfit::tools {
namespace {

int interpolation_of(const EmitOptions& o, const Host& host) {
  constexpr int cubic = 3;
  if (o.interpolation >= 0) return o.interpolation;
  return host.table.interpolated ? cubic : 0;
}

/// x0 of the kernel: the one given, or the host's.
double x0_of(const EmitOptions& o, const Host& host) {
  if (o.x0 > 0) return o.x0;
  if (o.host_padding > 0) return 0.5 / o.host_padding;
  if (host.padding) return 0.5 / *host.padding;
  throw std::invalid_argument("--emit " + host.name + ": " + host.title + " can pad as one likes; expected --padding or --x0");
}

kernels::Kernel kernel_of(const EmitOptions& o, const Host& host, const kernels::KernelFamily& family) {
  const int width = o.width != 0 ? o.width : family.min_width;
  if (o.width == 0 && family.min_width != family.max_width)
    throw std::invalid_argument("--emit " + host.name + ": expected --width, or --target-error to choose it");
  const kernels::Kernel kernel = family.make(width, x0_of(o, host));
  if (host.table.usual > 0) return o.degree == -1 ? kernel : kernels::truncated(kernel, o.degree);
  const int most = host.degrees(width).second;
  return kernels::truncated(kernel, o.degree == -1 ? most : o.degree);
}

}  // namespace

Emission plan_emission(const EmitOptions& o, const kernels::KernelFamily& family) {
  const Host& host = find_host(o.host);
  HostKernel table;
  if (o.target_error > 0) {
    const double x0 = x0_of(o, host);
    const double padding = o.host_padding > 0 ? o.host_padding : host.padding.value_or(0.5 / x0);
    check_padding(host, x0, padding);
    table = choose_for_host({&host, family, o.target_error, padding, interpolation_of(o, host), o.image_size});
  } else {
    table.kernel = kernel_of(o, host, family);
    table.per_cell = o.per_cell != 0 ? o.per_cell : host.table.usual;
    table.interpolation = interpolation_of(o, host);
    table.padding = o.host_padding > 0 ? o.host_padding : host.padding.value_or(0.5 / table.kernel.x0);
    table.image_size = o.image_size;
  }
  if (!o.force) check_padding(host, table.kernel.x0, table.padding);
  return emission(host, table);
}

}  // namespace misfit::tools
