#include "ms_io/measurement_set.h"

#include <casacore/tables/Tables/ScalarColumn.h>

#include <algorithm>
#include <limits>
#include <set>
#include <stdexcept>
#include <utility>

#include "ms_io/beam_rows_internal.h"
#include "ms_io/block_group_internal.h"
#include "ms_io/field_pointings_internal.h"
#include "ms_io/followed_field_internal.h"
#include "ms_io/metadata_internal.h"
#include "ms_io/model_writer.h"
#include "ms_io/row_shares_internal.h"
#include "ms_io/row_sights_internal.h"
#include "ms_io/set_summary_internal.h"
#include "ms_io/sight_numbers_internal.h"
#include "ms_io/spectral_part_internal.h"
#include "ms_io/stokes_response_internal.h"
#include "ms_io/subtracted_models_internal.h"
#include "ms_io/table_access_internal.h"
#include "ms_io/uvw_scan_internal.h"
#include "ms_io/visibility_reader_internal.h"

namespace misfit::ms_io {
namespace {

struct NamedSet {
  std::string path;
  std::size_t place = 0;  ///< among those that are named
};

std::shared_ptr<const OpenSet> open_selected(const NamedSet& named, const Selection& selection, const std::string& data_column,
                                             const std::vector<imager::Stokes>& stokes, std::uint64_t block_samples) {
  const std::string& path = named.path;
  const auto opened = std::make_shared<OpenSet>();
  opened->path = path;
  opened->place = named.place;
  opened->files.remember(path);
  opened->set = open_measurement_set(path, Access::read);
  opened->data_column = column_name(opened->set, data_column);
  for (const casacore::String& part : opened->set.getPartNames())  // those that it refers to
    if (part != opened->set.tableName()) opened->files.remember(part);
  if (!data_column.empty()) require_visibility_column(opened->set, path, opened->data_column);
  opened->selected = select_rows(opened->set, path, selection.of_set(named.place), {block_samples, true});
  if (selection.sights) opened->sights = std::make_shared<SightNumbers>();
  if (data_column.empty()) return opened;
  opened->filled = std::make_shared<FilledData>(opened->selected.setups);
  for (const Setup& setup : opened->selected.setups) {
    try {
      opened->recipes.push_back(
          stokes_recipe(setup.correlation_types, stokes, selection.either_hand ? Hands::either : Hands::both));
    } catch (const std::runtime_error& error) {
      throw std::runtime_error(path + ", DATA_DESC_ID " + std::to_string(setup.data_description) + ": " + error.what());
    }
  }
  return opened;
}

/// Sorts sets by the time of observation, so that nothing depends on the order in which they are named.
void sort_by_time(OpenSets& sets) {
  const auto key = [](const std::shared_ptr<const OpenSet>& set) {
    double lowest_hz = std::numeric_limits<double>::infinity();
    for (const Setup& setup : set->selected.setups)
      lowest_hz = std::min(lowest_hz, *std::min_element(setup.frequency_hz.begin(), setup.frequency_hz.end()));
    return std::pair(first_time_s(*set), lowest_hz);
  };
  if (sets.size() == 1) return;
  std::stable_sort(sets.begin(), sets.end(), [&](const auto& a, const auto& b) { return key(a) < key(b); });
}

/// Samples of the largest group of blocks.
std::uint64_t largest_group(const SelectedRows& selected) {
  std::uint64_t most = 0;
  for (std::size_t first = 0; first < selected.blocks.size();) {
    std::uint64_t samples = 0;
    for (const std::size_t end = first + block_group(selected, first).blocks; first < end; ++first) {
      const BlockRows& block = selected.blocks[first];
      samples += block.rows * selected.setups[block.setup].frequency_hz.size();
    }
    most = std::max(most, samples);
  }
  return most;
}

/// The columns named in `names`, separated by commas, one for each of `sets`.
std::vector<std::string> columns_of(const std::string& names, std::size_t sets) {
  std::vector<std::string> columns(1);
  for (const char c : names) {
    if (c == ',') {
      columns.emplace_back();
    } else {
      columns.back() += c;
    }
  }
  if (columns.size() == 1) columns.assign(sets, names);
  if (columns.size() == sets) return columns;
  throw std::runtime_error("--datacolumn '" + names + "' names " + std::to_string(columns.size()) + " columns; expected one" +
                           (sets == 1 ? "" : ", or one for each of " + std::to_string(sets) + " sets"));
}

/// The blocks of one set after the other.
class JoinedStream : public imager::BlockStream {
 public:
  explicit JoinedStream(OpenSets sets) : sets_(std::move(sets)) {}

