#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <future>
#include <utility>

#include "ms_io/block_group_internal.h"
#include "ms_io/column_reader_internal.h"
#include "ms_io/row_sights_internal.h"
#include "ms_io/visibility_reader_internal.h"

namespace misfit::ms_io {
namespace {

/// Samples read from the table at once: enough for another thread to be worth its start, and for the whole of small tables,
/// which casacore reads faster than ranges of them; few enough that they are still in the cache when Stokes parameters are
/// formed.
constexpr std::uint64_t piece_samples = 1 << 17;

/// A block to which rows are appended.
class GrowingBlock {
 public:
  GrowingBlock(const Setup& setup, const StokesRecipe& recipe, std::uint64_t rows) : setup_(setup), recipe_(recipe) {
    const std::size_t samples = rows * setup.frequency_hz.size();
    imager::VisibilityBlock& block = *block_;
    block.visibility.resize(recipe.terms.size() * samples);
    for (std::size_t i = 0; i < recipe.terms.size(); ++i) next_.visibility[i] = block.visibility.data() + i * samples;
    block.frequency_hz = setup.frequency_hz;
    block.channel_width_hz = setup.channel_width_hz;
    block.uvw_m.edit().resize(rows * 3);
    block.weight.resize(samples);
    find_counted();
    if (!setup.shift.moves()) setup.shift.append(nullptr, rows, shifts_);
    block.counts.rows_read = setup.uncounted.count == 0 ? rows : 0;
    block.counts.samples_read = rows * counted_channels_;
    next_uvw_m_ = block.uvw_m.edit().data();
    next_.weight = block.weight.data();
  }

  /// Appends the Stokes parameters of `count` rows, of which `first` is the first of `stored`.
  void append(const StoredRows& stored, std::size_t first, std::size_t count) {
    imager::SampleCounts& counts = block_->counts;
    const std::size_t channels = setup_.frequency_hz.size(), cell = recipe_.correlations * setup_.channel_span();
    append_some(stored.frame_ratio, first, count, block_->frame_ratio);
    append_some(stored.sights, first, count, block_->sights);
    if (setup_.shift.moves()) setup_.shift.append(stored.time_s.data() + first, count, shifts_);
    const std::size_t weight_cell = stored.weight_per_channel ? cell : recipe_.correlations;
    const int* const antenna1 = stored.antenna1.data();
    const int* const antenna2 = stored.antenna2.data();
    const bool* const flag_row = stored.flag_row.data();
    for (std::size_t r = first; r < first + count; ++r) {
      const double* const uvw = stored.uvw.data() + 3 * r;
      next_uvw_m_ = std::copy_n(uvw, 3, next_uvw_m_);
      if (antenna1[r] == antenna2[r]) {
        counts.autocorrelations += counted_channels_;
        advance(channels);
      } else if (flag_row[r]) {
        counts.flagged += counted_channels_;
        advance(channels);
      } else {
        form_row({stored.data.data() + r * cell, stored.flag.data() + r * cell, stored.weight.data() + r * weight_cell,
                  stored.weight_per_channel, std::isfinite(uvw[0]) && std::isfinite(uvw[1]) && std::isfinite(uvw[2]),
                  channels});
      }
    }
  }

  /// The block, shifted to the phase centre of the image.
  std::shared_ptr<const imager::VisibilityBlock> finish() {
    shifts_.apply(*block_);
    return block_;
  }

 private:
  /// Appends the values of `count` rows from `first` on, where rows have any.
  template <typename T>
  static void append_some(const std::vector<T>& of_rows, std::size_t first, std::size_t count, std::vector<T>& to) {
    if (of_rows.empty()) return;
    const auto begin = of_rows.begin() + static_cast<std::ptrdiff_t>(first);
    to.insert(to.end(), begin, begin + static_cast<std::ptrdiff_t>(count));
  }

  /// Cuts the runs of selected channels where samples begin or cease to be counted.
  void find_counted() {
    const std::uint64_t begin = setup_.uncounted.first, end = begin + setup_.uncounted.count;
    const auto add = [&](std::uint64_t first, std::uint64_t last, bool counted) {
      if (first >= last) return;
      runs_.push_back({{first, last - first}, counted});
      if (counted) counted_channels_ += last - first;
    };
    for (const Run& run : setup_.channels) {
      const std::uint64_t last = run.first + run.count;
      const std::uint64_t cut = std::clamp(begin, run.first, last), next = std::clamp(end, cut, last);
      add(run.first, cut, true);
      add(cut, next, false);
      add(next, last, true);
    }
  }

  /// Forms one row, a run of selected channels at a time.
  void form_row(const StoredSamples& row) {
    imager::SampleCounts uncounted;
    for (const auto& [run, counted] : runs_) {
      const std::size_t offset = (run.first - setup_.first_channel()) * recipe_.correlations;
      StoredSamples part = row;
      part.data += offset;
      part.flag += offset;
      if (row.weight_per_channel) part.weight += offset;
      part.channels = run.count;
      form_stokes(recipe_, part, next_, counted ? block_->counts : uncounted);
      advance(run.count);
    }
  }

