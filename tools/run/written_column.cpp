#include "tools/run/written_column.h"

#include "tools/base/numbers.h"

namespace misfit::tools {
namespace {

std::string counted(std::uint64_t number) {
  return grouped(static_cast<long long>(number));
}

}  // namespace

std::string written_words(const std::string& path, const ms_io::ModelColumn& column, const ms_io::ModelWriteReport& report) {
  const ms_io::ModelColumn named = ms_io::spelt_out(column);
  const bool subtracts = !named.subtracted_from.empty();
  std::string words = path + ": " + (subtracts ? named.subtracted_from + " − model of " : "model of ") +
                      counted(report.samples) + " visibilities in " + counted(report.rows) +
                      (report.rows < report.set_rows ? " of " + counted(report.set_rows) : "") + " rows written to " +
                      named.name + "\n";
  if (report.rows_before > 0) words += counted(report.rows_before) + " of these rows had been written before\n";
  if (report.nonfinite_uvw_rows > 0)
    words += counted(report.nonfinite_uvw_rows) + " rows have UVW that are not finite and " +
             (subtracts ? "keep their data\n" : "got 0\n");
  return words;
}

std::string unselected_warning(const std::string& path, const ms_io::Selection& selection, const ms_io::ModelColumn& column) {
  const ms_io::UnselectedCells cells = ms_io::unselected_cells(path, selection, column);
  if (cells.rows == 0 && !cells.channels) return "";
  const ms_io::ModelColumn named = ms_io::spelt_out(column);
  const std::string rows = counted(cells.rows) + " of " + counted(cells.set_rows) + " rows";
  const std::string left_out = cells.rows == 0 ? "channels" : rows + (cells.channels ? ", and channels of the others," : "");
  const bool one = cells.rows == 1 && !cells.channels;
  const std::string holds = !cells.column_is_new            ? named.name + " keeps there what it held before"
                            : named.subtracted_from.empty() ? named.name + " is 0 there"
                                                            : named.name + " is " + named.subtracted_from + " there";
  return left_out + " of " + path + (one ? " is" : " are") + " not selected: " + holds;
}

}  // namespace misfit::tools
