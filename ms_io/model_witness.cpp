#include <casacore/tables/Tables/ArrayColumn.h>

#include <algorithm>

#include "ms_io/fingerprint.h"
#include "ms_io/model_witness_internal.h"

namespace misfit::ms_io {
namespace {

using Column = casacore::ArrayColumn<casacore::Complex>;

constexpr std::uint64_t most_witnesses = 16;

std::uint64_t fingerprint(const casacore::Complex* correlations, std::size_t count) {
  return Fingerprint().add(correlations, count * sizeof(casacore::Complex)).value();
}

/// The fingerprint of one channel of a cell; 0 where there is none.
std::uint64_t fingerprint(const Column& column, std::uint64_t row, std::uint64_t channel) {
  if (row >= column.nrow() || !column.isDefined(row)) return 0;
  const casacore::IPosition shape = column.shape(row);
  if (shape.nelements() != 2 || static_cast<std::uint64_t>(shape(1)) <= channel) return 0;
  const casacore::Array<casacore::Complex> piece = column.getSlice(
      row, casacore::Slicer(casacore::IPosition(2, 0, static_cast<ssize_t>(channel)), casacore::IPosition(2, shape(0), 1)));
  return fingerprint(piece.data(), piece.nelements());
}

bool refers_to_others(const casacore::Table& set) {
  const casacore::Block<casacore::String> tables = set.getPartNames();
  return tables.nelements() != 1 || tables[0] != set.tableName();
}

}  // namespace

std::vector<Witness> choose_witnesses(const casacore::MeasurementSet& set, const ModelColumn& column,
                                      const SelectedRows& selected) {
  std::vector<Witness> witnesses;
  if (refers_to_others(set)) return witnesses;
  const std::string& name = set.tableDesc().isColumn(column.name) ? column.name : column.subtracted_from;
  const Column cells = name.empty() ? Column() : Column(set, name);
  const std::uint64_t step = (selected.rows + most_witnesses - 1) / most_witnesses;
  // One in each of as many equal parts, at a place that no order of baselines, fields or windows repeats.
  const auto place = [step](std::uint64_t part) { return part * step + Fingerprint().add(part).value() % step; };
  std::uint64_t passed = 0, part = 0, next = step > 0 ? place(0) : 0;  // of the rows selected
  for (const BlockRows& block : selected.blocks) {
    const Setup& setup = selected.setups[block.setup];
    const std::vector<casacore::Complex> zeros(setup.correlation_types.size());
    for (const Run& run : block.runs) {
      for (; next < passed + run.count; next = place(++part)) {
        const std::uint64_t row = run.first + next - passed, channel = setup.first_channel();
        const std::uint64_t now = name.empty() ? fingerprint(zeros.data(), zeros.size()) : fingerprint(cells, row, channel);
        if (now != 0) witnesses.push_back({row, channel, now, now});
      }
      passed += run.count;
    }
  }
  return witnesses;
}

bool foretell(std::vector<Witness>& witnesses, const Rows& rows, const Setup& setup,
              const casacore::Array<casacore::Complex>& values) {
  const std::size_t correlations = setup.correlation_types.size(), row_values = correlations * setup.channel_span();
  bool any = false;
  for (Witness& witness : witnesses) {
    const std::uint64_t at = rows.index_of(witness.row);
    if (at == rows.count()) continue;
    witness.after = fingerprint(values.data() + at * row_values, correlations);
    any = true;
  }
  return any;
}

std::size_t changed(const std::vector<Witness>& witnesses, const casacore::Table& set, const std::string& column) {
  if (witnesses.empty() || refers_to_others(set)) return 0;
  try {
    const Column cells(set, column);
    return static_cast<std::size_t>(std::count_if(witnesses.begin(), witnesses.end(), [&](const Witness& witness) {
      const std::uint64_t now = fingerprint(cells, witness.row, witness.channel);
      return now != witness.before && now != witness.after;
    }));
  } catch (const casacore::AipsError&) {  // the column holds something else
    return witnesses.size();
  }
}

}  // namespace misfit::ms_io
