#include <cmath>

#include "tools/base/files.h"
#include "tools/base/numbers.h"
#include "tools/emit/c_source.h"
#include "tools/emit/hosts.h"
#include "tools/emit/own_quadrature.h"

namespace misfit::tools {
namespace {

/// The degree of ducc0's TemplateKernel<W>. Lower degrees are filled up with zeros here, since TemplateKernel clears one row
/// only.
int degree_of(int width) {
  return width + 3 + width % 2;
}

void write_ducc(const Emission& e, const std::string& path) {
  const kernels::PiecewisePolynomial& function = e.table.kernel.polynomial;
  const TaperNodes nodes = taper_nodes(function);
  const std::string w = std::to_string(function.width());
  const int degree = degree_of(function.width());
  const std::string padding = significant(e.table.padding, 6);
  write_file(
      path,
      c_header(
          e,
          {"To use it, in ducc0's src/ducc0/math/gridding_kernel.h and .cc:",
           "1. include this file; give PolynomialKernel a constructor (W, D, coeff, corr) that stores what it is given, and",
           "   KernelCorrection one (x, wgtpsi, supp) likewise;",
           "2. at the end of KernelDB add {" + w + ", " + padding + ", " + significant(e.realised.rms, 3) +
               ", 0, 0, 2, false} and {" + w + ", " + padding + ", " + significant(e.realised.rms * std::sqrt(1.5), 3) +
               ", 0, 0, 3, false},",
           "   the second for do_wgridding, where w is a third axis; W <= 8 with true in place of false for single precision;",
           "3. in selectKernel(idx), for that entry, return PolynomialKernel(misfit_W, misfit_D, {misfit_coeff...},",
           "   KernelCorrection({misfit_corr_x...}, {misfit_corr_wgtpsi...}, misfit_W)).",
           "Its own GLFullCorrection would take the function for smooth where it jumps between cells.",
           "Call ducc0 with sigma_min = sigma_max = " + padding +
               ", since among kernels of equal width it takes the smallest padding.",
           "The epsilons above are RMS errors; ducc0's own are some 2.4 times those of its functions."},
          c_integer("W", function.width()) + c_integer("D", degree) +
              c_array("[power][cell], the highest power of z = 2 (xrel - cell) - 1 first", "coeff",
                      horner_coefficients(function, degree)) +
              c_array("in units of W/2", "corr_x", nodes.u * 2 / function.width()) +
              c_array("weight times function: corfunc(v) = 1 / sum wgtpsi cos(pi W x v)", "corr_wgtpsi", nodes.weight)));
}

}  // namespace

Host ducc_host() {
  Host host;
  host.name = "ducc";
  host.title = "ducc0's wgridder";
  host.habit = "polynomials of its cells, no normalisation, the image multiplied by 1 / the function's transform";
  host.min_padding = 1.1;
  host.max_padding = 2.6;
  host.min_width = 4;
  host.max_width = 16;
  host.degrees = [](int width) { return std::pair(0, degree_of(width)); };
  host.taps_of = [](int width) { return width; };
  host.taps = [](const HostKernel& k) { return kernels::TapFunction(k.kernel.polynomial); };
  host.given_correction = [](const HostKernel& k) { return kernels::reciprocal_taper(k.kernel.polynomial); };
  host.own_correction = [](const HostKernel& k) {
    return whole_support_correction(k.kernel.polynomial, 3 * k.kernel.width() / 2 + 2);
  };
  host.write = write_ducc;
  return host;
}

}  // namespace misfit::tools
