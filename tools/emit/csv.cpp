#include <algorithm>
#include <cmath>

#include "kernels/lookup_table.h"
#include "tools/base/files.h"
#include "tools/base/numbers.h"
#include "tools/emit/emission.h"
#include "tools/emit/hosts.h"

namespace misfit::tools {
namespace {

constexpr int divisor_rows = 1025;

/// Row k: the W taps at t = −½ + k/Ms. [Ms + 1][W]
Eigen::MatrixXd rows_of(const HostKernel& k) {
  Eigen::MatrixXd rows(k.per_cell + 1, k.kernel.width());
  for (int i = 0; i <= k.per_cell; ++i) rows.row(i) = k.kernel.polynomial(static_cast<double>(i) / k.per_cell - 0.5);
  return rows;
}

/// The nearest row, or the polynomial through the rows around t, which stay within the table.
template <int Degree>
kernels::TapFunction taps_by(const Eigen::MatrixXd& rows) {
  return [rows](double t) -> Eigen::VectorXd {
    const auto last = static_cast<double>(rows.rows() - 1);
    const double place = std::clamp((t + 0.5) * last, 0.0, last);
    const double first = std::clamp(std::round(place - 0.5 * Degree), 0.0, last - Degree);
    const auto weight = kernels::newton_weights<double, Degree>(place - first);
    Eigen::VectorXd taps = Eigen::VectorXd::Zero(rows.cols());
    for (int j = 0; j <= Degree; ++j)
      taps += weight[static_cast<std::size_t>(j)] * rows.row(static_cast<Eigen::Index>(first) + j);
    return taps;
  };
}

kernels::TapFunction taps(const HostKernel& k) {
  const Eigen::MatrixXd rows = rows_of(k);
  switch (k.interpolation) {
    case 0:
      return taps_by<0>(rows);
    case 1:
      return taps_by<1>(rows);
    case 2:
      return taps_by<2>(rows);
    default:
      return taps_by<3>(rows);
  }
}

std::string line(const std::string& what, double position, const Eigen::VectorXd& values, int columns) {
  std::string text = what + "," + all_digits(position);
  for (int c = 0; c < columns; ++c) text += c < values.size() ? "," + all_digits(values[c]) : ",";
  return text + "\n";
}

void write_csv(const Emission& e, const std::string& path) {
  const int width = e.table.kernel.width();
  std::string text;
  for (const std::string& s : statement(e)) text += "# " + s + "\n";
  text +=
      "# taps: position t in [-1/2, 1/2] of a visibility from the middle of its W cells, the values those of cells 0 to W-1;\n"
      "# divisor: what the image is divided by along an axis at x = (pixel - centre) / FFT size, to be interpolated to third "
      "degree.\nwhat,position";
  for (int c = 0; c < width; ++c) text += ",value_" + std::to_string(c);
  text += "\n";
  const Eigen::MatrixXd rows = rows_of(e.table);
  for (Eigen::Index i = 0; i < rows.rows(); ++i)
    text += line("taps", static_cast<double>(i) / e.table.per_cell - 0.5, rows.row(i), width);
  for (int i = 0; i < divisor_rows; ++i) {
    const double x = e.divisor.x0 * i / (divisor_rows - 1);
    text += line("divisor", x, Eigen::VectorXd::Constant(1, e.divisor(x)), width);
  }
  write_file(path, text);
}

}  // namespace

Host csv_host() {
  Host host;
  host.name = "csv";
  host.title = "a reader of CSV";
  host.habit = "rows of the table, the nearest or interpolated within it, the image divided by what it is given";
  host.table = {128, 100000, false, true};
  host.taps_of = [](int width) { return width; };
  host.bytes = [](const HostKernel& k) { return (k.per_cell + 1.0) * k.kernel.width() * sizeof(double); };
  host.taps = taps;
  host.write = write_csv;
  return host;
}

}  // namespace misfit::tools
