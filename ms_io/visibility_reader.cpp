#include <algorithm>
#include <cmath>
#include <deque>
#include <utility>

#include "ms_io/block_group_internal.h"
#include "ms_io/column_reader_internal.h"
#include "ms_io/visibility_reader_internal.h"

namespace misfit::ms_io {
namespace {

/// Samples read from the table at once: few enough that they are still in the cache when Stokes parameters are formed.
constexpr std::uint64_t piece_samples = 1 << 16;

/// Tables of no more samples are read at once, since casacore reads whole columns faster than ranges of them.
constexpr std::uint64_t whole_samples = 1 << 17;

std::uint64_t rows_of_piece(std::uint64_t rows, const Setup& setup) {
  if (rows * setup.channel_span() <= whole_samples) return rows;
  return std::max<std::uint64_t>(1, piece_samples / setup.channel_span());
}

/// A block to which rows are appended, and those of the other Stokes parameters.
class GrowingBlock {
 public:
  GrowingBlock(const Setup& setup, const StokesRecipe& recipe, std::uint64_t rows) : setup_(setup), recipe_(recipe) {
    const std::size_t samples = rows * setup.frequency_hz.size();
    for (std::size_t i = 0; i < recipe.terms.size(); ++i) {
      blocks_.push_back(std::make_shared<imager::VisibilityBlock>());
      blocks_.back()->visibility.reserve(samples);
    }
    imager::VisibilityBlock& block = *blocks_.front();
    block.frequency_hz = setup.frequency_hz;
    block.uvw_m.reserve(rows * 3);
    block.weight.reserve(samples);
    block.counts.rows_read = rows;
    block.counts.samples_read = samples;
  }

  /// Appends the Stokes parameters of `count` rows, of which `first` is the first of `stored`.
  void append(const StoredRows& stored, std::size_t first, std::size_t count) {
    const std::size_t channels = setup_.frequency_hz.size(), cell = recipe_.correlations * setup_.channel_span();
    const std::size_t weight_cell = stored.weight_per_channel ? cell : recipe_.correlations;
    imager::VisibilityBlock& block = *blocks_.front();
    const std::size_t before = block.weight.size();
    for (const auto& stokes : blocks_) stokes->visibility.resize(before + count * channels);
    block.weight.resize(before + count * channels);
    block.uvw_m.insert(block.uvw_m.end(), stored.uvw.data() + 3 * first, stored.uvw.data() + 3 * (first + count));
    const int* const antenna1 = stored.antenna1.data();
    const int* const antenna2 = stored.antenna2.data();
    const bool* const flag_row = stored.flag_row.data();
    for (std::size_t i = 0; i < count; ++i) {
      const std::size_t r = first + i;
      if (antenna1[r] == antenna2[r]) {
        block.counts.autocorrelations += channels;
      } else if (flag_row[r]) {
        block.counts.flagged += channels;
      } else {
        const double* const uvw = stored.uvw.data() + 3 * r;
        form_row({stored.data.data() + r * cell, stored.flag.data() + r * cell, stored.weight.data() + r * weight_cell,
                  stored.weight_per_channel, std::isfinite(uvw[0]) && std::isfinite(uvw[1]) && std::isfinite(uvw[2]), channels},
                 before + i * channels);
      }
    }
  }

  /// The block, with the others, as the phase centre of the image sees them.
  std::shared_ptr<const imager::VisibilityBlock> finish() {
    imager::VisibilityBlock& first = *blocks_.front();
    for (std::size_t i = 1; i < blocks_.size(); ++i) {
      static_cast<imager::SampleCoordinates&>(*blocks_[i]) = first;
      blocks_[i]->weight = first.weight;
      blocks_[i]->counts = first.counts;
      first.other_stokes.push_back(blocks_[i]);
    }
    for (const auto& stokes : blocks_) setup_.shift.apply(*stokes);
    return blocks_.front();
  }

 private:
  /// One row, a run of selected channels at a time, to samples from `sample` on.
  void form_row(const StoredSamples& row, std::size_t sample) {
    imager::VisibilityBlock& block = *blocks_.front();
    StokesSamples out;
    for (std::size_t i = 0; i < blocks_.size(); ++i) out.visibility[i] = blocks_[i]->visibility.data() + sample;
    out.weight = block.weight.data() + sample;
    for (const Run& run : setup_.channels) {
      const std::size_t offset = (run.first - setup_.first_channel()) * recipe_.correlations;
      StoredSamples part = row;
      part.data += offset;
      part.flag += offset;
      if (row.weight_per_channel) part.weight += offset;
      part.channels = run.count;
      form_stokes(recipe_, part, out, block.counts);
      for (std::size_t i = 0; i < blocks_.size(); ++i) out.visibility[i] += run.count;
      out.weight += run.count;
    }
  }

  const Setup& setup_;
  const StokesRecipe& recipe_;
  std::vector<std::shared_ptr<imager::VisibilityBlock>> blocks_;  ///< [Stokes parameter]
};

/// Reads a group of blocks at once, a piece of their rows at a time, and hands them out one by one.
class Reader : public imager::BlockStream {
 public:
  explicit Reader(std::shared_ptr<const OpenSet> source) : source_(std::move(source)), columns_(source_) {}

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
  void read_group() {
    const SelectedRows& selected = source_->selected;
    const BlockGroup group = block_group(selected, next_);
    const Setup& alike = selected.setups[selected.blocks[next_].setup];
    std::uint64_t all_rows = 0;
    for (std::size_t i = 0; i < group.blocks; ++i) {
      const BlockRows& rows = selected.blocks[next_++];
      all_rows += rows.rows;
      growing_.emplace_back(selected.setups[rows.setup], source_->recipes[rows.setup], rows.rows);
    }
    auto share = group.shares.begin();
    std::uint64_t taken = 0;  // of that share
    for (const Rows& piece : pieces(group.runs, rows_of_piece(all_rows, alike))) {
      const StoredRows& stored = columns_.read_rows(piece, alike);
      for (std::uint64_t row = 0; row < piece.count();) {
        const std::uint64_t count = std::min(share->rows - taken, piece.count() - row);
        growing_[share->block].append(stored, row, count);
        row += count;
        taken += count;
        if (taken < share->rows) continue;
        ++share;
        taken = 0;
      }
    }
  }

  std::shared_ptr<const OpenSet> source_;
  ColumnReader columns_;
  std::size_t next_ = 0;              ///< block to be read
  std::deque<GrowingBlock> growing_;  ///< of the group read last, those not yet handed out
};

}  // namespace

std::unique_ptr<imager::BlockStream> read_blocks(std::shared_ptr<const OpenSet> open_set) {
  return std::make_unique<Reader>(std::move(open_set));
}

}  // namespace misfit::ms_io