  void advance(std::size_t samples) {
    for (std::size_t i = 0; i < recipe_.terms.size(); ++i) next_.visibility[i] += samples;
    next_.weight += samples;
  }

  struct CountedRun {
    Run channels;
    bool counted = true;
  };

  const Setup& setup_;
  const StokesRecipe& recipe_;
  std::vector<CountedRun> runs_;
  std::size_t counted_channels_ = 0;
  std::shared_ptr<imager::VisibilityBlock> block_ = std::make_shared<imager::VisibilityBlock>();
  StokesSamples next_;  ///< where the next samples go
  double* next_uvw_m_;
  imager::RowShifts shifts_;
};

/// Reads a group of blocks at once, a piece of their rows at a time, and hands them out one by one.
class Reader : public imager::BlockStream {
 public:
  explicit Reader(std::shared_ptr<const OpenSet> source) : source_(std::move(source)), columns_(source_) {
    if (source_->sights) sights_ = std::make_unique<SightReader>(*source_, source_->sights);
  }

  std::shared_ptr<const imager::VisibilityBlock> next() override {
    if (growing_.empty()) {
      if (next_ == source_->selected.blocks.size()) return nullptr;
      read_group();
    }
    auto block = growing_.front().finish();
    growing_.pop_front();
    return block;
  }

 private:
  /// Reads a group. While this thread reads, as casacore allows one thread only, another makes the blocks and fills them.
  void read_group() {
    const SelectedRows& selected = source_->selected;
    const BlockGroup group = block_group(selected, next_);
    const Setup& alike = selected.setups[selected.blocks[next_].setup];
    const auto group_begin = selected.blocks.begin() + static_cast<std::ptrdiff_t>(next_);
    auto beside = std::async(std::launch::async, [this, first = next_, count = group.blocks] { make_blocks(first, count); });
    next_ += group.blocks;
    std::uint64_t left = group.rows;
    const std::uint16_t* owner = group.blocks == 1 ? nullptr : group.owner.data();  // of the next row
    StoredRows *read = &stored_.front(), *other = &stored_.back();
    for (const Rows& piece : pieces(group.runs, std::max<std::uint64_t>(1, piece_samples / alike.channel_span()))) {
      const std::uint64_t rows = piece.count();
      columns_.read_rows(piece, alike, *read);
      if (sights_)
        translated("cannot read antennas, fields or times of " + source_->path, [&] { read->sights = sights_->sights(piece); });
      if (source_->filled->in_doubt()) look_for_data(group_begin, piece, owner, *read);
      beside.get();
      left -= rows;
      if (left == 0) return form(*read, owner, rows);
      beside = std::async(std::launch::async, [this, read, owner, rows] { form(*read, owner, rows); });
      std::swap(read, other);
      if (owner != nullptr) owner += rows;
    }
  }

  /// Looks for data in the usable rows of a piece, which belong to blocks from `group` on.
  void look_for_data(std::vector<BlockRows>::const_iterator group, const Rows& piece, const std::uint16_t* owner,
                     const StoredRows& stored) {
    translated("cannot read FIELD_ID of " + source_->path,
               [&] { read(casacore::ScalarColumn<int>(source_->set, "FIELD_ID"), piece, field_); });
    const std::size_t cell = stored.data.size() / piece.count();
    for (std::uint64_t r = 0; r < piece.count(); ++r) {
      if (stored.flag_row.data()[r] || stored.antenna1.data()[r] == stored.antenna2.data()[r]) continue;
      const Setup& setup = source_->selected.setups[group[owner == nullptr ? 0 : owner[r]].setup];
      source_->filled->look_at(setup.data_description, field_.data()[r],
                               {stored.data.data() + r * cell, stored.flag.data() + r * cell, cell});
    }
  }

  void make_blocks(std::size_t first, std::size_t count) {
    for (std::size_t b = first; b < first + count; ++b) {
      const BlockRows& block = source_->selected.blocks[b];
      growing_.emplace_back(source_->selected.setups[block.setup], source_->recipes[block.setup], block.rows);
    }
  }

  /// Deals `rows` rows to the blocks that own them; null where there is one block.
  void form(const StoredRows& stored, const std::uint16_t* owner, std::uint64_t rows) {
    if (owner == nullptr) return growing_.front().append(stored, 0, rows);
    for (std::uint64_t row = 0; row < rows; ++row) growing_[owner[row]].append(stored, row, 1);
  }

  std::shared_ptr<const OpenSet> source_;
  ColumnReader columns_;
  std::unique_ptr<SightReader> sights_;  ///< null where they are not asked for
  std::array<StoredRows, 2> stored_;     ///< one is read while Stokes parameters are formed of the other
  casacore::Vector<int> field_;          ///< [row] of the piece read last, where it was looked at
  std::size_t next_ = 0;                 ///< block to be read
  std::deque<GrowingBlock> growing_;     ///< of the group read last, those not yet handed out
};

}  // namespace

std::unique_ptr<imager::BlockStream> read_blocks(std::shared_ptr<const OpenSet> open_set) {
  return std::make_unique<Reader>(std::move(open_set));
}

}  // namespace misfit::ms_io
