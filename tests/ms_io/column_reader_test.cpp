// Rows of several DATA_DESC_IDs that alternate, and cells that are not what DATA_DESC_ID says.
#include <casacore/tables/DataMan/TiledShapeStMan.h>

#include <boost/test/unit_test.hpp>
#include <map>

#include "tests/ms_io/small_set.h"

namespace misfit::ms_io {

BOOST_AUTO_TEST_SUITE(column_reader)

using namespace testing;

namespace {

/// Stores `column` anew in tiles, each row as `cell` makes it of what it was; undefined where that is empty.
template <typename T>
void store(casacore::MeasurementSet& set, const std::string& column,
           const std::function<casacore::Array<T>(std::size_t, const casacore::Array<T>&)>& cell) {
  const casacore::Array<T> old = casacore::ArrayColumn<T>(set, column).getColumn();
  set.removeColumn(column);
  casacore::TableDesc description;
  description.addColumn(casacore::ArrayColumnDesc<T>(column, 2));
  description.defineHypercolumn("New" + column, 3, casacore::Vector<casacore::String>(1, column));
  set.addColumn(description, casacore::TiledShapeStMan("New" + column, casacore::IPosition(3, 2, 6, 4)));
  casacore::ArrayColumn<T> cells(set, column);
  for (std::size_t r = 0; r < rows; ++r) {
    const casacore::Array<T> made = cell(r, old[r]);
    if (!made.empty()) cells.put(r, made);
  }
}

/// DATA_DESC_IDs 0, 1, 2, 0, 1, 2, … of which the last has `last_channels` channels.
class AlternatingSet : public SmallSet {
 public:
  explicit AlternatingSet(ssize_t last_channels) {
    add_spectral_window();
    const casacore::Slicer part(casacore::IPosition(2, 0, 0), casacore::IPosition(2, 2, last_channels));
    modify([&](casacore::MeasurementSet& set) {
      casacore::MSSpWindowColumns window(set.spectralWindow());
      set.spectralWindow().addRow(1);
      const casacore::Slicer first(casacore::IPosition(1, 0), casacore::IPosition(1, last_channels));
      window.numChan().put(2, static_cast<int>(last_channels));
      window.measFreqRef().put(2, 5);
      casacore::Vector<double> frequency = window.chanFreq()(1)(first);
      for (double& f : frequency) f += 1e9;
      window.chanFreq().put(2, frequency);
      for (casacore::ArrayColumn<double>* column : {&window.chanWidth(), &window.effectiveBW(), &window.resolution()})
        column->put(2, casacore::Vector<double>((*column)(0)(first)));
      set.dataDescription().addRow(1);
      casacore::MSDataDescColumns description(set.dataDescription());
      description.spectralWindowId().put(2, 2);
      description.polarizationId().put(2, 0);
      casacore::ScalarColumn<int> id(set, "DATA_DESC_ID");
      for (std::size_t r = 0; r < rows; ++r) id.put(r, static_cast<int>(r % 3));
      store<casacore::Complex>(set, "DATA", [&](std::size_t r, const auto& cell) { return r % 3 == 2 ? cell(part) : cell; });
      store<bool>(set, "FLAG", [&](std::size_t r, const auto& cell) { return r % 3 == 2 ? cell(part) : cell; });
    });
  }

