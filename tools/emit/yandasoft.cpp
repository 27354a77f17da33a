#include <algorithm>
#include <cmath>
#include <complex>
#include <cstdlib>

#include "kernels/catalogue.h"
#include "kernels/sampled_function.h"
#include "tools/base/files.h"
#include "tools/emit/c_source.h"
#include "tools/emit/hosts.h"

namespace misfit::tools {
namespace {

int support_for(int width) {
  return std::max(3, (width + 1) / 2);
}

double entry_or_zero(const Eigen::VectorXd& table, long entry) {
  return entry < table.size() ? table[entry] : 0;
}

/// Row k: C at k/Ms + j for j = −s … s, divided by the sum of their magnitudes: the plane of fractions k and k' is the product
/// of rows k and k'. [Ms][2s+1]
Eigen::MatrixXd rows(const Eigen::VectorXd& table, int per_cell, int support) {
  Eigen::MatrixXd rows(per_cell, 2 * support + 1);
  for (int k = 0; k < per_cell; ++k) {
    for (int j = -support; j <= support; ++j)
      rows(k, j + support) = entry_or_zero(table, std::labs(static_cast<long>(j) * per_cell + k));
    rows.row(k) /= rows.row(k).cwiseAbs().sum();
  }
  return rows;
}

/// The cell that yandasoft takes for the nearest lies d in [0, 1) cells above the visibility; d is rounded to k/Ms, and k = Ms
/// is k = 0 of the cell below. In the terms of TapFunction, 2s + 2 cells with d = ½ − t.
kernels::TapFunction taps_of_rows(const Eigen::MatrixXd& rows) {
  return [rows](double t) {
    const auto per_cell = static_cast<long>(rows.rows());
    const long k = std::lround((0.5 - t) * static_cast<double>(per_cell));
    Eigen::VectorXd taps = Eigen::VectorXd::Zero(rows.cols() + 1);
    taps.segment(k == per_cell ? 0 : 1, rows.cols()) = rows.row(k % per_cell);
    return taps;
  };
}

/// SphFuncVisGridder with support 3, oversample 128, α = 1, without the filter of its correction.
HostRule stock_of_yandasoft(const HostKernel& k) {
  constexpr int per_cell = 128, support = 3;
  const kernels::Kernel own = kernels::kernel_family("spheroidal-exact-1").make(2 * support, k.x0());
  return {taps_of_rows(rows(kernels::sampled_to_both_ends(own.polynomial, per_cell), per_cell, support)), per_cell,
          kernels::relative_reciprocal_taper(own.polynomial)};
}

Eigen::MatrixXd rows_by_fraction(const HostKernel& k) {
  return rows(kernels::sampled_to_both_ends(k.kernel.polynomial, k.per_cell), k.per_cell, support_for(k.kernel.width()));
}

void write_yandasoft(const Emission& e, const std::string& path) {
  const int support = support_for(e.table.kernel.width()), per_cell = e.table.per_cell;
  const Eigen::MatrixXd by_fraction = rows_by_fraction(e.table).transpose();  // column-major: a fraction after the other
  write_file(
      path,
      c_header(e,
               {"To use it, in yandasoft's SphFuncVisGridder.cc:",
                "1. include this file; in initConvolutionFunction(), in place of bufx(ix) and bufy(iy):",
                "     itsConvFunc[plane](ix, iy) = misfit_planes[fracu * (2 * misfit_support + 1) + ix] *",
                "                                  misfit_planes[fracv * (2 * misfit_support + 1) + iy];",
                "   each of the oversample^2 planes, plane = fracu + oversample * fracv, then has the sum 1 already;",
                "2. in correctConvolution(), in place of grdsf(nux): val = misfit_divisor(0.5 * nux), and likewise for nuy;",
                "   set doFiltering = false and itsInterp = false, which are for the spheroidal function;",
                "3. in the parset: gridder.SphFunc.support = " + std::to_string(support) +
                    ", gridder.SphFunc.oversample = " + std::to_string(per_cell) + ", gridder.padding as above."},
               c_integer("support", support) + c_integer("oversample", per_cell) +
                   c_array("[fraction][tap], each fraction's taps divided by their sum; a plane is the product of two",
                           "planes", Eigen::Map<const Eigen::VectorXd>(by_fraction.data(), by_fraction.size())) +
                   c_divisor(e.divisor)));
}

}  // namespace

Host yandasoft_host() {
  Host host;
  host.name = "yandasoft";
  host.title = "yandasoft's SphFuncVisGridder";
  host.habit = "the nearest of oversample^2 planes, each divided by its sum, the image multiplied by 1 / what it is given";
  host.table = {128, 1024, false, false};
  host.bits = 24;
  host.taps_of = [](int width) { return 2 * support_for(width) + 1; };
  host.taps = [](const HostKernel& k) { return taps_of_rows(rows_by_fraction(k)); };
  host.bytes = [](const HostKernel& k) {
    const double cells = 2 * support_for(k.kernel.width()) + 1;
    return std::pow(k.per_cell * cells, 2) * sizeof(std::complex<float>);
  };
  host.stock = stock_of_yandasoft;
  host.stock_name = "its spheroidal function of support 3, oversample 128";
  host.write = write_yandasoft;
  return host;
}

}  // namespace misfit::tools
