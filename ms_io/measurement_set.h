#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "imager/data/extent.h"
#include "imager/data/observation.h"
#include "imager/data/stokes.h"
#include "imager/data/visibilities.h"
#include "ms_io/beam_rows.h"
#include "ms_io/selection.h"
#include "ms_io/spectral_frame.h"
#include "ms_io/zeros.h"

namespace misfit::ms_io {

/// Usable rows are neither flagged nor of one antenna.
enum class ReachOf { usable, all };

/// How far samples reach, and the shortest and longest of their projected baselines √(u² + v²): in metres, and in wavelengths
/// at the lowest and highest channels selected. Without any row the shortest are infinite.
struct SetReach : imager::UvwReach {
  double shortest_m = std::numeric_limits<double>::infinity();
  double longest_m = 0;
  double shortest_lambda = std::numeric_limits<double>::infinity();
  double longest_lambda = 0;

  /// Extends the range by the other's.
  void join(const SetReach& other);
};

/// A field of a set, of which rows are selected.
struct NamedField {
  int id = 0;
  std::string name;
};

/// The contents of a set, as far as they are selected, for people.
struct SetSummary {
  std::string path;
  std::string telescope;           ///< empty where OBSERVATION does not say
  std::uint64_t antennas = 0;      ///< in ANTENNA
  std::vector<NamedField> fields;  ///< with selected rows, by id
  std::uint64_t all_fields = 0;    ///< in FIELD
  std::uint64_t all_windows = 0;   ///< in SPECTRAL_WINDOW
  std::string start_utc;           ///< of the first integration, ISO 8601; empty where no row has a time
  std::string end_utc;             ///< of the last
  double length_s = 0;             ///< between them
};

/// A range of frequencies, both ends included.
struct FrequencyRange {
  double low_hz = 0;
  double high_hz = 0;
};

/// How ranks share the samples of a selection.
struct SampleSharing {
  std::vector<std::uint64_t> samples;  ///< [rank]
  std::size_t sets = 1;
  bool whole_sets = true;  ///< each rank has some of the sets; else ranges of rows, in the order of the tables
};

/// The column of a set that visibilities are read from.
struct DataColumn {
  std::string path;                     ///< of the set
  std::string name;                     ///< "CORRECTED_DATA"
  std::vector<std::string> subtracted;  ///< commands that subtracted models from these data
  std::string there;                    ///< all columns with visibilities: "DATA, CORRECTED_DATA"
};

/// A column of which all or some was never filled.
struct ZeroColumn {
  std::string path;
  std::string name;
  Zeros zeros;
};

/// `data_column`, as MeasurementSet takes it, with the names that these sets have: "CORRECTED_DATA", or one for each set,
/// separated by commas. Throws std::runtime_error where a set cannot be opened.
std::string named_columns(const std::vector<std::string>& paths, const std::string& data_column);

/// A selected part of a MeasurementSet, or of several that make one image, as visibilities of Stokes parameters, opened
/// read-only and streamed in blocks, one set after the other, in the order in which they were observed. Only the columns and
/// channels that are needed are read. A block never mixes sets, DATA_DESC_IDs or, where the phase centre is shifted, fields.
/// Reading never runs in two threads at once.
class MeasurementSet : public imager::VisibilitySource {
 public:
  /// So many that the cost of a pass over the tiles of a grid is shared by enough samples of a block.
  static constexpr std::uint64_t usual_block_samples = std::uint64_t{1} << 20;

  /// Opens `path`. `data_column` names the column with the visibilities ("DATA", "CORRECTED_DATA", …). Throws
  /// std::runtime_error when the path is no MeasurementSet, the column is missing, the selection is empty or wrong, one of
  /// `stokes` cannot be formed (the message lists the correlations there are), or the rows selected have several phase centres
  /// and `selection` does not say where to shift them. The short names data, corrected and model stand for DATA, CORRECTED_DATA
  /// and MODEL_DATA, and auto for CORRECTED_DATA where the set has it, else DATA. A block holds whole rows, about
  /// `block_samples` samples of them; what is read does not depend on that number. Where `data_column` is empty, all but open()
  /// can be called, whatever columns and correlations there are.
  MeasurementSet(const std::string& path, const Selection& selection, const std::string& data_column,
                 const std::vector<imager::Stokes>& stokes = {imager::Stokes::I},
                 std::uint64_t block_samples = usual_block_samples);
  /// Opens several sets, at least one; `selection` is made in each. They may differ in everything but their phase centres.
  /// `data_column` names one column for all, or one for each, separated by commas.
  MeasurementSet(const std::vector<std::string>& paths, const Selection& selection, const std::string& data_column,
                 const std::vector<imager::Stokes>& stokes = {imager::Stokes::I},
                 std::uint64_t block_samples = usual_block_samples);
  ~MeasurementSet() override;