  std::shared_ptr<const imager::VisibilityBlock> next() override {
    for (; next_ < sets_.size(); ++next_, stream_.reset()) {
      if (!stream_) stream_ = read_blocks(sets_[next_]);
      if (auto block = stream_->next()) return block;
    }
    return nullptr;
  }

 private:
  OpenSets sets_;
  std::size_t next_ = 0;  ///< set
  std::unique_ptr<imager::BlockStream> stream_;
};

}  // namespace

std::string named_columns(const std::vector<std::string>& paths, const std::string& data_column) {
  std::vector<std::string> columns = columns_of(data_column, paths.size());
  for (std::size_t i = 0; i < paths.size(); ++i)
    columns[i] = column_name(open_measurement_set(paths[i], Access::read), columns[i]);
  if (std::all_of(columns.begin(), columns.end(), [&](const std::string& one) { return one == columns.front(); }))
    columns.resize(1);
  std::string names;
  for (const std::string& column : columns) names += (names.empty() ? "" : ",") + column;
  return names;
}

struct MeasurementSet::Impl {
  OpenSets sets;
  Selection selection;
  imager::Observation observation;
  std::vector<std::string> remarks;
  std::shared_ptr<const SightTable> sights;  ///< null where they are not asked for
  std::shared_ptr<const Impl> whole;         ///< of which this is the share of a rank; null where it is all
  const imager::Ranks* ranks = &imager::alone();
  SampleSharing sharing;  ///< empty where it is all
};

MeasurementSet::MeasurementSet(const std::string& path, const Selection& selection, const std::string& data_column,
                               const std::vector<imager::Stokes>& stokes, std::uint64_t block_samples)
    : MeasurementSet(std::vector<std::string>{path}, selection, data_column, stokes, block_samples) {}

MeasurementSet::MeasurementSet(const std::vector<std::string>& paths, const Selection& selection,
                               const std::string& data_column, const std::vector<imager::Stokes>& stokes,
                               std::uint64_t block_samples) {
  if (paths.empty()) throw std::invalid_argument("no MeasurementSet; expected one or more");
  const auto impl = std::make_shared<Impl>();
  require_one_or_each(selection, paths.size());
  impl->selection = selection;
  const std::vector<std::string> columns = columns_of(data_column, paths.size());
  for (std::size_t i = 0; i < paths.size(); ++i)
    impl->sets.push_back(open_selected({paths[i], i}, selection, columns[i], stokes, block_samples));
  sort_by_time(impl->sets);
  const std::vector<std::string> roundings = shift_from_rounding(impl->sets, impl->selection, [&](const OpenSet& set) {
    return open_selected({set.path, set.place}, impl->selection, set.data_column, stokes, block_samples);
  });
  if (!impl->selection.phase_centre) impl->selection.phase_centre = impl->sets.front()->selected.phase_centre;
  impl->observation = joined(impl->sets);
  impl->remarks = remarks_on(impl->sets, selection, impl->observation);
  impl->remarks.insert(impl->remarks.end(), roundings.begin(), roundings.end());
  if (selection.sights)
    impl->sights = std::make_shared<SightTable>(
        number_sights(impl->sets, impl->observation.phase_centre, selection.pointing_tolerance_rad, impl->remarks));
  impl_ = impl;
}

MeasurementSet::MeasurementSet(std::shared_ptr<const Impl> impl) : impl_(std::move(impl)) {}

MeasurementSet::~MeasurementSet() = default;

const MeasurementSet::Impl& MeasurementSet::whole() const {
  return impl_->whole ? *impl_->whole : *impl_;
}

const Selection& MeasurementSet::selection() const {
  return impl_->selection;
}
const std::vector<std::string>& MeasurementSet::remarks() const {
  return impl_->remarks;
}
const imager::Observation& MeasurementSet::observation() const {
  return impl_->observation;
}
std::vector<imager::Stokes> MeasurementSet::seen_stokes() const {
  std::vector<int> types;
  for (const auto& set : whole().sets)
    for (const Setup& setup : set->selected.setups)
      types.insert(types.end(), setup.correlation_types.begin(), setup.correlation_types.end());
  return seen_by(types);
}
std::optional<imager::SkyDirection> MeasurementSet::followed_at(const std::string& utc) const {
  return ms_io::followed_at(*whole().sets.front(), utc);
}
std::vector<std::string> MeasurementSet::incomplete_columns() const {
  std::vector<std::string> sentences;
  for (const auto& set : whole().sets)
    if (std::string sentence = incomplete_column(set->path, set->data_column); !sentence.empty())
      sentences.push_back(std::move(sentence));
  return sentences;
}
std::vector<DataColumn> MeasurementSet::data_columns() const {
  std::vector<DataColumn> columns;
  for (const auto& set : whole().sets) {
    columns.push_back({set->path, set->data_column, {}, visibility_columns(set->set)});
    for (const SubtractedModel& one : subtracted_models(set->set, set->data_column))
      columns.back().subtracted.push_back(one.command);
  }
  return columns;
}
std::vector<ZeroColumn> MeasurementSet::columns_of_zeros(const imager::Ranks& ranks) const {
  std::vector<ZeroColumn> columns;
  for (const auto& set : whole().sets)  // whose parts learn for it
    if (Zeros zeros = set->filled->zeros(ranks); !zeros.none())
      columns.push_back({set->path, set->data_column, std::move(zeros)});
  return columns;
}
std::vector<imager::Stokes> MeasurementSet::correlations() const {
  std::set<imager::Stokes> stored;
  for (const auto& set : whole().sets)
    for (const Setup& setup : set->selected.setups)
      for (const int code : setup.correlation_types)
        if (imager::is_stokes_code(code)) stored.insert(static_cast<imager::Stokes>(code));
  return {stored.begin(), stored.end()};
}
std::vector<std::string> MeasurementSet::changed_files() const {
  std::vector<std::string> paths;
  for (const auto& set : whole().sets) {
    const std::vector<std::string> some = set->files.changed();
    paths.insert(paths.end(), some.begin(), some.end());
  }
  return paths;
}
std::uint64_t MeasurementSet::rows() const {
  std::uint64_t rows = 0;
  for (const auto& set : impl_->sets) rows += set->selected.rows;
  return rows;
}
std::uint64_t MeasurementSet::samples() const {
  std::uint64_t samples = 0;
  for (const auto& set : impl_->sets) samples += set->selected.samples;
  return samples;
}
std::uint64_t MeasurementSet::read_at_once() const {
  std::uint64_t most = 0;
  for (const auto& set : impl_->sets) most = std::max(most, largest_group(set->selected));
  return most;
}
std::vector<FieldPointing> MeasurementSet::field_pointings() const {
  std::vector<FieldPointing> all;
  for (const auto& set : whole().sets)
    for (FieldPointing& pointing : ms_io::field_pointings(*set, impl_->observation.phase_centre))
      all.push_back(std::move(pointing));
  return all;
}
double MeasurementSet::beam_offset_rad() const {
  double largest = 0;
  for (const auto& set : whole().sets) largest = std::max(largest, ms_io::beam_offset_rad(*set));
  return largest;
}
BeamRows MeasurementSet::beam_rows() const {
  const auto add_rows = [&](const OpenSets& sets, BeamRows& rows) {
    for (const auto& set : sets) add_beam_rows(*set, impl_->observation.phase_centre, rows);
  };
  BeamRows rows;
  add_rows(whole().sets, rows);
  if (impl_->whole) {  // sorts are numbered alike on all ranks, and rows are this one's
    BeamRows own;
    own.sorts = rows.sorts;
    add_rows(impl_->sets, own);
    rows.pairs = std::move(own.pairs);
  }
  if (rows.sorts.size() <= 1) rows.pairs = {};
  return rows;
}
std::vector<imager::AntennaSort> MeasurementSet::antennas() const {
  return antenna_sorts(*whole().sets.front());
}
const SightTable& MeasurementSet::sight_table() const {
  if (!impl_->sights) throw std::logic_error("sights of rows were not asked for; expected a Selection with sights");
  return *impl_->sights;
}
std::vector<float> MeasurementSet::zenith_turns() const {
  std::vector<float> turns;
  for (const auto& set : impl_->sets) {
    const std::vector<float> of_set = ms_io::zenith_turns(*set, impl_->observation.phase_centre);
    turns.insert(turns.end(), of_set.begin(), of_set.end());
  }
  return turns;
}
std::vector<SetSummary> MeasurementSet::summaries() const {
  std::vector<SetSummary> all;
  for (const auto& set : whole().sets) all.push_back(summary_of(*set));
  return all;
}
SetReach MeasurementSet::reach(ReachOf rows) const {
  SetReach all;
  for (const auto& set : impl_->sets) all.join(scan_uvw(*set, rows));
  for (double* most : {&all.max_abs_u, &all.max_abs_v, &all.max_abs_w, &all.longest_m, &all.longest_lambda})
    *most = imager::largest_of(ranks(), *most);
  for (double* least : {&all.shortest_m, &all.shortest_lambda}) *least = -imager::largest_of(ranks(), -*least);
  return all;
}
std::vector<SpectralWindow> MeasurementSet::spectral_windows() const {
  std::vector<SpectralWindow> windows;
  for (const auto& set : whole().sets) {
    std::vector<const Setup*> setups;
    for (const Setup& setup : set->selected.setups) setups.push_back(&setup);
    std::stable_sort(setups.begin(), setups.end(), [](const Setup* a, const Setup* b) { return a->place < b->place; });
    for (const Setup* setup : setups) windows.push_back(window_at_first_row(*set, *setup));
  }
  return windows;
}
void MeasurementSet::visit_coordinates(const std::function<void(const imager::SampleCoordinates&)>& visit) const {
  for (const auto& set : impl_->sets) visit_uvw(*set, visit);
}
std::unique_ptr<MeasurementSet> MeasurementSet::part(const FrequencyRange& range,
                                                     const std::optional<FrequencyRange>& counted) const {
  const auto part = std::make_shared<Impl>();
  part->selection = impl_->selection;
  part->observation = impl_->observation;
  part->sights = impl_->sights;
  for (const auto& set : impl_->sets)
    if (auto some = channels_between(*set, range, counted)) part->sets.push_back(std::move(some));
  if (part->sets.empty()) return nullptr;
  return std::unique_ptr<MeasurementSet>(new MeasurementSet(part));
}
std::unique_ptr<MeasurementSet> MeasurementSet::share(const imager::Ranks& ranks) const {
  const auto share = std::make_shared<Impl>();
  const RowShares shares(impl_->sets, ranks.size());
  share->sets = shares.part(ranks.rank());
  share->selection = impl_->selection;
  share->observation = impl_->observation;
  share->remarks = impl_->remarks;
  share->sights = impl_->sights;
  share->whole = impl_;
  share->ranks = &ranks;
  share->sharing = {shares.samples(), impl_->sets.size(), shares.whole_sets()};
  return std::unique_ptr<MeasurementSet>(new MeasurementSet(share));
}
const imager::Ranks& MeasurementSet::ranks() const {
  return *impl_->ranks;
}
SampleSharing MeasurementSet::sharing() const {
  return impl_->whole ? impl_->sharing : SampleSharing{{samples()}, impl_->sets.size(), true};
}
std::unique_ptr<imager::BlockStream> MeasurementSet::open() const {
  return std::make_unique<JoinedStream>(impl_->sets);
}

}  // namespace misfit::ms_io
