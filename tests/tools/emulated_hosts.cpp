#include "tests/tools/emulated_hosts.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <complex>
#include <cstdlib>
#include <numbers>
#include <random>
#include <sstream>

#include "kernels/quadrature.h"

namespace misfit::tools::testing {
namespace {

using std::numbers::pi;
using Numbers = std::vector<double>;

/// A header's integers and arrays.
class HeaderFile {
 public:
  explicit HeaderFile(std::string text) : text_(std::move(text)) {}
  long integer(const std::string& name) const { return std::atol(after("enum { misfit_" + name + " = ")); }
  Numbers array(const std::string& name) const {
    const std::string body(after("double misfit_" + name + "["));
    const std::size_t begin = body.find('{'), end = body.find('}');
    std::istringstream list(body.substr(begin + 1, end - begin - 1));
    Numbers values;
    for (std::string item; std::getline(list, item, ',');) values.push_back(std::stod(item));
    BOOST_REQUIRE(values.size() == std::stoul(body));
    return values;
  }
  double divisor(double x) const { return chebyshev(array("divisor_series"), std::strtod(after("double x0 = "), nullptr), x); }

 private:
  const char* after(const std::string& key) const {
    const std::size_t at = text_.find(key);
    BOOST_REQUIRE_MESSAGE(at != std::string::npos, key);
    return text_.c_str() + at + key.size();
  }
  /// Σ a_k cos(k arccos y)
  static double chebyshev(const Numbers& a, double x0, double x) {
    const double part = std::min(std::abs(x) / x0, 1.0), angle = std::acos(2 * part * part - 1);
    double sum = 0;
    for (std::size_t k = 0; k < a.size(); ++k) sum += a[k] * std::cos(static_cast<double>(k) * angle);
    return sum;
  }
  std::string text_;
};

std::function<double(long, long)> file_divisor(const HeaderFile& file) {
  return [file](long pixel, long size) { return file.divisor(static_cast<double>(pixel) / static_cast<double>(size)); };
}

/// Horner's rule over `width` cells at once, the highest power first: the value in `cell`.
double horner(const Numbers& coefficients, std::size_t width, std::size_t cell, double z) {
  double value = 0;
  for (std::size_t at = cell; at < coefficients.size(); at += width) value = value * z + coefficients[at];
  return value;
}

/// WSClean 3.1's w-stacking gridder.
EmulatedHost wsclean(const std::string& content) {
  const HeaderFile file(content);
  const long taps = file.integer("kernel_size"), sampling = file.integer("oversampling");
  const Numbers table = file.array("kernel");
  BOOST_REQUIRE(static_cast<long>(table.size()) == taps * sampling);
  std::vector<Numbers> kernels(static_cast<std::size_t>(sampling));
  for (long i = 0; i < sampling; ++i)
    for (long x = 0; x < taps; ++x)
      kernels[static_cast<std::size_t>(sampling - i - 1)].push_back(table[static_cast<std::size_t>(x * sampling + i)]);
  const auto gridded = [=](double u) {
    const long x = std::lround(u);
    long index = std::lround((u - static_cast<double>(x)) * static_cast<double>(sampling));
    index = (index + sampling * 3 / 2) % sampling;
    std::vector<Tap> found;
    for (long i = 0; i < taps; ++i)
      found.emplace_back(x + i - taps / 2, kernels[static_cast<std::size_t>(index)][static_cast<std::size_t>(i)]);
    return found;
  };
  // FFTW's REDFT01 of size·sampling/2 values, the table from its middle on and zeros.
  const auto dct = [=](long pixel, long size) {
    const double values = static_cast<double>(size * sampling) / 2;
    const auto k = static_cast<double>(std::abs(pixel));
    const std::size_t middle = table.size() / 2;
    double sum = table[middle];
    for (std::size_t j = 1; middle + j < table.size(); ++j)
      sum += 2 * table[middle + j] * std::cos(pi * static_cast<double>(j) * (k + 0.5) / values);
    return sum / static_cast<double>(sampling);
  };
  return {gridded, file_divisor(file), dct};
}

/// ducc0's PolynomialKernel: x in [−1, 1] is the support, divided into W cells.
EmulatedHost ducc(const std::string& content) {
  const HeaderFile file(content);
  const auto width = static_cast<std::size_t>(file.integer("W"));
  const Numbers coefficients = file.array("coeff"), nodes = file.array("corr_x"), weights = file.array("corr_wgtpsi");
  BOOST_REQUIRE(coefficients.size() == width * static_cast<std::size_t>(file.integer("D") + 1));
  const double w = static_cast<double>(width);
  const auto eval = [=](double x) {
    const double place = w * 0.5 * (x + 1);
    const std::size_t cell = std::min(static_cast<std::size_t>(place), width - 1);
    return horner(coefficients, width, cell, (place - static_cast<double>(cell) - 0.5) * 2);
  };
  // TemplateKernel::eval1: rows by turns, in even and odd powers, of the first half of the cells; the others by symmetry.
  const auto degree = static_cast<std::size_t>(file.integer("D"));
  BOOST_REQUIRE(degree == width + 3 + width % 2);  // TemplateKernel clears no more than one row above a lower one
  const auto gridded = [=](double u) {
    const auto first = static_cast<long>(std::ceil(u - w / 2));
    const double x = (static_cast<double>(first) - u) * 2 + w - 1;
    Numbers values(width);
    for (std::size_t cell = 0; cell <= (width - 1) / 2; ++cell) {
      double odd = 0, even = 0;
      for (std::size_t j = 0; j <= degree; j += 2) {
        odd = odd * x * x + coefficients[j * width + cell];
        even = even * x * x + coefficients[(j + 1) * width + cell];
      }
      values[cell] = odd * x + even;
      values[width - 1 - cell] = even - odd * x;
      if (2 * cell + 1 == width) values[cell] = odd * x + even;
    }
    std::vector<Tap> found;
    for (std::size_t r = 0; r < width; ++r) found.emplace_back(first + static_cast<long>(r), values[r]);
    return found;
  };
  const auto corrected = [w](const Numbers& x, const Numbers& weight, long pixel, long size) {
    double sum = 0;
    for (std::size_t i = 0; i < x.size(); ++i)
      sum += weight[i] * std::cos(pi * w * x[i] * static_cast<double>(pixel) / static_cast<double>(size));
    return sum;
  };
  Numbers own_nodes, own_weights;  // GLFullCorrection
  const kernels::Quadrature rule = kernels::gauss_legendre(2 * (static_cast<int>(1.5 * w) + 2), -1, 1);
  for (Eigen::Index i = 0; i < rule.node.size(); ++i) {
    own_nodes.push_back(rule.node[i]);
    own_weights.push_back(rule.weight[i] * eval(rule.node[i]) * w / 2);
  }
  return {gridded, [=](long pixel, long size) { return corrected(nodes, weights, pixel, size); },
          [=](long pixel, long size) { return corrected(own_nodes, own_weights, pixel, size); }};
}

/// FINUFFT 2.6: spread_subproblem and onedim_fseries_kernel.
EmulatedHost finufft(const std::string& content) {
  const HeaderFile file(content);
  const auto ns = static_cast<std::size_t>(file.integer("ns"));
  const Numbers coefficients = file.array("horner"), nodes = file.array("z"), values = file.array("f");
  BOOST_REQUIRE(coefficients.size() == ns * static_cast<std::size_t>(file.integer("nc")));
  BOOST_REQUIRE(nodes.size() <= 100);  // MAX_NQUAD
  const double w = static_cast<double>(ns);
  const auto gridded = [=](double u) {
    const auto first = static_cast<long>(std::ceil(u - w / 2));
    const double x1 = static_cast<double>(first) - u;
    std::vector<Tap> found;
    for (std::size_t j = 0; j < ns; ++j)
      found.emplace_back(first + static_cast<long>(j), horner(coefficients, ns, j, 2 * x1 + w - 1));
    return found;
  };
  const auto series = [](const Numbers& z, const Numbers& f, long pixel, long size) {
    double sum = 0;
    for (std::size_t n = 0; n < z.size(); ++n)
      sum += 2 * f[n] * std::cos(2 * pi * z[n] * static_cast<double>(pixel) / static_cast<double>(size));
    return sum;
  };
  Numbers own_nodes, own_values;
  const int q = static_cast<int>(2 + 3.0 * w / 2);
  const kernels::Quadrature rule = kernels::gauss_legendre(2 * q, -w / 2, w / 2);
  for (Eigen::Index i = q; i < rule.node.size(); ++i) {
    const auto panel = std::min(static_cast<std::size_t>(rule.node[i] + w / 2), ns - 1);
    own_nodes.push_back(rule.node[i]);
    own_values.push_back(rule.weight[i] *
                         horner(coefficients, ns, panel, 2 * (rule.node[i] + w / 2 - static_cast<double>(panel)) - 1));
  }
  return {gridded, [=](long pixel, long size) { return series(nodes, values, pixel, size); },
          [=](long pixel, long size) { return series(own_nodes, own_values, pixel, size); }};
}

/// yandasoft's TableVisGridder.
EmulatedHost yandasoft(const std::string& content) {
  const HeaderFile file(content);
  const long support = file.integer("support"), sampling = file.integer("oversample"), taps = 2 * support + 1;
  const Numbers planes = file.array("planes");
  BOOST_REQUIRE(static_cast<long>(planes.size()) == sampling * taps);
  const auto gridded = [=](double u) {
    long cell = std::lround(u);
    long fraction = std::lround(static_cast<double>(sampling) * (static_cast<double>(cell) - u));
    if (fraction < 0) {
      cell += 1;
      fraction += sampling;
    } else if (fraction >= sampling) {
      cell -= 1;
      fraction -= sampling;
    }
    std::vector<Tap> found;
    for (long i = 0; i < taps; ++i)
      found.emplace_back(cell + i - support, planes[static_cast<std::size_t>(fraction * taps + i)]);
    return found;
  };
  return {gridded, file_divisor(file), {}};
}

EmulatedHost c_header(const std::string& content) {
  const HeaderFile file(content);
  const long width = file.integer("W"), count = file.integer("degree") + 1;
  const Numbers coefficients = file.array("coefficients");
  const auto gridded = [=](double u) {
    const auto first = static_cast<long>(std::ceil(u - static_cast<double>(width) / 2));
    const double t = u - static_cast<double>(first) - static_cast<double>(width - 1) / 2;
    std::vector<Tap> found;
    for (long r = 0; r < width; ++r) {
      double value = 0;
      for (long d = count - 1; d >= 0; --d) value = value * t + coefficients[static_cast<std::size_t>(r * count + d)];
      found.emplace_back(first + r, value);
    }
    return found;
  };
  return {gridded, file_divisor(file), {}};
}

/// Lagrange's polynomial through the four rows around `place`: the first of them, and their weights.
std::pair<long, Numbers> cubic(double place, long last) {
  const long from = std::clamp(std::lround(place - 1.5), 0L, last - 3);
  Numbers weights(4, 1);
  for (long j = 0; j <= 3; ++j)
    for (long k = 0; k <= 3; ++k)
      if (k != j) weights[static_cast<std::size_t>(j)] *= (place - static_cast<double>(from + k)) / static_cast<double>(j - k);
  return {from, weights};
}

EmulatedHost csv(const std::string& content) {
  std::vector<Numbers> rows;
  Numbers divisors;
  std::istringstream lines(content);
  double end = 0;
  for (std::string line; std::getline(lines, line);) {
    const bool row = line.rfind("taps,", 0) == 0, divisor = line.rfind("divisor,", 0) == 0;
    if (!row && !divisor) continue;
    Numbers values;
    std::istringstream cells(line.substr(line.find(',') + 1));
    for (std::string cell; std::getline(cells, cell, ',');)
      if (!cell.empty()) values.push_back(std::stod(cell));
    if (row) rows.emplace_back(values.begin() + 1, values.end());
    if (divisor) {
      end = values[0];
      divisors.push_back(values[1]);
    }
  }
  const auto width = static_cast<long>(rows.front().size()), last = static_cast<long>(rows.size()) - 1;
  const auto gridded = [=](double u) {
    const auto first = static_cast<long>(std::ceil(u - static_cast<double>(width) / 2));
    const double place = (u - static_cast<double>(first) - static_cast<double>(width) / 2 + 1) * static_cast<double>(last);
    const auto [from, weights] = cubic(place, last);
    std::vector<Tap> found;
    for (long r = 0; r < width; ++r) {
      double value = 0;
      for (std::size_t k = 0; k <= 3; ++k)
        value += weights[k] * rows[static_cast<std::size_t>(from) + k][static_cast<std::size_t>(r)];
      found.emplace_back(first + r, value);
    }
    return found;
  };
  const auto divisor = [=](long pixel, long size) {
    const double x = std::abs(static_cast<double>(pixel) / static_cast<double>(size));
    const auto [from, weights] =
        cubic(x / end * static_cast<double>(divisors.size() - 1), static_cast<long>(divisors.size()) - 1);
    double value = 0;
    for (std::size_t k = 0; k <= 3; ++k) value += weights[k] * divisors[static_cast<std::size_t>(from) + k];
    return value;
  };
  return {gridded, divisor, {}};
}

}  // namespace

EmulatedHost emulated_host(const std::string& host, const std::string& content) {
  if (host == "wsclean") return wsclean(content);
  if (host == "ducc") return ducc(content);
  if (host == "finufft") return finufft(content);
  if (host == "yandasoft") return yandasoft(content);
  if (host == "c-header") return c_header(content);
  BOOST_REQUIRE(host == "csv");
  return csv(content);
}

namespace {

using Complex = std::complex<double>;
using Rows = std::vector<std::vector<Complex>>;

/// Positions that cover the cells evenly: multiples of `step`'s fraction.
double position(int k, double step) {
  return 20 + 60 * std::fmod((k + 1) * step, 1);
}

/// Σ_x image[x] part[x]
Complex dot(const std::vector<Complex>& a, const std::vector<Complex>& b) {
  double real = 0, imaginary = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    real += a[i].real() * b[i].real() - a[i].imag() * b[i].imag();
    imaginary += a[i].real() * b[i].imag() + a[i].imag() * b[i].real();
  }
  return {real, imaginary};
}

}  // namespace

