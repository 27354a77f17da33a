#include "tools/emit/c_source.h"

#include <algorithm>
#include <cmath>

#include "kernels/quadrature.h"
#include "tools/base/numbers.h"

namespace misfit::tools {
namespace {

std::string upper(std::string name) {
  for (char& c : name) c = c == '-' ? '_' : static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return name;
}

}  // namespace

std::string c_comment(const std::vector<std::string>& lines) {
  std::string text = "/*\n";
  for (const std::string& line : lines) text += line.empty() ? " *\n" : " * " + line + "\n";
  return text + " */\n";
}

std::string c_array(const std::string& comment, const std::string& name, const Eigen::VectorXd& values) {
  constexpr Eigen::Index a_line = 4;
  std::string text =
      "/* " + comment + " */\nstatic const double misfit_" + name + "[" + std::to_string(values.size()) + "] = {";
  for (Eigen::Index i = 0; i < values.size(); ++i)
    text += (i % a_line == 0 ? "\n  " : " ") + all_digits(values[i]) + (i + 1 < values.size() ? "," : "");
  return text + "};\n\n";
}

std::string c_integer(const std::string& name, int value) {
  return "enum { misfit_" + name + " = " + std::to_string(value) + " };\n";
}

std::string c_divisor(const DivisorSeries& divisor) {
  return c_array("a Chebyshev series in 2 (x / x0)^2 - 1", "divisor_series", divisor.coefficient) +
         "/* What the image is divided by along an axis; x = (pixel - centre) / FFT size. Beyond x0, where the image\n"
         "   is thrown away, its value at x0. */\n"
         "static inline double misfit_divisor(double x) {\n"
         "  const double x0 = " +
         all_digits(divisor.x0) +
         ";\n"
         "  const double part = (x < 0 ? -x : x) < x0 ? x / x0 : 1;\n"
         "  const double y = 2 * part * part - 1;\n"
         "  double next = 0, after = 0;\n"
         "  for (int k = " +
         std::to_string(divisor.coefficient.size() - 1) +
         "; k > 0; --k) {\n"
         "    const double sum = misfit_divisor_series[k] + 2 * y * next - after;\n"
         "    after = next;\n"
         "    next = sum;\n"
         "  }\n"
         "  return misfit_divisor_series[0] + y * next - after;\n"
         "}\n\n";
}

std::string c_header(const Emission& emission, const std::vector<std::string>& steps, const std::string& body) {
  std::vector<std::string> lines = statement(emission);
  lines.emplace_back();
  lines.insert(lines.end(), steps.begin(), steps.end());
  const std::string guard = "MISFIT_KERNEL_" + upper(emission.host->name) + "_H";
  return c_comment(lines) + "#ifndef " + guard + "\n#define " + guard + "\n\n" + body + "#endif\n";
}

TaperNodes taper_nodes(const kernels::PiecewisePolynomial& function) {
  constexpr int points = 12;  // to 1e-16 for a polynomial of degree 13 times half a turn
  const int width = function.width(), cells = (width + 1) / 2;
  TaperNodes nodes{Eigen::VectorXd(cells * points), Eigen::VectorXd(cells * points)};
  for (int k = 0; k < cells; ++k) {
    const int r = width - 1 - k;  // from the outermost cell inwards; of an odd width's middle one, the half above 0
    const double centre = r - (width - 1) / 2.0;
    const kernels::Quadrature rule = kernels::gauss_legendre(points, std::max(centre - 0.5, 0.0), centre + 0.5);
    for (int i = 0; i < points; ++i) {
      nodes.u[k * points + i] = rule.node[i];
      nodes.weight[k * points + i] = 2 * rule.weight[i] * function(centre - rule.node[i])[r];
    }
  }
  return nodes;
}

Eigen::VectorXd horner_coefficients(const kernels::PiecewisePolynomial& function, int least_degree) {
  const int degree = std::max(function.degree(), least_degree), width = function.width();
  Eigen::VectorXd flat = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(degree + 1) * width);
  for (int d = 0; d <= function.degree(); ++d)
    flat.segment(static_cast<Eigen::Index>(degree - d) * width, width) = function.coefficient.row(d) * std::pow(-0.5, d);
  return flat;
}

}  // namespace misfit::tools
