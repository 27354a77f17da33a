#include "tools/emit/hosts.h"

#include <stdexcept>

namespace misfit::tools {

const std::vector<Host>& host_catalogue() {
  static const std::vector<Host> hosts{casacore_host(),  wsclean_host(),  ducc_host(), finufft_host(),
                                       yandasoft_host(), c_header_host(), csv_host()};
  return hosts;
}

std::vector<std::string> host_names() {
  std::vector<std::string> names;
  for (const Host& host : host_catalogue()) names.push_back(host.name);
  return names;
}

const Host& find_host(const std::string& name) {
  for (const Host& host : host_catalogue())
    if (host.name == name) return host;
  std::string known;
  for (const Host& host : host_catalogue()) known += (known.empty() ? "" : ", ") + host.name;
  throw std::invalid_argument("--emit " + name + ": expected one of " + known);
}

}  // namespace misfit::tools
