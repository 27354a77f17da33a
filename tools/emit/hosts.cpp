#include "tools/emit/hosts.h"

#include <stdexcept>

namespace misfit::tools {

const std::vector<Host>& host_catalogue() {
  static const std::vector<Host> hosts{casacore_host(),  wsclean_host(),  ducc_host(), finufft_host(),
                                       yandasoft_host(), c_header_host(), csv_host()};
  return hosts;
}

std::string host_names() {
  std::string names;
  for (const Host& host : host_catalogue()) names += (names.empty() ? "" : ", ") + host.name;
  return names;
}

const Host& find_host(const std::string& name) {
  for (const Host& host : host_catalogue())
    if (host.name == name) return host;
  throw std::invalid_argument("--emit " + name + ": expected one of " + host_names());
}

}  // namespace misfit::tools
