#include "ms_io/model_writer.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <future>
#include <memory>
#include <sstream>
#include <stdexcept>

#include "ms_io/fingerprint.h"
#include "ms_io/metadata_internal.h"
#include "ms_io/missing_cells_internal.h"
#include "ms_io/model_cells_internal.h"
#include "ms_io/model_column_internal.h"
#include "ms_io/model_journal_internal.h"
#include "ms_io/row_shares_internal.h"
#include "ms_io/table_access_internal.h"
#include "ms_io/value_flush_internal.h"

namespace misfit::ms_io {
namespace {

/// `column` with its names spelt out.
ModelColumn spelt_out(const ModelColumn& column) {
  ModelColumn result = column;
  result.name = column_name(column.name);
  result.subtracted_from = column_name(column.subtracted_from);
  return result;
}

/// Equal for runs that write the same values into the same cells, in whatever blocks; empty where that cannot be told.
std::string identity_of(const casacore::Table& set, const ModelColumn& column, const SelectedRows& selected) {
  if (column.origin.fingerprint == 0) return "";
  std::vector<Fingerprint> setups;
  for (const Setup& setup : selected.setups) setups.push_back(Fingerprint().add(setup.frequency_hz));
  const casacore::ArrayColumn<double> uvw_column(set, "UVW");
  casacore::Array<double> uvw;
  for (const BlockRows& block : selected.blocks) {
    const Rows rows(block.runs);
    read(uvw_column, rows, uvw);
    for (std::uint64_t r = 0; r < rows.count(); ++r)
      setups[block.setup].add(rows[r]).add(uvw.data() + 3 * r, 3 * sizeof(double));
  }
  Fingerprint all;
  all.add(column.origin.fingerprint).add(column.name).add(column.subtracted_from);
  for (std::size_t s = 0; s < setups.size(); ++s) {
    all.add(setups[s].value())
        .add(static_cast<std::uint64_t>(selected.setups[s].data_description))
        .add(static_cast<std::uint64_t>(selected.setups[s].field));
    for (const Run& run : selected.setups[s].channels) all.add(run.first).add(run.count);
  }
  std::ostringstream text;
  text << std::hex << all.value();
  return text.str();
}

/// Where the block lies; rows with a non-finite UVW are put at 0 and marked.
imager::SampleCoordinates coordinates(const casacore::ArrayColumn<double>& uvw_column, const Rows& rows, const Setup& setup,
                                      std::vector<bool>& unknown) {
  casacore::Array<double> uvw;
  read(uvw_column, rows, uvw);
  imager::SampleCoordinates where{uvw.tovector(), setup.frequency_hz};
  unknown.assign(rows.count(), false);
  for (std::size_t r = 0; r < rows.count(); ++r) {
    double* const row = where.uvw_m.edit().data() + 3 * r;
    if (std::isfinite(row[0]) && std::isfinite(row[1]) && std::isfinite(row[2])) continue;
    unknown[r] = true;
    row[0] = row[1] = row[2] = 0;
  }
  return where;
}

/// At `where` of the set itself, of a model about the phase centre that `shift` leads to.
StokesVisibilities predicted(const Predict& predict, const imager::PhaseShift& shift, const imager::SampleCoordinates& where,
                             const std::vector<bool>& unknown) {
  imager::SampleCoordinates shifted = where;
  shift.rotate(shifted.uvw_m.edit());
  StokesVisibilities model = predict(shifted);
  for (std::vector<std::complex<double>>& plane : model.plane) {
    if (plane.empty()) continue;
    if (plane.size() != where.samples()) {
      throw std::invalid_argument("prediction returned " + std::to_string(plane.size()) + " visibilities; expected " +
                                  std::to_string(where.samples()));
    }
    shift.undo(where, plane);
    for (std::size_t r = 0; r < unknown.size(); ++r) {
      if (unknown[r]) std::fill_n(plane.begin() + static_cast<std::ptrdiff_t>(r * where.channels()), where.channels(), 0.0);
    }
  }
  return model;
}

/// A block on its way from its coordinates to the column.
struct PredictedBlock {
  const Setup* setup;
  Rows rows;
  imager::SampleCoordinates where;
  std::vector<bool> unknown;
  BlockCells cells;
  std::future<void> formed;

