// Measures how fast visibilities are read: casacore alone, in a bare loop over the columns that misfit reads, which no imager
// can beat, and misfit's reader to the end of its stream, by turns; it forms Stokes parameters in a second thread (`taskset -c
// 0` shows what that costs). Opened before: the columns that select rows are read.
#include <casacore/tables/Tables/ArrayColumn.h>
#include <casacore/tables/Tables/ScalarColumn.h>
#include <casacore/tables/Tables/Table.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <string>
#include <vector>

#include "ms_io/measurement_set.h"

namespace {

template <typename Action>
double seconds_of(const Action& action) {
  const auto start = std::chrono::steady_clock::now();
  action();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Reads a column in ranges of `at_once` rows into memory used again.
template <typename Column, typename Values>
void read_column(const Column& column, casacore::rownr_t at_once, Values& values) {
  const casacore::rownr_t rows = column.nrow();
  for (casacore::rownr_t begin = 0; begin < rows; begin += at_once)
    column.getColumnRange(casacore::Slicer(casacore::IPosition(1, static_cast<ssize_t>(begin)),
                                           casacore::IPosition(1, static_cast<ssize_t>(std::min(at_once, rows - begin)))),
                          values, true);
}

/// About 2²⁰ values at once.
template <typename T>
void read_array(const casacore::Table& table, const std::string& name) {
  const casacore::ArrayColumn<T> column(table, name);
  casacore::Array<T> values;
  const auto cell = static_cast<casacore::rownr_t>(std::max<ssize_t>(1, column.shape(0).product()));
  read_column(column, std::max<casacore::rownr_t>(1, (casacore::rownr_t{1} << 20) / cell), values);
}

template <typename T>
void read_scalar(const casacore::Table& table, const std::string& name) {
  casacore::Vector<T> values;
  read_column(casacore::ScalarColumn<T>(table, name), casacore::rownr_t{1} << 20, values);
}

/// Reads the columns that misfit reads: WEIGHT_SPECTRUM where it is, else WEIGHT.
void read_bare(const casacore::Table& table, const std::string& data) {
  const bool spectrum = table.tableDesc().isColumn("WEIGHT_SPECTRUM") &&
                        casacore::ArrayColumn<float>(table, "WEIGHT_SPECTRUM").isDefined(0) &&
                        casacore::ArrayColumn<float>(table, "WEIGHT_SPECTRUM").shape(0).product() > 0;
  read_scalar<int>(table, "ANTENNA1");
  read_scalar<int>(table, "ANTENNA2");
  read_scalar<bool>(table, "FLAG_ROW");
  read_array<double>(table, "UVW");
  read_array<casacore::Complex>(table, data);
  read_array<bool>(table, "FLAG");
  read_array<float>(table, spectrum ? "WEIGHT_SPECTRUM" : "WEIGHT");
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2 || argc > 4) {
    std::fprintf(stderr, "usage: misfit_read SET [RUNS [COLUMN]]\n");
    return 2;
  }
  try {
    const std::string path = argv[1], data = argc > 3 ? argv[3] : "DATA";
    const int runs = argc > 2 ? std::max(1, std::atoi(argv[2])) : 1;
    std::vector<double> opening, bare, ours, ratio;
    for (int run = 0; run < runs; ++run) {
      {
        const casacore::Table table(path);  // closed before the other opens it, so that neither finds what the other kept
        bare.push_back(seconds_of([&] { read_bare(table, data); }));
      }
      std::unique_ptr<misfit::ms_io::MeasurementSet> set;
      opening.push_back(
          seconds_of([&] { set = std::make_unique<misfit::ms_io::MeasurementSet>(path, misfit::ms_io::Selection{}, data); }));
      ours.push_back(seconds_of([&] {
        const auto stream = set->open();
        while (stream->next()) {
        }
      }));
      ratio.push_back(bare.back() / ours.back());
    }
    std::printf("%.4f s casacore, %.4f s misfit after %.4f s to open, speed %.3f of casacore's\n", median(bare), median(ours),
                median(opening), median(ratio));
    return 0;
  } catch (const std::exception& failure) {
    std::fprintf(stderr, "misfit_read: %s\n", failure.what());
    return 1;
  }
}
