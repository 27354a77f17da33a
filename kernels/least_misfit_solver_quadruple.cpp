#include "kernels/extended_precision_internal.h"
#include "kernels/least_misfit_solver_template_internal.h"

namespace misfit::kernels {

MisfitMinimum minimise_misfit_in_quadruple(const MisfitProblem& problem) {
  return Solver<Quadruple>(problem).minimise();
}

}  // namespace misfit::kernels
