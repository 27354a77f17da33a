#include "ms_io/model_writer.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <future>
#include <memory>
#include <sstream>
#include <stdexcept>

#include "ms_io/filled_data_internal.h"
#include "ms_io/fingerprint.h"
#include "ms_io/kept_cells_internal.h"
#include "ms_io/missing_cells_internal.h"
#include "ms_io/model_cells_internal.h"
#include "ms_io/model_column_internal.h"
#include "ms_io/model_journal_internal.h"
#include "ms_io/row_shares_internal.h"
#include "ms_io/row_sights_internal.h"
#include "ms_io/sight_numbers_internal.h"
#include "ms_io/subtracted_models_internal.h"
#include "ms_io/table_access_internal.h"
#include "ms_io/value_flush_internal.h"

namespace misfit::ms_io {
namespace {

std::string hexadecimal(std::uint64_t number) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << std::hex << number;
  return text.str();
}

/// A fingerprint of the cells that are selected, in whatever blocks, and of their coordinates.
std::string identity_of(const casacore::Table& set, const SelectedRows& selected) {
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
  if (const auto& centre = selected.phase_centre)
    all.add(std::vector<double>{centre->ra_rad, centre->dec_rad}).add(centre->frame);
  if (selected.follows_target) all.add(selected.body ? selected.body_name : std::string("TRACKFIELD"));
  for (std::size_t s = 0; s < setups.size(); ++s) {
    all.add(setups[s].value())
        .add(static_cast<std::uint64_t>(selected.setups[s].data_description))
        .add(static_cast<std::uint64_t>(selected.setups[s].field));
    for (const Run& run : selected.setups[s].channels) all.add(run.first).add(run.count);
  }
  return hexadecimal(all.value());
}

/// A fingerprint of the model; "-" where it is not known.
std::string identity_of(const ModelOrigin& origin) {
  const std::uint64_t fingerprint = origin.model != 0 ? origin.model : origin.fingerprint;
  return fingerprint == 0 ? "-" : hexadecimal(fingerprint);
}

/// The coordinates of the block; rows with a non-finite UVW are put at 0 and marked.
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

/// The visibilities at the set's own coordinates `where`, of a model about the phase centre that `shifts` lead to.
StokesVisibilities predicted(const Predict& predict, const imager::RowShifts& shifts, const imager::SampleCoordinates& where,
                             const std::vector<bool>& unknown) {
  imager::SampleCoordinates shifted = where;
  shifts.rotate(shifted.uvw_m.edit());
  StokesVisibilities model = predict(shifted);
  for (std::vector<std::complex<double>>& plane : model.plane) {
    if (plane.empty()) continue;
    if (plane.size() != where.samples()) {
      throw std::invalid_argument("prediction returned " + std::to_string(plane.size()) + " visibilities; expected " +
                                  std::to_string(where.samples()));
    }
    shifts.undo(where, plane);
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
  imager::RowShifts shifts;
  std::vector<bool> unknown;
  BlockCells cells;
  std::future<void> formed;

  PredictedBlock(const BlockRows& block, const std::vector<Setup>& setups) : setup(&setups[block.setup]), rows(block.runs) {}

  /// Has another thread predict, and form the cells to be stored; casacore is for one thread alone.
  void begin(const Predict& predict) {
    formed = std::async(std::launch::async,
                        [this, &predict] { cells.form(rows, *setup, predicted(predict, shifts, where, unknown)); });
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
      : path_(path), column_(spelt_out(column)), set_(open_measurement_set(path, Access::update)), kept_(set_, column_.name) {
    require_writable_column(set_, path_, column_);
    selected_ = select_rows(set_, path_, selection, {block_samples, false});
    filled_ = std::make_unique<FilledData>(selected_.setups);
    journal_.column = column_.name;
    selection_ = one_line(to_text(selection));
    journal_.command = one_line(column_.origin.command);
    if (!journal_.command.empty() && !selection_.empty()) journal_.command += " " + selection_;
    here_ = {identity_of(column_.origin),
             translated("cannot read UVW of " + path_, [&] { return identity_of(set_, selected_); }), journal_.command};
    if (column_.origin.fingerprint != 0)  // equal for runs that write the same values into the same cells
      journal_.identity = hexadecimal(Fingerprint()
                                          .add(column_.origin.fingerprint)
                                          .add(here_.selection)
                                          .add(column_.name)
                                          .add(column_.subtracted_from)
                                          .value());
    journal_.rows = selected_.rows;
    journal_.witnesses = translated(doing_(), [&] { return choose_witnesses(set_, column_, selected_); });
    const bool exists = set_.tableDesc().isColumn(column_.name);
    const bool goes_on = exists && go_on();
    if (!goes_on) kept_.forget();  // what a run left that this one does not go on with
    if (journal_.written == 0) tell_of_subtracted();
    if (column_.in_place())  // what tells of changes by others is about to change
      write_subtracted_models(set_, column_.name, subtracted_models(set_, column_.name), {});
    write_journal(set_, journal_);  // before there is a column, so that none is ever without
    if (!exists) {
      create_model_column(set_, path_, column_);
    } else if (!column_.in_place() && translated(doing_(), [&] { return give_missing_cells(set_, column_); })) {
      set_ = casacore::MeasurementSet();
      set_ = open_measurement_set(path_, Access::update);
    }
  }

  ModelWriteReport write(const Predict& predict, const PredictionPace& pace, const Progress& progress) {
    if (pace.sights_from) {
      const OpenSet open_set{path_, 0, "", set_, selected_, {}, {}, {}, {}};
      sights_ = std::make_unique<SightReader>(open_set, numbers_by_id(open_set, *pace.sights_from));
    }
    cells_ = std::make_unique<ModelCells>(translated(doing_(), [&] { return ModelCells(set_, column_); }));
    flush_ = std::make_unique<ValueFlush>(set_, column_.name);
    if (column_.in_place()) take_back_block_that_was_cut();
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
    const auto together = static_cast<std::size_t>(pace.at_once);
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
    kept_.forget();
    translated(doing_(), [&] {
      write_subtracted_models(set_, column_.name, models_that_are_lacking(), choose_witnesses(set_, {column_.name}, selected_));
    });
    remove_journal(set_, column_.name);
    if (report.rows_before == 0) report.zeros = {path_, column_.subtracted_from, filled_->zeros(imager::alone())};
    report.set_rows = set_.nrow();
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

  /// Continues the rows of an earlier run, if they are the beginning of this one. Returns whether they are.
  bool go_on() {
    const std::optional<ModelJournal> before = read_journal(set_, column_.name);
    if (!before) return false;
    const Left left = what_is_left(*before);
    if (column_.in_place() && outlived(set_, *before)) write_subtracted_models(set_, column_.name, {}, {});
    if (column_.in_place() && left != Left::beginning && !outlived(set_, *before))
      throw std::runtime_error(
          incompleteness(path_, *before) +
          "; expected that command again, which writes the other rows, before another model is subtracted from these data");
    if (!column_.may_exist && (left == Left::another || left == Left::changed)) throw_exists(path_, column_.name);
    if (left == Left::beginning) journal_ = *before;
    const std::string fate = left == Left::beginning ? ", going on"
                             : left == Left::changed ? ", and have changed since; this run begins anew"
                             : left == Left::other_data
                                 ? " from " + column_.subtracted_from + ", which has changed since; this run begins anew"
                                 : "; this run has another model, selection or option, or other coordinates, and begins anew: "
                                   "rows that it does not select stay as they are";
    if (column_.origin.tell) column_.origin.tell(incompleteness(path_, *before) + fate);
    return left == Left::beginning;
  }

  enum class Left { beginning, other_data, changed, another };

  /// Tells what the column holds of the run that wrote the journal `before`: the beginning of this run, the beginning from
  /// other data, changes by another program, or another run's rows.
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
    const bool same_data = column_.in_place() || checksum.data == before.checksum.data;  // in place they are the values
    return same_data ? Left::beginning : Left::other_data;
  }

  /// Throws where the data in place lack this model already; tells the origin of all models that they lack.
  void tell_of_subtracted() const {
    if (column_.subtracted_from.empty()) return;
    for (const SubtractedModel& one : subtracted_models(set_, column_.subtracted_from)) {
      const std::string sentence = lacks_already(path_, column_.subtracted_from, one);
      const bool same = one.model != "-" && one.model == here_.model && one.selection == here_.selection;
      if (same && column_.in_place())
        throw std::runtime_error(sentence + "; expected another model or selection, or data that hold this one");
      if (column_.origin.tell)
        column_.origin.tell("warning: " + sentence + "; this run selects " + (selection_.empty() ? "all rows" : selection_));
    }
  }

  /// The models that the complete column lacks: those that the data lacked, this one, and those of other selections.
  std::vector<SubtractedModel> models_that_are_lacking() const {
    std::vector<SubtractedModel> models;
    const bool subtracts = !column_.subtracted_from.empty();
    if (subtracts) models = subtracted_models(set_, column_.subtracted_from);
    if (!column_.in_place())
      for (const SubtractedModel& one : subtracted_models(set_, column_.name))
        if (one.selection != here_.selection) models.push_back(one);
    const auto is_this = [&](const SubtractedModel& one) {
      return one.model == here_.model && one.selection == here_.selection;
    };
    // A run that was cut short after it had written this record finds itself there.
    if (subtracts && std::none_of(models.begin(), models.end(), is_this)) models.push_back(here_);
    return models;
  }

  /// Takes back the block that was being written, in place of the data, when a run was cut short: some of it is written.
  void take_back_block_that_was_cut() {
    translated(doing_(), [&] {
      kept_.put_back(journal_, selected_.setups, *cells_);
      (*flush_)();
    });
  }

  void prepare(const casacore::ArrayColumn<double>& uvw, PredictedBlock& block) {
    block.where =
        translated("cannot read UVW of " + path_, [&] { return coordinates(uvw, block.rows, *block.setup, block.unknown); });
    if (sights_)
      translated("cannot read antennas, fields or times of " + path_,
                 [&] { block.where.sights = sights_->sights(block.rows); });
    translated("cannot read TIME of " + path_, [&] { find_shifts(block); });
    translated("cannot read " + column_.subtracted_from + " of " + path_,
               [&] { block.cells.data.reference(cells_->data(block.rows, *block.setup)); });
    translated(doing_(), [&] { block.cells.values.reference(cells_->values(block.rows, *block.setup)); });
  }

  void find_shifts(PredictedBlock& block) const {
    const FieldShift& shift = block.setup->shift;
    casacore::Vector<double> time_s;
    if (shift.moves()) read(casacore::ScalarColumn<double>(set_, "TIME"), block.rows, time_s);
    shift.append(shift.moves() ? time_s.data() : nullptr, block.rows.count(), block.shifts);
  }

  void look_for_data(const PredictedBlock& block) {
    casacore::Vector<int> field;
    translated("cannot read FIELD_ID of " + path_,
               [&] { read(casacore::ScalarColumn<int>(set_, "FIELD_ID"), block.rows, field); });
    const std::size_t cell = block.cells.data.size() / block.rows.count();
    for (std::uint64_t r = 0; r < block.rows.count(); ++r)
      filled_->look_at(block.setup->data_description, field.data()[r], {block.cells.data.data() + r * cell, nullptr, cell});
  }

  void write(const PredictedBlock& block) {
    const auto setup = static_cast<std::size_t>(block.setup - selected_.setups.data());
    if (!column_.subtracted_from.empty() && filled_->in_doubt()) look_for_data(block);
    if (column_.in_place()) kept_.keep(journal_, setup, block.rows, block.cells.data);
    if (foretell(journal_.witnesses, block.rows, *block.setup, block.cells.values)) write_journal(set_, journal_);
    translated(doing_(), [&] {
      cells_->write(block.rows, *block.setup, block.cells.values);
      (*flush_)();
    });
    journal_.checksum += block.cells.checksum;
    journal_.written += block.rows.count();
    for (const bool row_is_unknown : block.unknown) journal_.nonfinite_uvw_rows += row_is_unknown;
    journal_.done_below[setup] = block.rows[block.rows.count() - 1] + 1;
    write_journal(set_, journal_);
  }

  std::string path_;
  ModelColumn column_;
  casacore::MeasurementSet set_;
  KeptCells kept_;
  SelectedRows selected_;
  ModelJournal journal_;
  std::string selection_;               ///< in words; empty where that is all
  SubtractedModel here_;                ///< this run's
  std::unique_ptr<FilledData> filled_;  ///< what the model was subtracted from
  std::uint64_t samples_ = 0;           ///< that hold the model
  std::unique_ptr<ModelCells> cells_;
  std::unique_ptr<ValueFlush> flush_;
  std::unique_ptr<SightReader> sights_;  ///< where predictions need them
};

}  // namespace

bool ModelColumn::in_place() const {
  return column_name(name) == column_name(subtracted_from);
}

ModelColumn spelt_out(const ModelColumn& column) {
  ModelColumn result = column;
  result.name = column_name(column.name);
  result.subtracted_from = column_name(column.subtracted_from);
  return result;
}

UnselectedCells unselected_cells(const std::string& path, const Selection& selection, const ModelColumn& column) {
  UnselectedCells cells;
  if (to_text(selection).empty()) return cells;
  const casacore::MeasurementSet set = open_measurement_set(path, Access::read);
  const SelectedRows selected = select_rows(set, path, selection, {MeasurementSet::usual_block_samples, false});
  cells.set_rows = set.nrow();
  cells.rows = cells.set_rows - selected.rows;
  cells.channels = std::any_of(selected.setups.begin(), selected.setups.end(),
                               [](const Setup& setup) { return setup.frequency_hz.size() < setup.stored_channels; });
  cells.column_is_new = !set.tableDesc().isColumn(column_name(column.name));
  return cells;
}

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
  return ModelWriter(path, selection, column, pace.block_samples).write(predict, pace, progress);
}

}  // namespace misfit::ms_io
