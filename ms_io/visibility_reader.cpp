#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "ms_io/row_columns_internal.h"
#include "ms_io/visibility_reader_internal.h"

namespace misfit::ms_io {
namespace {

/// Samples read from the table at once: few enough that they are still in the cache when Stokes parameters are formed.
constexpr std::uint64_t piece_samples = 1 << 16;

/// The columns of the main table as they are read, a piece of rows at a time, into buffers that are used again.
class Reader : public imager::BlockStream {
 public:
  explicit Reader(std::shared_ptr<const OpenSet> source) : source_(std::move(source)) {
    translated("cannot read the columns of " + source_->path, [&] {
      const casacore::Table& table = source_->set;
      antenna1_column_.attach(table, "ANTENNA1");
      antenna2_column_.attach(table, "ANTENNA2");
      flag_row_column_.attach(table, "FLAG_ROW");
      uvw_column_.attach(table, "UVW");
      data_column_.attach(table, source_->data_column);
      flag_column_.attach(table, "FLAG");
      weight_column_.attach(table, "WEIGHT");
      has_spectrum_ = table.tableDesc().isColumn("WEIGHT_SPECTRUM");
      if (has_spectrum_) spectrum_column_.attach(table, "WEIGHT_SPECTRUM");
    });
  }

  std::shared_ptr<const imager::VisibilityBlock> next() override {
    if (next_ == source_->selected.blocks.size()) return nullptr;
    const BlockRows& rows = source_->selected.blocks[next_++];
    const Setup& setup = source_->selected.setups[rows.setup];
    const StokesRecipe& recipe = source_->recipes[rows.setup];
    const std::size_t samples = rows.rows * setup.frequency_hz.size();
    Blocks blocks;
    for (std::size_t i = 0; i < recipe.terms.size(); ++i) {
      blocks.push_back(std::make_shared<imager::VisibilityBlock>());
      blocks.back()->visibility.reserve(samples);
    }
    imager::VisibilityBlock& block = *blocks.front();
    block.frequency_hz = setup.frequency_hz;
    block.uvw_m.reserve(rows.rows * 3);
    block.weight.reserve(samples);
    for (const Rows& piece : pieces(rows.runs, std::max<std::uint64_t>(1, piece_samples / setup.channel_span()))) {
      read_piece(piece, setup, recipe.correlations);
      form_piece(piece, setup, recipe, blocks);
    }
    block.counts.rows_read = rows.rows;
    block.counts.samples_read = block.samples();
    share(blocks);
    for (const auto& stokes : blocks) setup.shift.apply(*stokes);
    return blocks.front();
  }

 private:
  /// One for each Stokes parameter.
  using Blocks = std::vector<std::shared_ptr<imager::VisibilityBlock>>;

  /// Gives the other blocks what they have in common with the first, and them to the first.
  static void share(const Blocks& blocks) {
    imager::VisibilityBlock& first = *blocks.front();
    for (std::size_t i = 1; i < blocks.size(); ++i) {
      static_cast<imager::SampleCoordinates&>(*blocks[i]) = first;
      blocks[i]->weight = first.weight;
      blocks[i]->counts = first.counts;
      first.other_stokes.push_back(blocks[i]);
    }
  }

  template <typename Action>
  void reading(const std::string& column, const Action& action) const {
    try {
      action();
    } catch (const casacore::AipsError& error) {
      throw std::runtime_error("cannot read " + column + " of " + source_->path + ": " + one_line(error.getMesg()));
    }
  }

  void require_shape(const std::string& column, const casacore::IPosition& found, const casacore::IPosition& expected) const {
    if (found.isEqual(expected)) return;
    std::ostringstream message;
    message << "cannot read " << column << " of " << source_->path << ": its cells do not have " << expected(0)
            << " correlations and " << expected(1) << " channels, as DATA_DESC_ID says they do";
    throw std::runtime_error(message.str());
  }

