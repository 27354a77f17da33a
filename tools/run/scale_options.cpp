#include "tools/run/scale_options.h"

#include <CLI/CLI.hpp>
#include <stdexcept>
#include <string>

#include "tools/base/option_checks.h"

namespace misfit::tools {
namespace {

constexpr int most_nodes = 1 << 20;

}  // namespace

void declare(CLI::App& command, ScaleOptions& o) {
  mark(command.add_option("--nodes", o.nodes,
                          "With --dry-run: print how long the run would take on up to this many machines like this one, each "
                          "with --threads and --memory, and from which number on more do not help"),
       OptionMark::free_of_state);
  mark(command.add_option(
           "--visibilities", o.visibilities,
           "With --nodes: assume that the data have this many samples, such as 1e12; 0 means as many as they have"),
       OptionMark::free_of_state);
  mark(command.add_option("--network", o.network_gb_s,
                          "With --nodes: speed of the network between machines in GB/s; 0 means 12.5, a network of 100 Gbit/s"),
       OptionMark::free_of_state);
}

void check(const ScaleOptions& o, bool dry_run) {
  if (!(o.nodes >= 0 && o.nodes <= most_nodes))
    refuse_option("nodes", std::to_string(o.nodes), "0 (none) to " + std::to_string(most_nodes) + " machines");
  if (o.nodes > 0 && !dry_run)
    refuse_option("nodes", std::to_string(o.nodes), "--dry-run beside it; mpirun -n starts runs of several processes");
  if (o.visibilities != 0 && !(o.visibilities >= 1 && o.visibilities <= 1e18))
    refuse_option("visibilities", typed(o.visibilities), "0 (those of the data), or 1 to 1e18");
  if (o.visibilities > 0 && o.nodes == 0) refuse_option("visibilities", typed(o.visibilities), "--nodes beside it");
  if (o.network_gb_s != 0 && !(o.network_gb_s >= 1e-3 && o.network_gb_s <= 1e6))
    refuse_option("network", typed(o.network_gb_s), "0.001 to 1e6, in GB/s");
  if (o.network_gb_s != 0 && o.nodes == 0) refuse_option("network", typed(o.network_gb_s), "--nodes beside it");
}

void check(const ScaleOptions& o, const imager::Ranks& ranks) {
  if (o.nodes > 0 && !ranks.alone())
    refuse_option("nodes", std::to_string(o.nodes),
                  "one process; this run has " + std::to_string(ranks.size()) + ", which plan for themselves");
}

}  // namespace misfit::tools
