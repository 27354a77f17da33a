#include <algorithm>

#include "kernels/catalogue.h"
#include "kernels/kernel_table.h"
#include "tools/emit/emission.h"
#include "tools/emit/hosts.h"
#include "tools/hosts/casacore_table.h"

namespace misfit::tools {
namespace {

/// Schwab's function, with the image divided by its own transform, as in ConvolveGridder("SF").
HostRule stock_of_casacore(const HostKernel& k) {
  constexpr int per_cell = 100, width = 6;
  const kernels::Kernel own = kernels::kernel_family("spheroidal").make(width, k.x0());
  return {hosts::casacore_taps(hosts::casacore_table(own.polynomial, per_cell), per_cell), per_cell,
          kernels::relative_reciprocal_taper(own.polynomial)};
}

/// Lines broken at blanks so that a header's COMMENT holds each.
std::vector<std::string> wrapped(const std::vector<std::string>& lines) {
  constexpr std::size_t longest = 70;
  std::vector<std::string> found;
  for (std::string line : lines) {
    while (line.size() > longest) {
      const std::size_t blank = std::min(line.rfind(' ', longest), longest);
      found.push_back(line.substr(0, blank));
      line = "  " + line.substr(blank + (blank < longest ? 1 : 0));
    }
    found.push_back(line);
  }
  return found;
}

kernels::HostTable table_of(const Emission& e) {
  const Eigen::VectorXd table = hosts::casacore_table(e.table.kernel.polynomial, e.table.per_cell);
  std::vector<std::string> comments = wrapped(statement(e));
  comments.emplace_back("CFUNCTION is casacore's cFunction(): entry i at |u| = i / cSampling().");
  comments.emplace_back("misfit::hosts::ConvolveGridderTable takes this file, and");
  comments.emplace_back("misfit::hosts::CasacoreGridder its POLY, without the table's error.");
  return {"CASACORE", {{"CFUNCTION", table}}, comments};
}

kernels::HostTable divisor_of(const Emission& e) {
  constexpr int rows = 1025;
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(rows, 0, e.divisor.x0);
  return {"CASACORR",
          {{"X", x}, {"DIVISOR", x.unaryExpr([&](double at) { return e.divisor(at); })}},
          {"What correctionFactor1D(loc, len) is to return at",
           "X = |loc - len / 2| / len: 1/h for the taps divided by their sum."}};
}

void write_casacore(const Emission& e, const std::string& path) {
  kernels::write_kernel_table(e.table.kernel, kernels::TableSampling{e.table.per_cell, 0}, path, {table_of(e), divisor_of(e)});
}

}  // namespace

Host casacore_host() {
  Host host;
  host.name = "casacore";
  host.title = "casacore's ConvolveGridder";
  host.habit =
      "the nearest entry of the table, each visibility's taps divided by their sum, the image divided by what it is given";
  host.padding = 1.2;
  host.max_width = 7;
  host.table = {100000, kernels::kernel_table_max_per_cell, false, false};
  host.bits = 24;
  host.taps_of = [](int) { return 7; };
  host.taps = [](const HostKernel& k) {
    return hosts::casacore_taps(hosts::casacore_table(k.kernel.polynomial, k.per_cell), k.per_cell);
  };
  host.bytes = [](const HostKernel& k) { return (hosts::casacore_support + 1.0) * k.per_cell * sizeof(double); };
  host.otherwise = "; CasacoreGridder takes wider functions, from a file made by --width and --padding without --emit";
  host.stock = stock_of_casacore;
  host.stock_name = "its spheroidal function, 100 entries a cell";
  host.write = write_casacore;
  return host;
}

}  // namespace misfit::tools
