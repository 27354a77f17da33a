#include <algorithm>
#include <numbers>

#include "kernels/families/spheroidal_exact.h"
#include "tools/base/files.h"
#include "tools/base/numbers.h"
#include "tools/emit/c_source.h"
#include "tools/emit/hosts.h"
#include "tools/emit/own_quadrature.h"

namespace misfit::tools {
namespace {

/// The degrees for which FINUFFT 2.6 compiles its evaluation: one less than its numbers of coefficients, from max(4, w − 4) to
/// min(19, w + 3).
std::pair<int, int> degrees(int width) {
  return {std::max(4, width - 4) - 1, std::min(19, width + 3) - 1};
}

/// The function scaled to phi(0) = 1, as FINUFFT's own is.
kernels::PiecewisePolynomial scaled(const kernels::PiecewisePolynomial& function) {
  const int width = function.width();
  const double top = function(width % 2 == 1 ? 0 : 0.5)[width / 2];
  return {function.coefficient / top};
}

std::string phi(int count) {
  return "/* phi(z) for -1 <= z <= 1, the function over its whole width */\n"
         "static inline double misfit_phi(double z) {\n"
         "  const double place = (z + 1) * (double)misfit_ns / 2;\n"
         "  const int cell = place >= (double)misfit_ns ? misfit_ns - 1 : place > 0 ? (int)place : 0;\n"
         "  const double within = 2 * (place - (double)cell) - 1;\n"
         "  double value = 0;\n"
         "  if (z < -1 || z > 1) return 0;\n"
         "  for (int k = 0; k < " +
         std::to_string(count) +
         "; ++k) value = value * within + misfit_horner[k * misfit_ns + cell];\n"
         "  return value;\n"
         "}\n\n";
}

void write_finufft(const Emission& e, const std::string& path) {
  const kernels::PiecewisePolynomial function = scaled(e.table.kernel.polynomial);
  const TaperNodes nodes = taper_nodes(function);
  const int count = std::max(function.degree(), degrees(function.width()).first) + 1;
  const std::string w = std::to_string(function.width()), padding = significant(e.table.padding, 6);
  write_file(
      path,
      c_header(
          e,
          {"To use it, in FINUFFT (2.6):",
           "1. src/common/kernel.cpp: include this file; in kernel_definition_lambda() return misfit_phi where",
           "   spopts.nspread == " + w + " and spopts.upsampfac == " + padding + ";",
           "2. include/finufft/makeplan.hpp, precompute_horner_coeffs(): for this nspread and upsampfac, after the panels,",
           "   m.nc = nc_fit, or coefficients are left out that are small only against the tolerance;",
           "3. onedim_fseries_kernel(): for this nspread and upsampfac take q = misfit_nodes, z[n] = misfit_z[n] without",
           "   the factor J2, and f[n] = misfit_f[n]; gaussquad's take the function for smooth, and it jumps between cells;",
           "4. plan with opts.upsampfac = " + padding + " and the tolerance for which theoretical_kernel_ns() gives " + w + ".",
           "Types 1 and 2. Type 3 takes the transform of its own function from a formula (pswf_selfft_params)."},
          c_integer("ns", function.width()) + c_integer("nc", count) + c_integer("nodes", static_cast<int>(nodes.u.size())) +
              c_array("[coefficient][panel], the highest power of 2 x1 + ns - 1 first", "horner",
                      horner_coefficients(function, count - 1)) +
              phi(count) + c_array("quadrature nodes of the half support, in cells", "z", nodes.u) +
              c_array("weight times phi; f[n] is counted twice by 2 real(aj)", "f", nodes.weight / 2)));
}

/// FINUFFT's prolate function, bandwidth π w (1 − 1/(2σ)) − 0.05 (kerformula 8).
HostRule stock_of_finufft(const HostKernel& k) {
  const int width = k.kernel.width();
  const double bandwidth = std::numbers::pi * width * (1 - 0.5 / k.padding) - 0.05;
  const kernels::Kernel own = kernels::make_kernel("prolate", k.x0(), kernels::spheroidal_exact_taps(width, 0, bandwidth));
  const kernels::Kernel held = kernels::truncated(own, degrees(width).second);
  return {held.polynomial, 0, kernels::reciprocal_taper(held.polynomial)};
}

}  // namespace

Host finufft_host() {
  Host host;
  host.name = "finufft";
  host.title = "FINUFFT";
  host.habit = "polynomials fitted to the function in its cells, no normalisation, modes divided by the function's transform";
  host.min_padding = 1.15;
  host.max_padding = 2.5;
  host.min_width = 2;
  host.max_width = 16;
  host.degrees = degrees;
  host.taps_of = [](int width) { return width; };
  host.taps = [](const HostKernel& k) { return kernels::TapFunction(k.kernel.polynomial); };
  host.given_correction = [](const HostKernel& k) { return kernels::reciprocal_taper(k.kernel.polynomial); };
  host.own_correction = [](const HostKernel& k) {
    return whole_support_correction(k.kernel.polynomial, static_cast<int>(2 + 3.0 * k.kernel.width() / 2));
  };
  host.stock = stock_of_finufft;
  host.stock_name = "its prolate function of the same width";
  host.write = write_finufft;
  return host;
}

}  // namespace misfit::tools
