#include <casacore/ms/MeasurementSets/MSDataDescription.h>
#include <casacore/ms/MeasurementSets/MSPolarization.h>
#include <casacore/ms/MeasurementSets/MSSpectralWindow.h>
#include <casacore/tables/Tables/ArrayColumn.h>
#include <casacore/tables/Tables/ScalarColumn.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "ms_io/setup_internal.h"
#include "ms_io/spectral_frame_internal.h"
#include "ms_io/table_access_internal.h"

namespace misfit::ms_io {
namespace {

template <typename T>
std::vector<T> cell(const casacore::Table& table, const char* column, std::uint64_t row) {
  return casacore::ArrayColumn<T>(table, column)(row).tovector();
}

std::string to_text(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

}  // namespace

SetupTable::SetupTable(const casacore::MeasurementSet& set, const std::string& path) : set_(set), path_(path) {
  translated("cannot read DATA_DESCRIPTION of " + path, [&] {
    window_ = casacore::ScalarColumn<int>(set.dataDescription(), "SPECTRAL_WINDOW_ID").getColumn().tovector();
    polarisation_ = casacore::ScalarColumn<int>(set.dataDescription(), "POLARIZATION_ID").getColumn().tovector();
  });
}

int SetupTable::spectral_window(int data_description) const {
  const auto index = static_cast<std::size_t>(data_description);
  if (data_description < 0 || index >= window_.size()) {
    throw std::runtime_error(path_ + " has rows with DATA_DESC_ID " + std::to_string(data_description) +
                             ", but DATA_DESCRIPTION has " + std::to_string(window_.size()) + " rows");
  }
  const auto windows = set_.spectralWindow().nrow();
  const auto polarisations = set_.polarization().nrow();
  if (window_[index] < 0 || polarisation_[index] < 0 || static_cast<casacore::rownr_t>(window_[index]) >= windows ||
      static_cast<casacore::rownr_t>(polarisation_[index]) >= polarisations) {
    throw std::runtime_error(path_ + ": DATA_DESC_ID " + std::to_string(data_description) + " points to spectral window " +
                             std::to_string(window_[index]) + " of " + std::to_string(windows) + " and polarisation setup " +
                             std::to_string(polarisation_[index]) + " of " + std::to_string(polarisations));
  }
  return window_[index];
}

double SetupTable::reference_frequency_hz(int data_description) const {
  const auto window = static_cast<casacore::rownr_t>(spectral_window(data_description));
  const double reference_hz = translated("cannot read REF_FREQUENCY of " + path_, [&] {
    return casacore::ScalarColumn<double>(set_.spectralWindow(), "REF_FREQUENCY")(window);
  });
  if (reference_hz > 0 && std::isfinite(reference_hz)) return reference_hz;
  throw std::runtime_error(
      path_ + ": spectral window " + std::to_string(window) + " has REF_FREQUENCY " + to_text(reference_hz) +
      " Hz, at which a --uvrange in wavelengths is meant; expected a positive number, or a range in metres");
}

Setup SetupTable::setup(int data_description, const ParsedSelection& parsed) const {
  Setup setup;
  setup.data_description = data_description;
  setup.spectral_window = spectral_window(data_description);
  const auto window = static_cast<std::uint64_t>(setup.spectral_window);
  const auto polarisation = static_cast<std::uint64_t>(polarisation_[static_cast<std::size_t>(data_description)]);
  std::vector<double> frequency, width;
  translated("cannot read the frequencies of spectral window " + std::to_string(window) + " of " + path_, [&] {
    frequency = cell<double>(set_.spectralWindow(), "CHAN_FREQ", window);
    width = cell<double>(set_.spectralWindow(), "CHAN_WIDTH", window);
    setup.correlation_types = cell<int>(set_.polarization(), "CORR_TYPE", polarisation);
    setup.spectral_frame = spectral_frame_of(casacore::ScalarColumn<int>(set_.spectralWindow(), "MEAS_FREQ_REF")(window));
  });
  setup.stored_channels = frequency.size();
  width.resize(frequency.size(), 0.0);
  const auto selected = parsed.channels.find(setup.spectral_window);
  for (std::size_t c = 0; c < frequency.size(); ++c) {
    if (!parsed.all_windows && (selected == parsed.channels.end() || selected->second.count(static_cast<int>(c)) == 0))
      continue;
    if (!(frequency[c] > 0 && std::isfinite(frequency[c]))) {
      throw std::runtime_error(path_ + ": spectral window " + std::to_string(window) + " has frequency " +
                               to_text(frequency[c]) + " Hz at channel " + std::to_string(c) + "; expected a positive number");
    }
    append(setup.channels, c);
    setup.frequency_hz.push_back(frequency[c]);
    setup.channel_width_hz.push_back(std::isfinite(width[c]) ? std::abs(width[c]) : 0.0);
  }
  if (setup.channels.empty()) {
    throw std::runtime_error(path_ + ": no channel of spectral window " + std::to_string(window) +
                             " is selected; expected at least one of its " + std::to_string(frequency.size()) + " channels");
  }
  return setup;
}

}  // namespace misfit::ms_io
