#include "tools/emit/emission.h"

#include <cmath>
#include <stdexcept>

#include "tools/base/numbers.h"

namespace misfit::tools {
namespace {

void expect(bool good, const Host& host, const std::string& has, const std::string& expected) {
  if (!good) throw std::invalid_argument("--emit " + host.name + ": " + has + "; expected " + expected);
}

std::string range(int least, int most) {
  return std::to_string(least) + " to " + std::to_string(most);
}

void check(const Host& host, const HostKernel& k) {
  expect(k.kernel.width() >= host.min_width && k.kernel.width() <= host.max_width, host,
         "a width of " + std::to_string(k.kernel.width()),
         host.title + "'s " + range(host.min_width, host.max_width) + host.otherwise);
  expect(k.padding >= host.min_padding && k.padding <= host.max_padding, host, "a padding of " + significant(k.padding, 6),
         host.title + "'s " + significant(host.min_padding, 4) + " to " + significant(host.max_padding, 4));
  if (host.table.usual == 0) {
    expect(k.per_cell == 0, host, std::to_string(k.per_cell) + " entries a cell",
           "no --sampling, since " + host.title + " evaluates polynomials");
    const auto [least, most] = host.degrees(k.kernel.width());
    expect(k.kernel.polynomial.degree() <= most, host, "polynomials of degree " + std::to_string(k.kernel.polynomial.degree()),
           host.title + "'s " + range(least, most) + " at this width");
    return;
  }
  expect(k.per_cell > k.interpolation && k.per_cell <= host.table.most, host, std::to_string(k.per_cell) + " entries a cell",
         range(k.interpolation + 1, host.table.most));
  expect(!host.table.odd || k.per_cell % 2 == 1, host, std::to_string(k.per_cell) + " entries a cell",
         "an odd number: with an even one " + host.title + " is half an entry off");
  expect(host.table.interpolated || k.interpolation == 0, host, "interpolation of degree " + std::to_string(k.interpolation),
         "0, since " + host.title + " takes the nearest entry");
}

double rounding_in(const Host& host, const HostKernel& k) {
  return rounding(k.kernel.polynomial, k.x0(), host.bits);
}

std::string errs(double error) {
  return significant(error, 3);
}

}  // namespace

void check_padding(const Host& host, double x0, double padding) {
  const double product = 2 * x0 * padding;
  if (std::abs(product - 1) <= 1e-3) return;
  throw std::invalid_argument("--emit " + host.name + ": the kernel is made for x0 = " + significant(x0, 5) +
                              ", a padding of " + significant(0.5 / x0, 5) + ", and " + host.title + " pads by " +
                              significant(padding, 5) + "; expected --padding " + significant(padding, 5) +
                              ", or --host-padding for a host that is told to pad otherwise, or --force");
}

RealisedError realised_in(const Host& host, const HostKernel& table) {
  check(host, table);
  const kernels::Correction given = host.given_correction ? host.given_correction(table) : kernels::Correction();
  return with_rounding(realised_error({host.taps(table), table.per_cell, given}, table.x0()), rounding_in(host, table));
}

Emission emission(const Host& host, const HostKernel& table) {
  Emission e;
  e.realised = realised_in(host, table);
  const kernels::TapFunction taps = host.taps(table);
  const int steps = table.per_cell;
  const double x0 = table.x0();
  e.host = &host;
  e.table = table;
  e.divisor = divisor_series([&](const Eigen::VectorXd& x) { return kernels::optimal_correction(taps, x, steps); }, x0);
  e.rounding = rounding_in(host, table);
  if (host.own_correction) e.own = realised_error({taps, steps, host.own_correction(table)}, x0);
  if (host.stock) e.stock = realised_error(host.stock(table), x0);
  e.function = realised_error({table.kernel.polynomial, 0, {}}, x0);
  return e;
}

std::vector<std::string> statement(const Emission& e) {
  const HostKernel& k = e.table;
  const Host& host = *e.host;
  const auto line = [](const std::string& item, const std::string& text) {
    return item + std::string(item.size() < 14 ? 14 - item.size() : 1, ' ') + text;
  };
  const std::string holds = k.per_cell > 0
                                ? std::to_string(k.per_cell) + " entries a cell" +
                                      (k.interpolation > 0 ? ", read to degree " + std::to_string(k.interpolation) : "")
                                : "polynomials of degree " + std::to_string(k.kernel.polynomial.degree());
  std::vector<std::string> lines{k.kernel.name + ", width " + std::to_string(k.kernel.width()) + ", x0 " +
                                     significant(k.kernel.x0, 6) + ", " + holds + ", for " + host.title,
                                 line("which has", host.habit), line("padding", significant(k.padding, 6)),
                                 line("it will err", "by " + errs(e.realised.rms) + " RMS, " + errs(e.realised.largest) +
                                                         " at most for one visibility and one pixel (two axes, random phases)"),
                                 line("the function", "by " + errs(e.function.rms) + " without what the host adds")};
  if (host.bytes) lines.push_back(line("its table", "takes " + significant(host.bytes(k) / 1e6, 2) + " MB in the host"));
  if (e.rounding > 0.1 * e.realised.rms)
    lines.push_back(line("rounding", "is about " + errs(e.rounding) + " of it: " + std::to_string(host.bits) +
                                         " bits, magnified by the correction"));
  if (k.kernel.misfit.mean > 1.01 * k.kernel.origin.mean_error)
    lines.push_back(line("as solved", "by " + errs(std::sqrt(2 * k.kernel.origin.mean_error)) +
                                          " before its polynomials were cut to degree " +
                                          std::to_string(k.kernel.polynomial.degree())));
  if (e.own)
    lines.push_back(line("left alone", "by " + errs(e.own->rms) + " with the correction that the host works out itself" +
                                           (host.depends_on_pixels ? ", " + std::to_string(k.image_size) + " pixels" : "")));
  if (e.stock) lines.push_back(line("without this", "by " + errs(e.stock->rms) + ", " + host.stock_name));
  if (k.per_cell > 0 && e.stock && e.realised.rms > 0.5 * e.stock->rms)
    lines.push_back(line("no gain", "with so few entries a cell; --sampling sets more"));
  return lines;
}

}  // namespace misfit::tools
