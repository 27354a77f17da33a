#include "tools/base/files.h"
#include "tools/emit/c_source.h"
#include "tools/emit/hosts.h"

namespace misfit::tools {
namespace {

void write_c_header(const Emission& e, const std::string& path) {
  const kernels::PiecewisePolynomial& function = e.table.kernel.polynomial;
  const Eigen::MatrixXd by_cell = function.coefficient;  // column-major: a cell after the other
  const std::string count = std::to_string(function.degree() + 1);
  write_file(
      path,
      c_header(
          e,
          {"To use it: a visibility at u (in cells of the FFT's grid) touches the W cells from first = ceil(u - W / 2.0) on;",
           "cell first + r takes misfit_taps' out[r] of t = u - first - (W - 1) / 2.0, which lies in [-1/2, 1/2]. The image is",
           "divided by misfit_divisor along each axis. For prediction, divide the model first and sum the same taps."},
          c_integer("W", function.width()) + c_integer("degree", function.degree()) +
              c_array("[cell][power of t, ascending]", "coefficients",
                      Eigen::Map<const Eigen::VectorXd>(by_cell.data(), by_cell.size())) +
              "static inline void misfit_taps(double t, double out[misfit_W]) {\n"
              "  for (int r = 0; r < misfit_W; ++r) {\n"
              "    out[r] = 0;\n"
              "    for (int d = misfit_degree; d >= 0; --d) out[r] = out[r] * t + misfit_coefficients[r * " +
              count +
              " + d];\n"
              "  }\n"
              "}\n\n" +
              c_divisor(e.divisor)));
}

}  // namespace

Host c_header_host() {
  Host host;
  host.name = "c-header";
  host.title = "a program of C or C++";
  host.habit = "polynomials of its cells in double precision, the image divided by what it is given";
  host.degrees = [](int) { return std::pair(0, kernels::highest_degree); };
  host.taps_of = [](int width) { return width; };
  host.taps = [](const HostKernel& k) { return kernels::TapFunction(k.kernel.polynomial); };
  host.write = write_c_header;
  return host;
}

}  // namespace misfit::tools