  PredictedBlock(const BlockRows& block, const std::vector<Setup>& setups) : setup(&setups[block.setup]), rows(block.runs) {}

  /// Another thread predicts, and forms what is to be stored; casacore is for one thread alone.
  void begin(const Predict& predict) {
    formed = std::async(std::launch::async,
                        [this, &predict] { cells.form(rows, *setup, predicted(predict, setup->shift, where, unknown)); });
  }
  /// Rethrows what the other thread threw.
  void finish() {
    if (formed.valid()) formed.get();
  }
};

/// A column while it is written.
class ModelWriter {
 public:
  using Progress = std::function<void(std::uint64_t, std::uint64_t)>;

  ModelWriter(const std::string& path, const Selection& selection, const ModelColumn& column, std::uint64_t block_samples)
      : path_(path), column_(spelt_out(column)), set_(open_measurement_set(path, Access::update)) {
    require_writable_column(set_, path_, column_);
    selected_ = select_rows(set_, path_, selection, {block_samples, false});
    describe(set_, path_, selected_);  // throws unless there is one phase centre
    journal_.column = column_.name;
    journal_.command = one_line(column_.origin.command);
    journal_.identity = translated("cannot read UVW of " + path_, [&] { return identity_of(set_, column_, selected_); });
    journal_.rows = selected_.rows;
    journal_.witnesses = translated(doing_(), [&] { return choose_witnesses(set_, column_, selected_); });
    const bool exists = set_.tableDesc().isColumn(column_.name);
    if (exists) go_on();
    write_journal(set_, journal_);  // before there is a column, so that none is ever without
    if (!exists) {
      create_model_column(set_, path_, column_);
    } else if (translated(doing_(), [&] { return give_missing_cells(set_, column_); })) {
      set_ = casacore::MeasurementSet();
      set_ = open_measurement_set(path_, Access::update);
    }
  }

  ModelWriteReport write(const Predict& predict, int at_once, const Progress& progress) {
    cells_ = std::make_unique<ModelCells>(translated(doing_(), [&] { return ModelCells(set_, column_); }));
    flush_ = std::make_unique<ValueFlush>(set_, column_.name);
    const casacore::ArrayColumn<double> uvw(set_, "UVW");
    ModelWriteReport report;
    report.rows_before = journal_.written;
    std::deque<std::unique_ptr<PredictedBlock>> under_way;  // the first is written while the others are predicted
    const auto finish = [&] {
      PredictedBlock& first = *under_way.front();
      first.finish();
      write(first);
      samples_ += first.where.samples();
      under_way.pop_front();
      if (progress) progress(samples_, selected_.samples);
    };
    const auto together = static_cast<std::size_t>(at_once);
    for (const BlockRows& rows : selected_.blocks) {
      const BlockRows rest = rows_between(rows, done_below(journal_, rows), set_.nrow());
      samples_ += (rows.rows - rest.rows) * selected_.setups[rows.setup].frequency_hz.size();
      if (rest.rows == 0) continue;
      auto block = std::make_unique<PredictedBlock>(rest, selected_.setups);
      prepare(uvw, *block);
      if (under_way.size() >= together) under_way[under_way.size() - together]->finish();
      block->begin(predict);
      under_way.push_back(std::move(block));
      if (under_way.size() > together) finish();
    }
    while (!under_way.empty()) finish();
    remove_journal(set_, column_.name);
    report.rows = journal_.written;
    report.samples = samples_;
    report.nonfinite_uvw_rows = journal_.nonfinite_uvw_rows;
    return report;
  }

 private:
  std::string doing_() const { return "cannot write " + column_.name + " of " + path_; }

  /// All rows of the block's setup below this one are written.
  static std::uint64_t done_below(const ModelJournal& journal, const BlockRows& block) {
    const auto found = journal.done_below.find(block.setup);
    return found == journal.done_below.end() ? 0 : found->second;
  }