  void read_piece(const Rows& rows, const Setup& setup, std::size_t correlations) {
    reading("ANTENNA1", [&] { read(antenna1_column_, rows, antenna1_); });
    reading("ANTENNA2", [&] { read(antenna2_column_, rows, antenna2_); });
    reading("FLAG_ROW", [&] { read(flag_row_column_, rows, flag_row_); });
    reading("UVW", [&] { read(uvw_column_, rows, uvw_); });
    reading(source_->data_column, [&] { read_cells(source_->data_column, data_column_, rows, setup, correlations, data_); });
    reading("FLAG", [&] { read_cells("FLAG", flag_column_, rows, setup, correlations, flag_); });
    read_weights(rows, setup, correlations);
  }

  /// All the correlations of the channels needed. Reading every correlation is faster than a strided slice of two of four.
  template <typename T>
  void read_cells(const std::string& name, const casacore::ArrayColumn<T>& column, const Rows& rows, const Setup& setup,
                  std::size_t correlations, casacore::Array<T>& cells) const {
    const casacore::IPosition stored(2, static_cast<ssize_t>(correlations), static_cast<ssize_t>(setup.stored_channels));
    const casacore::rownr_t first = rows.numbers()(0);
    require_shape(name, column.isDefined(first) ? column.shape(first) : casacore::IPosition(2, 0, 0), stored);
    if (setup.channel_span() == setup.stored_channels) {
      read(column, rows, cells);
    } else {
      read(column, rows, channel_slice(setup, correlations), cells);
    }
  }

  bool spectrum_defined(casacore::rownr_t row) const {
    return spectrum_column_.isDefined(row) && spectrum_column_.shape(row).product() > 0;
  }

  /// WEIGHT_SPECTRUM where its cell is defined, else WEIGHT.
  void read_weights(const Rows& rows, const Setup& setup, std::size_t correlations) {
    std::size_t defined = 0;
    if (has_spectrum_) {
      reading("WEIGHT_SPECTRUM", [&] {
        if ((spectrum_column_.columnDesc().options() & casacore::ColumnDesc::FixedShape) != 0) {
          defined = rows.count();
        } else {
          for (const casacore::rownr_t row : rows.numbers()) defined += spectrum_defined(row);
        }
      });
    }
    weight_per_channel_ = defined > 0;
    if (defined == rows.count()) {
      reading("WEIGHT_SPECTRUM", [&] { read_cells("WEIGHT_SPECTRUM", spectrum_column_, rows, setup, correlations, weight_); });
      return;
    }
    reading("WEIGHT", [&] { read(weight_column_, rows, weight_); });
    if (weight_.shape()(0) != static_cast<ssize_t>(correlations)) {
      throw std::runtime_error("cannot read WEIGHT of " + source_->path + ": its cells have " +
                               std::to_string(weight_.shape()(0)) + " values; expected one for each of " +
                               std::to_string(correlations) + " correlations");
    }
    if (defined > 0) reading("WEIGHT_SPECTRUM", [&] { mix_weights(rows, setup, correlations); });
  }

  /// Spreads WEIGHT over the channels, and puts WEIGHT_SPECTRUM where it is defined.
  void mix_weights(const Rows& rows, const Setup& setup, std::size_t correlations) {
    const std::size_t span = setup.channel_span();
    casacore::Array<float> mixed(casacore::IPosition(3, static_cast<ssize_t>(correlations), static_cast<ssize_t>(span),
                                                     static_cast<ssize_t>(rows.count())));
    float* out = mixed.data();
    const float* weight = weight_.data();
    for (const casacore::rownr_t row : rows.numbers()) {
      if (spectrum_defined(row)) {
        const casacore::Array<float> cell = spectrum_column_.getSlice(row, channel_slice(setup, correlations));
        std::copy(cell.begin(), cell.end(), out);
      } else {
        for (std::size_t c = 0; c < span; ++c) std::copy_n(weight, correlations, out + c * correlations);
      }
      out += correlations * span;
      weight += correlations;
    }
    weight_.reference(mixed);
  }