  /// WEIGHT_SPECTRUM of every row that `has` it, different in all of them.
  void add_spectrum(const std::function<bool(std::size_t)>& has) const {
    modify([&](casacore::MeasurementSet& set) {
      set.addColumn(casacore::ArrayColumnDesc<float>("WEIGHT_SPECTRUM", 2));
      casacore::ArrayColumn<float> spectrum(set, "WEIGHT_SPECTRUM");
      const casacore::ArrayColumn<casacore::Complex> data(set, "DATA");
      for (std::size_t r = 0; r < rows; ++r)
        if (has(r)) spectrum.put(r, casacore::Array<float>(data.shape(r), static_cast<float>(r + 2)));
    });
  }
};

/// What blocks say of the window of each first frequency and of each of two Stokes parameters, I and another.
std::map<std::pair<double, bool>, AllSamples> by_window(const MeasurementSet& set) {
  std::map<std::pair<double, bool>, AllSamples> windows;
  const auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
  const auto stream = set.open();
  while (const auto block = stream->next()) {
    for (const bool is_other : {false, true}) {
      const std::complex<float>* const visibility = block->visibility_of(is_other ? 1 : 0);
      AllSamples& all = windows[{block->frequency_hz.front(), is_other}];
      all.counts += block->counts;
      append(all.uvw_m, block->uvw_m);
      all.visibility.insert(all.visibility.end(), visibility, visibility + block->samples());
      append(all.weight, block->weight);
    }
  }
  return windows;
}

/// Together, and in blocks of any size, the windows give what each gives alone.
void check_windows(const SmallSet& set, const std::vector<std::string>& windows) {
  std::string list;
  for (const std::string& window : windows) list += (list.empty() ? "" : ",") + window;
  const Selection together{"", list};
  const std::vector<imager::Stokes> stokes = {imager::Stokes::I, imager::Stokes::Q};
  std::map<std::pair<double, bool>, AllSamples> alone;
  for (const std::string& window : windows)
    alone.merge(by_window(MeasurementSet(set.path(), {"", window}, "DATA", stokes, 24)));
  BOOST_TEST_REQUIRE(alone.size() == 2 * windows.size());
  for (const std::uint64_t block_samples : {std::uint64_t{7}, std::uint64_t{24}, MeasurementSet::usual_block_samples}) {
    const auto all = by_window(MeasurementSet(set.path(), together, "DATA", stokes, block_samples));
    BOOST_TEST(all.size() == alone.size());
    for (const auto& [which, expected] : alone) {
      const AllSamples& is = all.at(which);
      BOOST_TEST(is.counts.used == expected.counts.used);
      BOOST_TEST(is.counts.rows_read == rows / 3);
      BOOST_TEST((is.uvw_m == expected.uvw_m));
      BOOST_TEST((is.visibility == expected.visibility));
      BOOST_TEST((is.weight == expected.weight));
    }
  }
}

}  // namespace

BOOST_AUTO_TEST_CASE(windows_whose_rows_alternate_give_the_samples_of_each_alone) {
  const std::vector<std::vector<std::string>> selections = {
      {"0", "1", "2"}, {"0:1~2", "1:1~2", "2:1~2"}, {"0:0~3", "1:0;3", "2:0~1"}, {"0", "2"}};
  const std::vector<std::function<bool(std::size_t)>> spectra = {nullptr, [](std::size_t) { return true; },
                                                                 [](std::size_t r) { return r % 5 != 0; },
                                                                 [](std::size_t r) { return r % 3 != 1; }};
  for (const ssize_t last_channels : {6, 4})
    for (std::size_t s = 0; s < spectra.size(); ++s) {
      const AlternatingSet set(last_channels);
      set.put("FLAG", 7, 1, 2, true);
      set.put("FLAG_ROW", 8, true);
      if (spectra[s]) set.add_spectrum(spectra[s]);
      for (const auto& windows : selections)
        BOOST_TEST_CONTEXT(last_channels << " channels, spectra " << s << ", " << windows.back()) {
          check_windows(set, windows);
        }
    }
}

// casacore reads a whole column as if all of its cells were like the first, and ends the program where one is undefined.
BOOST_AUTO_TEST_CASE(a_tiled_cell_of_another_shape_or_none_is_one_line_that_names_its_row) {
  const casacore::Array<casacore::Complex> none, other(casacore::IPosition(2, 2, 4));
  for (const auto& [cell, what] : {std::pair(none, " is empty"), std::pair(other, " has the shape [2, 4]")}) {
    const SmallSet set;
    set.modify([&, &cell = cell](casacore::MeasurementSet& ms) {
      store<casacore::Complex>(ms, "DATA", [&](std::size_t r, const auto& old) { return r == 17 ? cell : old; });
    });
    const std::string expected = "cannot read DATA of " + set.path() + ": the cell of row 17" + what + "; expected [2, 6]";
    for (const std::uint64_t block_samples : {std::uint64_t{24}, MeasurementSet::usual_block_samples})
      BOOST_TEST(contains(
          error_of([&] { read_all(MeasurementSet(set.path(), {}, "DATA", {imager::Stokes::I}, block_samples)); }), expected));
  }
}

// casacore takes slices of whatever cell holds them.
BOOST_AUTO_TEST_CASE(a_cell_of_another_shape_is_refused_where_some_channels_of_some_rows_are_read) {
  const SmallSet set;
  set.modify([](casacore::MeasurementSet& ms) {
    store<casacore::Complex>(ms, "DATA", [](std::size_t r, const auto& old) {
      return r == 17 ? casacore::Array<casacore::Complex>(casacore::IPosition(2, 2, 12), casacore::Complex(1e3)) : old;
    });
  });
  for (const char* antenna : {"", "!1&2"})  // all rows, and some
    for (const std::uint64_t block_samples : {std::uint64_t{24}, MeasurementSet::usual_block_samples}) {
      Selection some{"", "0:0~1"};
      some.antenna = antenna;
      const MeasurementSet open(set.path(), some, "DATA", {imager::Stokes::I}, block_samples);
      BOOST_TEST(contains(error_of([&] { read_all(open); }), "the cell of row 17 has the shape [2, 12]; expected [2, 6]"));
    }
}

BOOST_AUTO_TEST_CASE(a_weight_spectrum_of_another_shape_is_one_line_that_names_its_row_also_where_others_have_none) {
  for (const ssize_t correlations : {1, 2})
    for (const bool others : {false, true}) {
      const SmallSet set;
      set.modify([&](casacore::MeasurementSet& ms) {
        ms.addColumn(casacore::ArrayColumnDesc<float>("WEIGHT_SPECTRUM", 2));
        casacore::ArrayColumn<float> spectrum(ms, "WEIGHT_SPECTRUM");
        for (std::size_t r = others ? 1 : 0; r < rows; ++r)
          spectrum.put(r, casacore::Array<float>(
                              r == 17 ? casacore::IPosition(2, correlations, 12) : casacore::IPosition(2, 2, 6), 1.0F));
      });
      const std::string expected =
          "WEIGHT_SPECTRUM of " + set.path() + ": the cell of row 17 has the shape [" + std::to_string(correlations) + ", 12]";
      BOOST_TEST(contains(error_of([&] { read_all(MeasurementSet(set.path(), {}, "DATA")); }), expected));
    }
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace misfit::ms_io
