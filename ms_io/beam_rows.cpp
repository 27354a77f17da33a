#include <casacore/casa/Arrays/Matrix.h>
#include <casacore/tables/Tables/ArrayColumn.h>
#include <casacore/tables/Tables/ScalarColumn.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "ms_io/beam_rows_internal.h"
#include "ms_io/field_pointings_internal.h"
#include "ms_io/metadata_internal.h"
#include "ms_io/row_columns_internal.h"

namespace misfit::ms_io {
namespace {

constexpr std::uint64_t piece_rows = 1 << 16;

/// As ANTENNA lists them.
std::vector<imager::AntennaSort> listed_antennas(const OpenSet& open_set) {
  const std::string telescope = telescope_name(open_set.set, observation_of(open_set.set, open_set.selected.first_row));
  const casacore::Vector<double> diameter_m =
      casacore::ScalarColumn<double>(open_set.set.antenna(), "DISH_DIAMETER").getColumn();
  const casacore::Vector<casacore::String> name =
      casacore::ScalarColumn<casacore::String>(open_set.set.antenna(), "NAME").getColumn();
  std::vector<imager::AntennaSort> sorts;
  for (std::size_t a = 0; a < diameter_m.nelements(); ++a) sorts.push_back({telescope, diameter_m(a), name(a)});
  return sorts;
}

/// The antennas of a set, by what their beams depend on.
class Antennas {
 public:
  Antennas(const OpenSet& open_set, BeamRows& rows)
      : path_(open_set.path),
        listed_(listed_antennas(open_set)),
        sort_(listed_.size(), unknown),
        feeds_(listed_.size()),
        rows_(rows) {}

  /// Notes that an antenna was used with a feed. Returns its sort.
  std::uint8_t use(int antenna, int feed) {
    if (antenna < 0 || static_cast<std::size_t>(antenna) >= sort_.size())
      throw std::runtime_error(path_ + " has rows of antenna " + std::to_string(antenna) + ", but ANTENNA has " +
                               std::to_string(sort_.size()) + " rows");
    const auto a = static_cast<std::size_t>(antenna);
    if (sort_[a] == unknown) sort_[a] = find_sort(a);
    if (feeds_[a].empty() || feeds_[a].back() != feed) feeds_[a].push_back(feed);
    return static_cast<std::uint8_t>(sort_[a]);
  }

  bool uses(int antenna, int feed) const {
    const auto has = [feed](const std::vector<int>& feeds) {
      return std::find(feeds.begin(), feeds.end(), feed) != feeds.end();
    };
    if (antenna < 0) return std::any_of(feeds_.begin(), feeds_.end(), has);  // a row of FEED for all
    return static_cast<std::size_t>(antenna) < feeds_.size() && has(feeds_[static_cast<std::size_t>(antenna)]);
  }

  /// Feeds that rows use by turns are noted once.
  void forget_repetitions() {
    for (std::vector<int>& feeds : feeds_) {
      const std::set<int> different(feeds.begin(), feeds.end());
      feeds.assign(different.begin(), different.end());
    }
  }

 private:
  static constexpr int unknown = -1;

  int find_sort(std::size_t antenna) {
    constexpr std::size_t most = 256;
    for (std::size_t s = 0; s < rows_.sorts.size(); ++s)
      if (imager::alike(rows_.sorts[s], listed_[antenna])) return static_cast<int>(s);
    if (rows_.sorts.size() == most)
      throw std::runtime_error(path_ + ": antennas of more than " + std::to_string(most) +
                               " different diameters; expected a few sorts of dishes");
    rows_.sorts.push_back(listed_[antenna]);
    return static_cast<int>(rows_.sorts.size() - 1);
  }