double measured_error(const EmulatedHost& host, bool own_divisor, int pixels, int fft_size) {
  constexpr int visibilities = 800;
  constexpr double golden = 0.6180339887498949, silver = 0.4142135623730951;
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  Rows image(static_cast<std::size_t>(pixels), std::vector<Complex>(static_cast<std::size_t>(pixels)));
  for (auto& row : image)
    for (Complex& pixel : row) pixel = {normal(random), normal(random)};
  const auto& divisor = own_divisor ? host.own_divisor : host.divisor;
  std::vector<double> corrected(static_cast<std::size_t>(pixels));
  for (int i = 0; i < pixels; ++i) corrected[static_cast<std::size_t>(i)] = 1 / divisor(i - pixels / 2, fft_size);
  // What a visibility at u has of each pixel of an axis: exp(2πiux), exact or as the host's taps sum it up.
  const auto phasor = [&](double cell, int i) {
    return std::polar(1.0, 2 * pi * std::fmod(cell * (i - pixels / 2) / fft_size, 1));
  };
  const auto exact = [&](double u) {
    std::vector<Complex> part;
    for (int i = 0; i < pixels; ++i) part.push_back(phasor(u, i));
    return part;
  };
  const auto gridded = [&](double u) {
    std::vector<Complex> part(static_cast<std::size_t>(pixels));
    for (const auto& [cell, tap] : host.taps(u))
      for (int i = 0; i < pixels; ++i)
        part[static_cast<std::size_t>(i)] +=
            tap * corrected[static_cast<std::size_t>(i)] * phasor(static_cast<double>(cell), i);
    return part;
  };
  const auto visibility = [&](const std::vector<Complex>& along_u, const std::vector<Complex>& along_v) {
    std::vector<Complex> rows;
    for (const auto& row : image) rows.push_back(dot(row, along_u));
    return dot(rows, along_v);
  };
  double difference = 0, norm = 0;
  for (int k = 0; k < visibilities; ++k) {
    const double u = position(k, golden), v = position(k, silver);
    const Complex should = visibility(exact(u), exact(v));
    difference += std::norm(visibility(gridded(u), gridded(v)) - should);
    norm += std::norm(should);
  }
  return std::sqrt(difference / norm);
}

}  // namespace misfit::tools::testing