  /// Takes up what an earlier run left, where that is the beginning of this one.
  void go_on() {
    const std::optional<ModelJournal> before = read_journal(set_, column_.name);
    if (!before) return;
    const Left left = what_is_left(*before);
    if (!column_.may_exist && (left == Left::another || left == Left::changed)) throw_exists(path_, column_.name);
    if (left == Left::beginning) journal_ = *before;
    const std::string fate = left == Left::beginning ? ", going on"
                             : left == Left::changed ? ", and have changed since; this run begins anew"
                             : left == Left::other_data
                                 ? " from " + column_.subtracted_from + ", which has changed since; this run begins anew"
                                 : "; this run has another model, selection or option, or other coordinates, and begins anew: "
                                   "rows that it does not select stay as they are";
    if (column_.origin.tell) column_.origin.tell(incompleteness(path_, *before) + fate);
  }

  enum class Left { beginning, other_data, changed, another };

  /// What the column holds of the run whose journal this is: the beginning of this one, or that of other data, or what another
  /// program wrote, or another run's.
  Left what_is_left(const ModelJournal& before) {
    if (outlived(set_, before)) return Left::changed;
    if (journal_.identity.empty() || before.identity != journal_.identity) return Left::another;
    std::uint64_t rows = 0;
    CellChecksum checksum;
    try {
      ModelCells cells(set_, column_);
      for (const BlockRows& block : selected_.blocks) {
        const BlockRows done = rows_between(block, 0, done_below(before, block));
        if (done.rows > 0) checksum += cells.checksum(Rows(done.runs), selected_.setups[block.setup]);
        rows += done.rows;
      }
      if (changed(before.witnesses, set_, column_.name) > 0) return Left::changed;
    } catch (const casacore::AipsError&) {  // the column is another one
      return Left::changed;
    }
    if (rows != before.written || checksum.values != before.checksum.values) return Left::changed;
    return checksum.data == before.checksum.data ? Left::beginning : Left::other_data;
  }

  void prepare(const casacore::ArrayColumn<double>& uvw, PredictedBlock& block) {
    block.where =
        translated("cannot read UVW of " + path_, [&] { return coordinates(uvw, block.rows, *block.setup, block.unknown); });
    translated("cannot read " + column_.subtracted_from + " of " + path_,
               [&] { block.cells.data.reference(cells_->data(block.rows, *block.setup)); });
    translated(doing_(), [&] { block.cells.values.reference(cells_->values(block.rows, *block.setup)); });
  }

  void write(const PredictedBlock& block) {
    if (foretell(journal_.witnesses, block.rows, *block.setup, block.cells.values)) write_journal(set_, journal_);
    translated(doing_(), [&] {
      cells_->write(block.rows, *block.setup, block.cells.values);
      (*flush_)();
    });
    journal_.checksum += block.cells.checksum;
    journal_.written += block.rows.count();
    for (const bool row_is_unknown : block.unknown) journal_.nonfinite_uvw_rows += row_is_unknown;
    journal_.done_below[static_cast<std::size_t>(block.setup - selected_.setups.data())] =
        block.rows[block.rows.count() - 1] + 1;
    write_journal(set_, journal_);
  }

  std::string path_;
  ModelColumn column_;
  casacore::MeasurementSet set_;
  SelectedRows selected_;
  ModelJournal journal_;
  std::uint64_t samples_ = 0;  ///< that hold the model
  std::unique_ptr<ModelCells> cells_;
  std::unique_ptr<ValueFlush> flush_;
};

}  // namespace

std::string incomplete_column(const std::string& path, const std::string& column) {
  const std::string name = column_name(column);
  const casacore::MeasurementSet set = open_measurement_set(path, Access::read);
  const std::optional<ModelJournal> journal = set.tableDesc().isColumn(name) ? read_journal(set, name) : std::nullopt;
  return journal && !outlived(set, *journal) ? incompleteness(path, *journal) : "";
}

void require_writable(const std::string& path, const ModelColumn& column) {
  require_writable_column(open_measurement_set(path, Access::update), path, spelt_out(column));
}

ModelWriteReport write_model(const std::string& path, const Selection& selection, const ModelColumn& column,
                             const Predict& predict, const std::function<void(std::uint64_t, std::uint64_t)>& progress,
                             const PredictionPace& pace) {
  return ModelWriter(path, selection, column, pace.block_samples).write(predict, pace.at_once, progress);
}

}  // namespace misfit::ms_io