  /// Appends the Stokes parameters of the piece read last to a block and those that go with it.
  void form_piece(const Rows& rows, const Setup& setup, const StokesRecipe& recipe, const Blocks& blocks) const {
    const std::size_t count = rows.count(), channels = setup.frequency_hz.size();
    const std::size_t cell = recipe.correlations * setup.channel_span();
    const std::size_t weight_cell = weight_per_channel_ ? cell : recipe.correlations;
    imager::VisibilityBlock& block = *blocks.front();
    const std::size_t before = block.weight.size();
    for (const auto& stokes : blocks) stokes->visibility.resize(before + count * channels);
    block.weight.resize(before + count * channels);
    block.uvw_m.insert(block.uvw_m.end(), uvw_.data(), uvw_.data() + 3 * count);
    const int* const antenna1 = antenna1_.data();
    const int* const antenna2 = antenna2_.data();
    const bool* const flag_row = flag_row_.data();
    for (std::size_t r = 0; r < count; ++r) {
      if (antenna1[r] == antenna2[r]) {
        block.counts.autocorrelations += channels;
      } else if (flag_row[r]) {
        block.counts.flagged += channels;
      } else {
        const double* const uvw = uvw_.data() + 3 * r;
        const StoredSamples row{data_.data() + r * cell,
                                flag_.data() + r * cell,
                                weight_.data() + r * weight_cell,
                                weight_per_channel_,
                                std::isfinite(uvw[0]) && std::isfinite(uvw[1]) && std::isfinite(uvw[2]),
                                channels};
        StokesSamples out;
        for (std::size_t i = 0; i < blocks.size(); ++i)
          out.visibility[i] = blocks[i]->visibility.data() + before + r * channels;
        out.weight = block.weight.data() + before + r * channels;
        form_row(setup, recipe, row, out, block.counts);
      }
    }
  }

  /// One row, a run of selected channels at a time.
  static void form_row(const Setup& setup, const StokesRecipe& recipe, const StoredSamples& row, StokesSamples out,
                       imager::SampleCounts& counts) {
    for (const Run& run : setup.channels) {
      const std::size_t offset = (run.first - setup.first_channel()) * recipe.correlations;
      StoredSamples part = row;
      part.data += offset;
      part.flag += offset;
      if (row.weight_per_channel) part.weight += offset;
      part.channels = run.count;
      form_stokes(recipe, part, out, counts);
      for (std::size_t i = 0; i < recipe.terms.size(); ++i) out.visibility[i] += run.count;
      out.weight += run.count;
    }
  }

  std::shared_ptr<const OpenSet> source_;
  std::size_t next_ = 0;  ///< block

  casacore::ScalarColumn<int> antenna1_column_, antenna2_column_;
  casacore::ScalarColumn<bool> flag_row_column_;
  casacore::ArrayColumn<double> uvw_column_;
  casacore::ArrayColumn<casacore::Complex> data_column_;
  casacore::ArrayColumn<bool> flag_column_;
  casacore::ArrayColumn<float> weight_column_, spectrum_column_;
  bool has_spectrum_ = false;

  casacore::Vector<int> antenna1_, antenna2_;  ///< [row]
  casacore::Vector<bool> flag_row_;            ///< [row]
  casacore::Array<double> uvw_;                ///< [row][3]
  casacore::Array<casacore::Complex> data_;    ///< [row][channel][correlation]
  casacore::Array<bool> flag_;                 ///< [row][channel][correlation]
  casacore::Array<float> weight_;              ///< [row][channel][correlation] or [row][correlation]
  bool weight_per_channel_ = false;
};

}  // namespace

std::unique_ptr<imager::BlockStream> read_blocks(std::shared_ptr<const OpenSet> open_set) {
  return std::make_unique<Reader>(std::move(open_set));
}

}  // namespace misfit::ms_io