  /// A sentence for each set whose column was not written to its end, see incomplete_column().
  std::vector<std::string> incomplete_columns() const;
  /// One for each set.
  std::vector<DataColumn> data_columns() const;
  /// The columns whose data are 0 in some or all of what `ranks` have read; they call this together.
  std::vector<ZeroColumn> columns_of_zeros(const imager::Ranks& ranks) const;
  /// The correlations stored in the selected rows of all sets, in the order of their codes.
  std::vector<imager::Stokes> correlations() const;
  /// Files of the sets that were changed, removed or made since the sets were opened: the data read may be neither the old nor
  /// the new ones.
  std::vector<std::string> changed_files() const;
  /// Sentences for users on directions and frames of the selection: on phase centres that move, or differ by rounding, and on
  /// places from which frequencies cannot be converted as they should.
  const std::vector<std::string>& remarks() const;
  /// The parameters of I, Q, U and V that a correlation stored in the selected rows of any set responds to.
  std::vector<imager::Stokes> seen_stokes() const;
  /// The selection, with the phase centre that visibilities are shifted to, also where it names none.
  const Selection& selection() const;
  /// The observation of the first set, with the band of all sets; where the image moves with fields, in the middle of their
  /// run.
  const imager::Observation& observation() const;
  /// The place, at a time, UTC in ISO 8601, of the body or field that an image of the first set moves with. Nothing where the
  /// image stands still, or the place at that time is not known: an ephemeris may not reach it, and rates are of the rows'
  /// times.
  std::optional<imager::SkyDirection> followed_at(const std::string& utc) const;
  std::uint64_t rows() const;
  std::uint64_t samples() const override;
  /// Samples of the blocks that are read at once, at most: several blocks where rows of DATA_DESC_IDs alternate.
  std::uint64_t read_at_once() const;
  /// The pointings of the selected fields of all sets; their rows are not counted. Throws std::runtime_error when FIELD or
  /// ANTENNA cannot be read.
  std::vector<FieldPointing> field_pointings() const;
  /// The largest angle in FEED between a feed's beam and its dish's axis; where it is 0, beam_rows() need not be asked. Throws
  /// std::runtime_error when FEED cannot be read.
  double beam_offset_rad() const;
  /// Reads antennas and feeds of all rows. Throws std::runtime_error when they, ANTENNA, FEED or FIELD cannot be read.
  BeamRows beam_rows() const;
  /// The sort of each antenna of the first set, from ANTENNA. Throws std::runtime_error where it cannot be read.
  std::vector<imager::AntennaSort> antennas() const;
  /// The antennas and pointings, one set after the other, whose places in these lists are the numbers of rows' sights in
  /// blocks. Each selected field has one pointing; where it moves, at the middle one of its rows' times. With
  /// Selection::pointing_tolerance_rad pointings are where antennas pointed, in the order of the rows, in the field and at the
  /// time at which they were first seen. Parts and shares have the table of the whole set. Throws std::logic_error unless the
  /// selection asks for sights; where they cannot be told, opening throws std::runtime_error.
  const SightTable& sight_table() const;
  /// The position angle of the zenith for each row, from north through east, as seen from where the row's field points, in the
  /// order in which blocks hold rows. Dishes on alt-azimuth mounts turn by it; it is 0 for other mounts. Reads times, fields
  /// and antennas of all rows. Throws std::runtime_error when they cannot be read.
  std::vector<float> zenith_turns() const;
  /// Summaries of all sets, in the order in which they were observed. Reads FIELD, OBSERVATION, and the times of two rows of
  /// each. Throws std::runtime_error when these cannot be read.
  std::vector<SetSummary> summaries() const;
  /// Bounds at the highest channel selected, of rows with finite UVW. Reads UVW, antennas and FLAG_ROW alone. Throws
  /// std::runtime_error when they cannot be read.
  SetReach reach(ReachOf rows = ReachOf::usable) const;
  /// The windows of all sets, in the frame that the selection names, and in the order in which it lists them, or of their ids.
  std::vector<SpectralWindow> spectral_windows() const;
  /// Calls visit(coordinates) for groups of rows, which together are all selected rows that have finite UVW and are neither
  /// flagged as a whole nor of one antenna. Reads and throws what reach() does.
  void visit_coordinates(const std::function<void(const imager::SampleCoordinates&)>& visit) const;
  std::unique_ptr<imager::BlockStream> open() const override;
  /// This set, which reads only channels that may come into a range of frequencies, in the frame that the selection names,
  /// in the course of a year; null where there are none. Samples of the part of the range `counted` are counted there already.
  std::unique_ptr<MeasurementSet> part(const FrequencyRange& range, const std::optional<FrequencyRange>& counted = {}) const;
  /// This set, of which this rank reads its share alone: rows(), samples(), read_at_once(), visit_coordinates() and open()
  /// are about the share, which may be empty. All else is about the whole set, and reach() is called by all ranks. `ranks` must
  /// outlive it.
  std::unique_ptr<MeasurementSet> share(const imager::Ranks& ranks) const;
  const imager::Ranks& ranks() const override;
  /// How ranks share the samples; one rank has them all without share().
  SampleSharing sharing() const;

 private:
  struct Impl;
  explicit MeasurementSet(std::shared_ptr<const Impl> impl);
  const Impl& whole() const;
  std::shared_ptr<const Impl> impl_;
};

}  // namespace misfit::ms_io
