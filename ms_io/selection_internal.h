#pragma once

#include <casacore/ms/MeasurementSets/MeasurementSet.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ms_io/body_internal.h"
#include "ms_io/field_shift_internal.h"
#include "ms_io/measurement_set.h"

namespace misfit::ms_io {

/// Consecutive rows of the main table, or consecutive channels.
struct Run {
  std::uint64_t first = 0;
  std::uint64_t count = 0;
};

/// The facts that the rows of one DATA_DESC_ID of the selection share.
struct Setup {
  int data_description = 0;
  int field = 0;                               ///< where SelectedRows::by_field; else 0
  FieldShift shift;                            ///< from where its rows are phased to
  std::map<int, std::uint64_t> rows_of_field;  ///< selected
  int spectral_window = 0;
  std::size_t place = 0;                 ///< of the window among the windows that the selection lists, or among all
  std::string spectral_frame;            ///< FITS SPECSYS
  std::vector<int> correlation_types;    ///< casacore's Stokes codes
  std::size_t stored_channels = 0;       ///< in a cell
  std::vector<Run> channels;             ///< selected, ascending
  std::vector<double> frequency_hz;      ///< [selected channel]
  std::vector<double> channel_width_hz;  ///< [selected channel], positive
  Run uncounted;                         ///< stored channels whose samples another part of the set counts

  std::uint64_t first_channel() const { return channels.front().first; }
  std::uint64_t last_channel() const { return channels.back().first + channels.back().count - 1; }
  /// Channels from the first selected to the last selected one.
  std::uint64_t channel_span() const { return last_channel() - first_channel() + 1; }
};

/// Rows of one setup that are handed out together, ascending.
struct BlockRows {
  std::size_t setup = 0;
  std::vector<Run> runs;
  std::uint64_t rows = 0;
};

/// TIME of the first and last selected rows of a field, as the set stores it.
struct TimeSpan {
  double first_s = 0;
  double last_s = 0;

  double middle_s() const { return first_s + (last_s - first_s) / 2; }
};

/// The selection, resolved into rows and channels to read.
struct SelectedRows {
  std::vector<Setup> setups;
  bool by_field = false;          ///< whether each setup is of one field: visibilities are shifted, or go by its ephemeris
  std::vector<BlockRows> blocks;  ///< in the order of the table, as far as several setups allow
  std::uint64_t rows = 0;
  std::uint64_t samples = 0;                         ///< rows × selected channels
  std::uint64_t first_row = 0;                       ///< the earliest row selected that has a time, wherever it stands
  std::optional<std::uint64_t> last_row;             ///< the latest row selected that has a time
  std::map<int, std::uint64_t> first_row_of_field;   ///< the earliest, for the fields that have selected rows
  std::map<int, TimeSpan> moving;                    ///< the fields whose phase centres move, or that follow a moving body
  double moved_rad = 0;                              ///< the farthest that one of them moves
  std::optional<double> beam_rad;                    ///< see finest_beam_rad(); none where it was not needed
  std::optional<imager::SkyDirection> phase_centre;  ///< where the visibilities are shifted to
  bool follows_field = false;                        ///< instead the image moves with the field of the first row
  bool follows_target = false;                       ///< it moves with `body`, or that field's ephemeris, without offset
  std::shared_ptr<const Body> body;                  ///< that all fields follow; null: each field follows its own
  std::string body_name;                             ///< "JUPITER"; or the path of its ephemeris
  std::vector<std::string> remarks;                  ///< sentences for users on phase centres
  std::string spectral_frame;                        ///< in which frequencies count; empty: each window's own

  /// True if a setup's shift depends on time.
  bool shift_moves() const {
    return std::any_of(setups.begin(), setups.end(), [](const Setup& setup) { return setup.shift.moves(); });
  }
};

/// The use of the rows.
struct RowUse {
  std::uint64_t block_samples = 0;  ///< a block has about so many
  bool reading = true;              ///< rows whose u or v is not finite are then within all uv ranges, so that they are counted
};

/// Finds the rows and channels that `selection` means, in blocks. Throws std::runtime_error, which begins with `path`, for a
/// wrong or empty selection and for rows that point nowhere.
SelectedRows select_rows(const casacore::MeasurementSet& set, const std::string& path, const Selection& selection,
                         const RowUse& use);

/// Appends `count` rows or channels, of which `first` is the first, to ascending runs.
void append(std::vector<Run>& runs, std::uint64_t first, std::uint64_t count = 1);

}  // namespace misfit::ms_io