  std::string path_;
  std::vector<imager::AntennaSort> listed_;
  std::vector<int> sort_;                ///< [antenna]
  std::vector<std::vector<int>> feeds_;  ///< [antenna], in use
  BeamRows& rows_;
};

/// [FIELD_ID]
using RowsOfFields = std::map<int, std::vector<SortRows>>;

void count_row(const SortPair& pair, std::vector<SortRows>& rows) {
  for (SortRows& some : rows)
    if (some.pair.one == pair.one && some.pair.other == pair.other) {
      ++some.rows;
      return;
    }
  rows.push_back({pair, 1});
}

/// Returns how many rows of two antennas each field has.
RowsOfFields add_pairs(const OpenSet& open_set, Antennas& antennas, BeamRows& rows) {
  const casacore::ScalarColumn<int> columns[] = {{open_set.set, "ANTENNA1"},
                                                 {open_set.set, "ANTENNA2"},
                                                 {open_set.set, "FEED1"},
                                                 {open_set.set, "FEED2"},
                                                 {open_set.set, "FIELD_ID"}};
  casacore::Vector<int> values[5];
  RowsOfFields of_fields;
  for (const BlockRows& block : open_set.selected.blocks) {
    for (const Rows& piece : pieces(block.runs, piece_rows)) {
      for (std::size_t c = 0; c < 5; ++c) read(columns[c], piece, values[c]);
      for (std::size_t r = 0; r < piece.count(); ++r) {
        SortPair& pair = rows.pairs.emplace_back();
        if (values[0](r) == values[1](r)) continue;  // of an antenna with itself nothing is imaged
        pair = {antennas.use(values[0](r), values[2](r)), antennas.use(values[1](r), values[3](r))};
        count_row(pair, of_fields[values[4](r)]);
      }
      antennas.forget_repetitions();
    }
  }
  return of_fields;
}

/// The offsets that rows of FEED give for the windows that are selected, in the order of the table.
std::vector<FeedOffset> offsets_in(const OpenSet& open_set) {
  const casacore::Table& feed = open_set.set.feed();
  const casacore::ScalarColumn<int> antenna(feed, "ANTENNA_ID"), id(feed, "FEED_ID"), window(feed, "SPECTRAL_WINDOW_ID");
  const casacore::ArrayColumn<double> offset(feed, "BEAM_OFFSET");
  const std::vector<Setup>& setups = open_set.selected.setups;
  std::vector<FeedOffset> offsets;
  for (casacore::rownr_t r = 0; r < feed.nrow(); ++r) {
    const bool selected = window(r) < 0 || std::any_of(setups.begin(), setups.end(),
                                                       [&](const Setup& setup) { return setup.spectral_window == window(r); });
    if (!selected || !offset.isDefined(r) || offset.ndim(r) != 2 || offset.shape(r)(0) != 2 || offset.shape(r)(1) == 0)
      continue;
    const casacore::Matrix<double> of_receptors = offset(r);
    FeedOffset mean{id(r), 0, 0, antenna(r), open_set.path};
    for (std::size_t k = 0; k < of_receptors.ncolumn(); ++k) {
      mean.x_rad += of_receptors(0, k) / static_cast<double>(of_receptors.ncolumn());
      mean.y_rad += of_receptors(1, k) / static_cast<double>(of_receptors.ncolumn());
    }
    offsets.push_back(mean);
  }
  return offsets;
}

void add_beam_offsets(const OpenSet& open_set, const Antennas& antennas, BeamRows& rows) {
  for (const FeedOffset& offset : offsets_in(open_set)) {
    const auto is_this = [&](const FeedOffset& other) {
      return other.set == offset.set && other.feed == offset.feed && other.x_rad == offset.x_rad && other.y_rad == offset.y_rad;
    };
    if (antennas.uses(offset.antenna, offset.feed) && std::none_of(rows.feeds.begin(), rows.feeds.end(), is_this))
      rows.feeds.push_back(offset);
  }
}

}  // namespace

void add_beam_rows(const OpenSet& open_set, const imager::SkyDirection& centre, BeamRows& rows) {
  RowsOfFields of_fields = translated("cannot read ANTENNA, FEED, or the antennas of the rows of " + open_set.path, [&] {
    Antennas antennas(open_set, rows);
    RowsOfFields counted = add_pairs(open_set, antennas, rows);
    add_beam_offsets(open_set, antennas, rows);
    return counted;
  });
  for (FieldPointing& pointing : field_pointings(open_set, centre)) {
    pointing.rows = of_fields[pointing.id];
    rows.pointings.push_back(std::move(pointing));
  }
}

std::vector<imager::AntennaSort> antenna_sorts(const OpenSet& open_set) {
  return translated("cannot read ANTENNA of " + open_set.path, [&] { return listed_antennas(open_set); });
}

double beam_offset_rad(const OpenSet& open_set) {
  return translated("cannot read FEED of " + open_set.path, [&] {
    BeamRows all;
    all.feeds = offsets_in(open_set);
    return all.beam_offset_rad();
  });
}

}  // namespace misfit::ms_io
