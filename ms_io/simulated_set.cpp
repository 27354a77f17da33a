#include "ms_io/simulated_set.h"

#include <casacore/casa/Arrays/ArrayMath.h>
#include <casacore/ms/MeasurementSets/MSColumns.h>
#include <casacore/tables/DataMan/IncrementalStMan.h>
#include <casacore/tables/DataMan/StandardStMan.h>
#include <casacore/tables/DataMan/TiledColumnStMan.h>
#include <casacore/tables/Tables/SetupNewTab.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <random>
#include <stdexcept>

#include "ms_io/simulated_subtables_internal.h"
#include "ms_io/table_access_internal.h"

namespace misfit::ms_io {
namespace {

constexpr ssize_t correlations = 2;        // XX and YY
constexpr ssize_t tile_samples = 1 << 16;  ///< half a megabyte of complex<float>

ssize_t signed_size(std::size_t n) {
  return static_cast<ssize_t>(n);
}

std::size_t baselines(const SimulatedObservation& observation) {
  const std::size_t antennas = observation.antenna_name.size();
  return antennas * (antennas - 1) / 2;
}

void require_complete(const SimulatedObservation& observation) {
  const auto require = [](bool condition, const std::string& message) {
    if (!condition) throw std::invalid_argument("simulated observation: " + message);
  };
  const std::size_t antennas = observation.antenna_name.size();
  require(antennas >= 2, std::to_string(antennas) + " antennas; expected 2 or more");
  require(observation.antenna_itrf_m.size() == antennas,
          std::to_string(observation.antenna_itrf_m.size()) + " antenna positions; expected " + std::to_string(antennas));
  require(!observation.fields.empty(), "no field; expected 1 or more");
  for (const SimulatedField& field : observation.fields)
    require(field.phase_centre.frame == observation.fields.front().phase_centre.frame,
            "fields in " + field.phase_centre.frame + " and " + observation.fields.front().phase_centre.frame +
                "; expected one frame");
  require(!observation.dish_diameter_m.empty(), "no diameter of dishes; expected 1 or more");
  require(!observation.time_mjd_s.empty(), "no integrations; expected 1 or more");
  require(!observation.frequency_hz.empty(), "no channels; expected 1 or more");
  for (const double f : observation.frequency_hz) {
    require(f > 0 && std::isfinite(f), "frequency " + std::to_string(f) + " Hz; expected a positive number");
  }
  require(observation.noise_jy >= 0 && std::isfinite(observation.noise_jy),
          "noise " + std::to_string(observation.noise_jy) + " Jy; expected 0 or more");
}

/// Gives the array column `name` one shape for all rows, in a tiled file of its own.
void bind_tiled(casacore::TableDesc& description, std::vector<std::string>& tiled, const std::string& name,
                const casacore::IPosition& cell) {
  casacore::ColumnDesc& column = description.rwColumnDesc(name);
  if (!column.isFixedShape()) column.setShape(cell);
  description.defineHypercolumn("Tiled" + name, static_cast<casacore::uInt>(cell.nelements() + 1),
                                casacore::Vector<casacore::String>(1, name));
  tiled.push_back(name);
}

casacore::MeasurementSet create(const std::string& path, const SimulatedObservation& observation) {
  const ssize_t channels = signed_size(observation.frequency_hz.size());
  const casacore::IPosition cell(2, correlations, channels);
  casacore::TableDesc description = casacore::MS::requiredTableDesc();
  casacore::MS::addColumnToDesc(description, casacore::MS::DATA, cell, casacore::ColumnDesc::FixedShape);
  std::vector<std::string> tiled;
  bind_tiled(description, tiled, "DATA", cell);
  bind_tiled(description, tiled, "FLAG", cell);
  bind_tiled(description, tiled, "UVW", casacore::IPosition(1, 3));
  bind_tiled(description, tiled, "WEIGHT", casacore::IPosition(1, correlations));
  bind_tiled(description, tiled, "SIGMA", casacore::IPosition(1, correlations));
  casacore::SetupNewTable setup(path, description, casacore::Table::New);
  setup.bindAll(casacore::IncrementalStMan("ISMData"));
  const casacore::StandardStMan standard("SSMData", 32768);  // bytes read at once; by default what 32 rows take
  for (const char* column : {"ANTENNA1", "ANTENNA2", "FLAG_CATEGORY"}) setup.bindColumn(column, standard);
  for (const std::string& column : tiled) {
    casacore::IPosition tile = description[column].shape();
    tile.append(casacore::IPosition(1, std::max<ssize_t>(1, tile_samples / tile.product())));
    setup.bindColumn(column, casacore::TiledColumnStMan("Tiled" + column, tile));
  }
  casacore::MeasurementSet set(setup, baselines(observation) * observation.time_mjd_s.size());
  set.createDefaultSubtables(casacore::Table::New);
  return set;
}

/// Fills the columns that do not depend on the sky.
void fill_bookkeeping(casacore::MeasurementSet& set, const SimulatedObservation& observation) {
  casacore::MSMainColumns columns(set);
  const std::size_t antennas = observation.antenna_name.size();
  std::vector<int> antenna1, antenna2;
  for (std::size_t t = 0; t < observation.time_mjd_s.size(); ++t) {
    for (std::size_t a = 0; a < antennas; ++a) {
      for (std::size_t b = a + 1; b < antennas; ++b) {
        const casacore::rownr_t row = antenna1.size();
        columns.time().put(row, observation.time_mjd_s[t]);
        columns.fieldId().put(row, static_cast<int>(observation.field_of(t)));
        columns.timeCentroid().put(row, observation.time_mjd_s[t]);
        antenna1.push_back(static_cast<int>(a));
        antenna2.push_back(static_cast<int>(b));
      }
    }
  }
  columns.antenna1().putColumn(casacore::Vector<int>(antenna1));
  columns.antenna2().putColumn(casacore::Vector<int>(antenna2));
  columns.interval().fillColumn(observation.interval_s);
  columns.exposure().fillColumn(observation.interval_s);
  for (casacore::ScalarColumn<int>* column : {&columns.arrayId(), &columns.dataDescId(), &columns.feed1(), &columns.feed2(),
                                              &columns.observationId(), &columns.processorId(), &columns.stateId()}) {
    column->fillColumn(0);
  }
  columns.scanNumber().fillColumn(1);
  columns.flagRow().fillColumn(false);
  const float noise = observation.noise_jy > 0 ? static_cast<float>(observation.noise_jy) : 1.0F;
  const casacore::IPosition shape(2, correlations, signed_size(set.nrow()));
  columns.sigma().putColumn(casacore::Array<float>(shape, noise));
  columns.weight().putColumn(casacore::Array<float>(shape, 1 / (noise * noise)));
}

/// Both correlations of the exact visibilities, each with noise of its own.
casacore::Array<casacore::Complex> observed(const std::vector<std::complex<double>>& exact, const casacore::IPosition& shape,
                                            double noise_jy, std::mt19937_64& generator) {
  casacore::Array<casacore::Complex> data(shape);
  std::normal_distribution<double> normal;
  casacore::Complex* out = data.data();
  for (const std::complex<double>& visibility : exact) {
    for (ssize_t correlation = 0; correlation < correlations; ++correlation) {
      std::complex<double> value = visibility;
      if (noise_jy > 0) {
        const double re = normal(generator), im = normal(generator);
        value += noise_jy * std::complex<double>(re, im);
      }
      *out++ = casacore::Complex(value);
    }
  }
  return data;
}

void require_size(const char* what, std::size_t found, std::size_t expected) {
  if (found == expected) return;
  throw std::invalid_argument(std::string("simulated observation: the function for ") + what + " returned " +
                              std::to_string(found) + " values; expected " + std::to_string(expected));
}

/// How the rows of an integration see the sky.
std::vector<imager::RowSight> sights_of(const SimulatedObservation& observation, std::size_t integration) {
  const int antennas = static_cast<int>(observation.antenna_name.size());
  std::vector<imager::RowSight> sights;
  for (int a = 0; a < antennas; ++a)
    for (int b = a + 1; b < antennas; ++b) sights.push_back({a, b, static_cast<int>(observation.field_of(integration)), 0});
  return sights;
}

/// Fills UVW, DATA and FLAG, one integration at a time.
void observe(casacore::MeasurementSet& set, const SimulatedObservation& observation, const BaselineUvw& uvw,
             const ExactVisibilities& visibilities, const std::function<void(std::size_t, std::size_t)>& progress) {
  casacore::MSMainColumns columns(set);
  const std::size_t count = baselines(observation), channels = observation.frequency_hz.size();
  const casacore::IPosition cells(3, correlations, signed_size(channels), signed_size(count));
  const casacore::Array<bool> unflagged(cells, false);
  std::mt19937_64 generator(observation.seed);
  for (std::size_t t = 0; t < observation.time_mjd_s.size(); ++t) {
    const std::vector<double> uvw_m = uvw(t);
    const imager::SampleCoordinates where{uvw_m, observation.frequency_hz, sights_of(observation, t)};
    require_size("UVW", where.uvw_m.size(), 3 * count);
    const std::vector<std::complex<double>> exact = visibilities(where);
    require_size("visibilities", exact.size(), where.samples());
    const casacore::Slicer rows(casacore::IPosition(1, signed_size(t * count)), casacore::IPosition(1, signed_size(count)));
    const casacore::Vector<double> flat(uvw_m);
    columns.uvw().putColumnRange(rows, flat.reform(casacore::IPosition(2, 3, signed_size(count))));
    columns.data().putColumnRange(rows, observed(exact, cells, observation.noise_jy, generator));
    columns.flag().putColumnRange(rows, unflagged);
    if (progress) progress(t + 1, observation.time_mjd_s.size());
  }
}

/// A name beside `path` that is removed again unless it is renamed.
class Temporary {
 public:
  explicit Temporary(const std::filesystem::path& path) : name_(path.string() + ".incomplete" + std::to_string(getpid())) {}
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;
  ~Temporary() {
    std::error_code ignored;
    std::filesystem::remove_all(name_, ignored);
  }
  const std::string& name() const { return name_; }

 private:
  std::string name_;
};

}  // namespace

void write_simulated_set(const std::string& path, const SimulatedObservation& observation, const BaselineUvw& uvw,
                         const ExactVisibilities& visibilities, const std::function<void(std::size_t, std::size_t)>& progress) {
  require_complete(observation);
  std::filesystem::path target = std::filesystem::path(path).lexically_normal();
  if (!target.has_filename()) target = target.parent_path();
  if (std::filesystem::exists(target)) throw std::runtime_error(path + " exists already; expected the name of a new set");
  const Temporary temporary(target);
  translated("cannot write " + path, [&] {
    casacore::MeasurementSet set = create(temporary.name(), observation);
    fill_subtables(set, observation);
    fill_bookkeeping(set, observation);
    observe(set, observation, uvw, visibilities, progress);
  });
  std::error_code failure;
  std::filesystem::rename(temporary.name(), target, failure);
  if (failure) throw std::runtime_error("cannot write " + path + ": " + failure.message());
}

}  // namespace misfit::ms_io
