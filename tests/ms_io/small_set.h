#pragma once

#include <casacore/ms/MeasurementSets/MSColumns.h>
#include <casacore/ms/MeasurementSets/MeasurementSet.h>
#include <casacore/tables/Tables/ArrColDesc.h>
#include <casacore/tables/Tables/ArrayColumn.h>
#include <casacore/tables/Tables/ScalarColumn.h>
#include <unistd.h>

#include <complex>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "ms_io/measurement_set.h"
#include "ms_io/simulated_set.h"
#include "tests/observations.h"

namespace misfit::ms_io::testing {

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();
constexpr float nan_float = std::numeric_limits<float>::quiet_NaN();
constexpr float infinite_float = std::numeric_limits<float>::infinity();

using misfit::testing::TemporaryFolder;

constexpr std::size_t antennas = 4, baselines = 6, integrations = 5, channels = 6, rows = baselines * integrations;

inline SimulatedObservation small_observation() {
  SimulatedObservation observation;
  observation.fields.front().phase_centre = {1.25, -0.5, "FK5"};
  for (std::size_t a = 0; a < antennas; ++a) {
    observation.antenna_name.push_back("A" + std::to_string(a));
    observation.antenna_itrf_m.push_back({-1601185.0 + 100.0 * static_cast<double>(a * a), -5041977.0, 3554875.0});
  }
  for (std::size_t t = 0; t < integrations; ++t) observation.time_mjd_s.push_back(4.9e9 + 10.0 * static_cast<double>(t));
  for (std::size_t c = 0; c < channels; ++c) observation.frequency_hz.push_back(1e9 + 1e6 * static_cast<double>(c));
  observation.channel_width_hz = 1e6;
  return observation;
}

/// Different for every row.
inline std::vector<double> small_uvw(std::size_t integration) {
  std::vector<double> uvw;
  for (std::size_t b = 0; b < baselines; ++b) {
    const double row = static_cast<double>(integration * baselines + b);
    uvw.insert(uvw.end(), {row + 1, 2 * row - 30, 0.125 * row});
  }
  return uvw;
}

/// Different for every row and channel, and exact in single precision.
inline std::vector<std::complex<double>> small_visibilities(const imager::SampleCoordinates& where) {
  std::vector<std::complex<double>> visibilities;
  for (std::size_t r = 0; r < where.rows(); ++r) {
    for (const double f : where.frequency_hz) visibilities.emplace_back(where.uvw_m[3 * r], f / 1e6);
  }
  return visibilities;
}

/// A simulated set with 6 baselines, 5 integrations and 6 channels, and what tests do to it.
class SmallSet {
 public:
  explicit SmallSet(const SimulatedObservation& observation = small_observation()) {
    write_simulated_set(path(), observation, small_uvw, small_visibilities, {});
  }

  std::string path() const { return (folder_ / "small.ms"); }

  void modify(const std::function<void(casacore::MeasurementSet&)>& change) const {
    casacore::MeasurementSet set(path(), casacore::Table::Update);
    change(set);
  }

  template <typename T>
  void put(const std::string& column, std::size_t row, T value) const {
    modify([&](casacore::MeasurementSet& set) { casacore::ScalarColumn<T>(set, column).put(row, value); });
  }

  /// Changes the element (i, j) of an array cell, or (i) when the cell has one axis.
  template <typename T>
  void put(const std::string& column, std::size_t row, ssize_t i, ssize_t j, T value) const {
    modify([&](casacore::MeasurementSet& set) {
      casacore::ArrayColumn<T> cells(set, column);
      casacore::Array<T> cell = cells(row);
      cell.ndim() == 1 ? cell(casacore::IPosition(1, i)) = value : cell(casacore::IPosition(2, i, j)) = value;
      cells.put(row, cell);
    });
  }

  /// Adds field 1 with a phase centre of its own, and gives it every second row.
  void add_field(double ra_rad, double dec_rad) const {
    modify([&](casacore::MeasurementSet& set) {
      set.field().addRow(1);
      casacore::MSFieldColumns columns(set.field());
      casacore::Matrix<double> direction(2, 1);
      direction(0, 0) = ra_rad;
      direction(1, 0) = dec_rad;
      columns.name().put(1, "OTHER");
      columns.numPoly().put(1, 0);
      columns.phaseDir().put(1, direction);
      columns.delayDir().put(1, direction);
      columns.referenceDir().put(1, direction);
      casacore::ScalarColumn<int> field(set, "FIELD_ID");
      for (casacore::rownr_t r = 1; r < set.nrow(); r += 2) field.put(r, 1);
    });
  }

