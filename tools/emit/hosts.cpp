#include "tools/emit/hosts.h"

#include <stdexcept>

namespace misfit::tools {

const std::vector<Host>& host_catalogue() {
  static const std::vector<Host> hosts{casacore_host(),  wsclean_host(),  ducc_host(), finufft_host(),
                                       yandasoft_host(), c_header_host(), csv_host()};
  return hosts;
}

const Host& find_host(const std::string& name) {
  std::string known;
  for (const Host& host : host_catalogue()) {
    if (host.name == name) return host;
    known += (known.empty() ? "" : ", ") + host.name;
  }
  throw std::invalid_argument("--emit " + name + ": expected one of " + known);
}

}  // namespace misfit::tools
