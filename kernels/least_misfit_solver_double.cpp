#include "kernels/least_misfit_solver_template_internal.h"

namespace misfit::kernels {

MisfitMinimum minimise_misfit_in_double(const MisfitProblem& problem) {
  return Solver<double>(problem).minimise();
}

MisfitNodes misfit_nodes(int nodes, double x0) {
  const NodesOf<double> found(nodes, x0);
  return {found.x, found.weight};
}

}  // namespace misfit::kernels