  /// Phases field 0 to a direction in B1950.
  void phase_to_b1950(double ra_rad, double dec_rad) const {
    modify([&](casacore::MeasurementSet& set) {
      casacore::MSFieldColumns columns(set.field());
      casacore::Matrix<double> direction(2, 1);
      direction(0, 0) = ra_rad;
      direction(1, 0) = dec_rad;
      columns.phaseDirMeasCol().setDescRefCode(casacore::MDirection::B1950, false);
      columns.phaseDir().put(0, direction);
    });
  }

  /// Adds DATA_DESC_ID 1 with a spectral window 1 GHz higher, and gives it every third row.
  void add_spectral_window() const {
    modify([&](casacore::MeasurementSet& set) {
      set.spectralWindow().addRow(1);
      casacore::MSSpWindowColumns window(set.spectralWindow());
      casacore::Vector<double> frequency = window.chanFreq()(0);
      for (double& f : frequency) f += 1e9;
      window.name().put(1, "SECOND");
      window.numChan().put(1, static_cast<int>(frequency.nelements()));
      window.measFreqRef().put(1, 5);
      window.refFrequency().put(1, frequency(0));
      window.chanFreq().put(1, frequency);
      window.chanWidth().put(1, window.chanWidth()(0));
      window.effectiveBW().put(1, window.effectiveBW()(0));
      window.resolution().put(1, window.resolution()(0));
      set.dataDescription().addRow(1);
      casacore::MSDataDescColumns description(set.dataDescription());
      description.spectralWindowId().put(1, 1);
      description.polarizationId().put(1, 0);
      casacore::ScalarColumn<int> id(set, "DATA_DESC_ID");
      for (casacore::rownr_t r = 2; r < set.nrow(); r += 3) id.put(r, 1);
    });
  }

  /// Stores other correlations (casacore's codes), in columns whose shape may vary. Correlation k holds visibility k + 1 with
  /// weight k + 1.
  void store_correlations(const std::vector<int>& types) const {
    modify([&](casacore::MeasurementSet& set) {
      const auto count = static_cast<ssize_t>(types.size());
      casacore::MSPolarizationColumns polarization(set.polarization());
      polarization.numCorr().put(0, static_cast<int>(count));
      polarization.corrType().put(0, casacore::Vector<int>(types));
      polarization.corrProduct().put(0, casacore::Matrix<int>(2, static_cast<std::size_t>(count), 0));
      casacore::Matrix<casacore::Complex> data(types.size(), channels);
      casacore::Vector<float> weight(types.size());
      for (ssize_t k = 0; k < count; ++k) {
        data.row(static_cast<std::size_t>(k)) = casacore::Complex(static_cast<float>(k + 1));
        weight(static_cast<std::size_t>(k)) = static_cast<float>(k + 1);
      }
      replace<casacore::Complex>(set, "DATA", data);
      replace<bool>(set, "FLAG", casacore::Matrix<bool>(types.size(), channels, false));
      replace<float>(set, "WEIGHT", weight);
    });
  }

  /// The cell, correlations × channels.
  casacore::Matrix<casacore::Complex> cell(const std::string& column, std::size_t row) const {
    const casacore::MeasurementSet set(path());
    return casacore::ArrayColumn<casacore::Complex>(set, column)(row);
  }

 private:
  template <typename T>
  static void replace(casacore::MeasurementSet& set, const std::string& column, const casacore::Array<T>& cell) {
    set.removeColumn(column);
    set.addColumn(casacore::ArrayColumnDesc<T>(column, static_cast<int>(cell.ndim())));
    casacore::ArrayColumn<T> cells(set, column);
    for (casacore::rownr_t r = 0; r < set.nrow(); ++r) cells.put(r, cell);
  }

  TemporaryFolder folder_;
};

/// All blocks joined, in order.
struct AllSamples {
  imager::SampleCounts counts;
  std::vector<double> uvw_m;
  std::vector<double> frequency_hz;  ///< [block][channel]
  std::vector<std::complex<float>> visibility;
  std::vector<float> weight;
  std::size_t blocks = 0;
};

inline AllSamples read_all(const MeasurementSet& set) {
  AllSamples all;
  const auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
  const auto stream = set.open();
  while (const auto block = stream->next()) {
    all.counts += block->counts;
    append(all.uvw_m, block->uvw_m);
    append(all.frequency_hz, block->frequency_hz);
    append(all.visibility, block->visibility);
    append(all.weight, block->weight);
    ++all.blocks;
  }
  return all;
}

/// The message of the std::runtime_error that `action` throws; empty when it throws none.
inline std::string error_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

inline bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

}  // namespace misfit::ms_io::testing
