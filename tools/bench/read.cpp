// What casacore alone takes to read the DATA, FLAG and UVW columns of a MeasurementSet once, in seconds: the floor of what any
// imager can reach.
#include <casacore/tables/Tables/ArrayColumn.h>
#include <casacore/tables/Tables/Table.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <exception>

namespace {

/// Reads a column in ranges of about 2²⁰ values into memory used again.
template <typename T>
void read_column(const casacore::Table& table, const char* name) {
  const casacore::ArrayColumn<T> column(table, name);
  const casacore::rownr_t rows = table.nrow();
  if (rows == 0) return;
  const casacore::rownr_t at_once =
      std::max<casacore::rownr_t>(1, (casacore::rownr_t{1} << 20) / static_cast<casacore::rownr_t>(column.shape(0).product()));
  casacore::Array<T> values;
  for (casacore::rownr_t begin = 0; begin < rows; begin += at_once)
    column.getColumnRange(casacore::Slicer(casacore::IPosition(1, static_cast<ssize_t>(begin)),
                                           casacore::IPosition(1, static_cast<ssize_t>(std::min(at_once, rows - begin)))),
                          values, true);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: misfit_read SET\n");
    return 2;
  }
  try {
    const auto start = std::chrono::steady_clock::now();
    const casacore::Table table(argv[1]);
    read_column<casacore::Complex>(table, "DATA");
    read_column<bool>(table, "FLAG");
    read_column<double>(table, "UVW");
    std::printf("%.4f\n", std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    return 0;
  } catch (const std::exception& failure) {
    std::fprintf(stderr, "misfit_read: %s\n", failure.what());
    return 1;
  }
}
