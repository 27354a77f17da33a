#include "ms_io/spectral_frame.h"

#include <casacore/casa/Arrays/ArrayMath.h>
#include <casacore/tables/DataMan/TiledShapeStMan.h>

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <fstream>

#include "tests/ms_io/small_set.h"

BOOST_AUTO_TEST_SUITE(spectral_frame)

using namespace misfit;
using namespace misfit::ms_io;
using namespace misfit::ms_io::testing;

namespace {

/// The small set, seen from the VLA's place at times of the year and day when the Earth moves differently.
SimulatedObservation observed_at_three_times() {
  SimulatedObservation observation = small_observation();
  observation.time_mjd_s = {4.9e9, 4.9e9 + 40000, 4.9e9 + 1.2e7};
  return observation;
}

Selection in_frame(const std::string& name) {
  Selection selection;
  selection.spectral_frame = parse_spectral_frame(name);
  return selection;
}

std::vector<double> ratios(const SmallSet& set, const std::string& frame) {
  const MeasurementSet read(set.path(), in_frame(frame), "data");
  std::vector<double> all;
  const auto stream = read.open();
  while (const auto block = stream->next()) {
    BOOST_TEST(block->channel_width_hz == std::vector<double>(channels, 1e6), boost::test_tools::per_element());
    all.insert(all.end(), block->frame_ratio.begin(), block->frame_ratio.end());
  }
  return all;
}

/// Of a thousand channels, with DATA in tiles of eight.
class ManyChannels : public SmallSet {
 public:
  ManyChannels() : SmallSet(observed()) {
    modify([](casacore::MeasurementSet& set) {
      const casacore::Array<casacore::Complex> data = casacore::ArrayColumn<casacore::Complex>(set, "DATA").getColumn();
      set.removeColumn("DATA");
      casacore::TableDesc description;
      description.addColumn(casacore::ArrayColumnDesc<casacore::Complex>("DATA", 2));
      description.defineHypercolumn("Tiles", 3, casacore::Vector<casacore::String>(1, "DATA"));
      set.addColumn(description, casacore::TiledShapeStMan("Tiles", casacore::IPosition(3, 2, 8, rows)));
      casacore::ArrayColumn<casacore::Complex>(set, "DATA").putColumn(data);
    });
  }

 private:
  static SimulatedObservation observed() {
    SimulatedObservation observation = small_observation();
    observation.frequency_hz.clear();
    for (int c = 0; c < 1000; ++c) observation.frequency_hz.push_back(1e9 + 1e6 * c);
    return observation;
  }
};

/// What this process has read of files so far.
std::uint64_t bytes_read() {
  std::ifstream file("/proc/self/io");
  std::string name;
  std::uint64_t bytes = 0;
  file >> name >> bytes;
  BOOST_TEST_REQUIRE(name == "rchar:");
  return bytes;
}

/// By a pass over all of `set`.
std::uint64_t bytes_of_pass(const MeasurementSet& set) {
  const std::uint64_t before = bytes_read();
  const auto stream = set.open();
  while (stream->next()) continue;
  return bytes_read() - before;
}

}  // namespace

// Origin: astropy 5.2.1, SkyCoord.radial_velocity_correction and EarthLocation.get_gcrs_posvel, and 20 km/s towards 18h +30°
// (B1900). They count the Earth's time dilation and the Sun's potential, 1.5e-8 and 4e-10 more or less in the course of a year,
// which frames of frequency do not.
BOOST_AUTO_TEST_CASE(frequencies_shift_as_the_earth_moves) {
  const SmallSet set(observed_at_three_times());
  struct Reference {
    const char* frame;
    double ratio[3];
    double dilation;
  };
  for (const Reference& reference : {Reference{"GEO", {0.9999993050996122, 1.000000875863832, 1.0000009673682537}, 0},
                                     Reference{"bary", {1.000063179454893, 1.0000647345733211, 0.9999554057549129}, 1.55e-8},
                                     Reference{"LSRK", {1.0001270187375062, 1.0001285739552055, 1.000019238157765}, 1.55e-8}}) {
    BOOST_TEST_CONTEXT(reference.frame) {
      const std::vector<double> all = ratios(set, reference.frame);
      BOOST_TEST_REQUIRE(all.size() == 3 * baselines);
      for (std::size_t row = 0; row < all.size(); ++row)  // 1e-9 is 0.3 m/s
        BOOST_TEST(std::abs(all[row] / reference.ratio[row / baselines] - 1 - reference.dilation) < 1e-9);
    }
  }
}

BOOST_AUTO_TEST_CASE(the_frame_of_the_data_stays) {
  const SmallSet set(observed_at_three_times());
  for (const double ratio : ratios(set, "TOPO")) BOOST_TEST(ratio == 1);
}

BOOST_AUTO_TEST_CASE(windows_are_those_of_the_first_row) {
  const SmallSet set(observed_at_three_times());
  const MeasurementSet read(set.path(), in_frame("LSRK"), "data");
  const auto windows = read.spectral_windows();
  BOOST_TEST_REQUIRE(windows.size() == 1U);
  const double ratio = ratios(set, "LSRK").front();
  BOOST_TEST_REQUIRE(windows[0].frequency_hz.size() == channels);
  for (std::size_t c = 0; c < channels; ++c) {
    BOOST_TEST(windows[0].frequency_hz[c] == (1e9 + 1e6 * static_cast<double>(c)) * ratio);
    BOOST_TEST(windows[0].channel_width_hz[c] == 1e6 * ratio);
  }
}

BOOST_AUTO_TEST_CASE(a_part_reads_the_channels_that_may_come_between_two_frequencies) {
  const SmallSet set(observed_at_three_times());
  const MeasurementSet read(set.path(), in_frame("TOPO"), "data");
  const auto part = read.part({1.0029e9, 1.0031e9});
  BOOST_TEST_REQUIRE((part != nullptr));
  const auto block = part->open()->next();
  // 0.2 MHz of Doppler shift and one and a half channels on either side.
  BOOST_TEST(block->frequency_hz == (std::vector<double>{1.002e9, 1.003e9, 1.004e9}), boost::test_tools::per_element());
  BOOST_TEST(block->rows() == 3 * baselines);
  const auto whole = read.open()->next();
  for (std::size_t row = 0; row < block->rows(); ++row)
    for (std::size_t c = 0; c < 3; ++c) BOOST_TEST(block->visibility[row * 3 + c] == whole->visibility[row * channels + c + 2]);
  BOOST_TEST((read.part({2e9, 2.1e9}) == nullptr));
}

BOOST_AUTO_TEST_CASE(parts_that_share_channels_count_each_sample_once) {
  const SmallSet set(observed_at_three_times());
  const MeasurementSet read(set.path(), in_frame("TOPO"), "data");
  const auto counted = [](const imager::VisibilitySource& source) {
    imager::SampleCounts counts;
    const auto stream = source.open();
    while (const auto block = stream->next()) counts += block->counts;
    return counts;
  };
  const imager::SampleCounts whole = counted(read);
  imager::SampleCounts parts;
  std::uint64_t samples = 0;
  for (std::size_t c = 0; c < channels; ++c) {
    const double first = 1e9, hz = first + 1e6 * static_cast<double>(c);
    const auto part = c == 0 ? read.part({hz, hz}) : read.part({hz, hz}, ms_io::FrequencyRange{first, hz - 1e6});
    samples += part->samples();
    parts += counted(*part);
  }
  BOOST_TEST(samples > 2 * whole.samples_read);
  BOOST_TEST(parts.rows_read == whole.rows_read);
  BOOST_TEST(parts.samples_read == whole.samples_read);
  BOOST_TEST(parts.autocorrelations == whole.autocorrelations);
  BOOST_TEST(parts.flagged == whole.flagged);
  BOOST_TEST(parts.used == whole.used);
}

BOOST_AUTO_TEST_CASE(a_part_reads_and_holds_no_other_channels) {
  const ManyChannels set;
  const auto part = MeasurementSet(set.path(), in_frame("TOPO"), "data").part({1.1e9, 1.1e9});
  BOOST_TEST(part->samples() == 3 * rows);
  BOOST_TEST(part->read_at_once() == 3 * rows);
  // Coordinates, antennas, times and flags come with every channel. What was read once casacore may hold: two open sets.
  const std::uint64_t all = bytes_of_pass(MeasurementSet(set.path(), in_frame("TOPO"), "data")), data = rows * 1000 * 2 * 8;
  BOOST_TEST(all >= data);
  BOOST_TEST(bytes_of_pass(*part) <= all - data + 2 * 8 * rows * 2 * 8);  // two tiles
}

namespace {

/// Antennas relative to the first, as some simulators have them.
void make_positions_relative(const SmallSet& set) {
  set.modify([](casacore::MeasurementSet& open) {
    casacore::ArrayColumn<double> position(open.antenna(), "POSITION");
    const casacore::Array<double> first = position(0);
    for (casacore::rownr_t a = 0; a < antennas; ++a) position.put(a, position(a) - first);
  });
}

void name_telescope(const SmallSet& set, const std::string& name) {
  set.modify([&](casacore::MeasurementSet& open) {
    casacore::ScalarColumn<casacore::String>(open.observation(), "TELESCOPE_NAME").put(0, name);
  });
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_telescope_that_is_known_stands_where_it_does_whatever_its_antennas_say) {
  for (const std::string name : {"VLA", "EVLA"}) {
    const SmallSet set(observed_at_three_times());
    name_telescope(set, name);
    const std::vector<double> before = ratios(set, "LSRK");
    make_positions_relative(set);
    // The antennas of a set called EVLA, which casacore does not know, stand some 10 m from the VLA's centre: the ground turns
    // by 1e-3 m/s more or less.
    const std::vector<double> after = ratios(set, "LSRK");
    for (std::size_t row = 0; row < before.size(); ++row)
      BOOST_TEST(std::abs(after[row] - before[row]) <= (name == "VLA" ? 0 : 1e-10));
    BOOST_TEST(MeasurementSet(set.path(), in_frame("LSRK"), "data").remarks().empty());
  }
}

BOOST_AUTO_TEST_CASE(frequencies_without_the_turning_of_the_earth_are_warned_of) {
  const SmallSet set(observed_at_three_times());
  const auto remarks = [&](const Selection& selection) { return MeasurementSet(set.path(), selection, "data").remarks(); };
  name_telescope(set, "NOWHERE");
  BOOST_TEST(remarks(in_frame("LSRK")).empty());
  // The other antennas on the Earth will do: their middle is 150 m from that of all, where the ground turns by 11 mm/s more or
  // less.
  const std::vector<double> before = ratios(set, "LSRK");
  set.modify([](casacore::MeasurementSet& open) {
    casacore::ArrayColumn<double>(open.antenna(), "POSITION").put(0, casacore::Vector<double>(3, 0.0));
  });
  BOOST_TEST(remarks(in_frame("LSRK")).empty());
  for (std::size_t row = 0; row < before.size(); ++row) BOOST_TEST(std::abs(ratios(set, "LSRK")[row] - before[row]) < 4e-11);
  set.modify([](casacore::MeasurementSet& open) {
    for (casacore::rownr_t a = 1; a < antennas; ++a)
      casacore::ArrayColumn<double>(open.antenna(), "POSITION").put(a, casacore::Vector<double>(3, 100.0));
  });
  BOOST_REQUIRE(remarks(in_frame("LSRK")).size() == 1);
  const std::string remark = remarks(in_frame("LSRK")).front();
  BOOST_TEST(remark == "frequencies of " + set.path() +
                           " are converted to LSRK without the Earth's rotation, up to 0.5 km/s, since casacore does not know "
                           "where a telescope 'NOWHERE' stands, and POSITION of antenna 0 (A0) is 0 m from the middle of the "
                           "Earth, expected some 6371000 m; expected a TELESCOPE_NAME that casacore knows, or positions from "
                           "the Earth's middle");
  BOOST_TEST(remarks(in_frame("TOPO")).empty());
  BOOST_TEST(remarks({}).empty());
}

namespace {

using Positions = std::vector<casacore::Vector<double>>;
using Change = std::function<void(Positions&)>;

/// One set under several names, with its antennas moved.
class Telescope : public SmallSet {
 public:
  Telescope() : SmallSet(observed_at_three_times()) {
    modify([&](casacore::MeasurementSet& open) {
      const casacore::ArrayColumn<double> column(open.antenna(), "POSITION");
      for (casacore::rownr_t a = 0; a < antennas; ++a) own_.emplace_back(column(a));
    });
  }

  void move(const Change& change) const {
    Positions positions;
    for (const auto& position : own_) positions.push_back(position.copy());
    change(positions);
    modify([&](casacore::MeasurementSet& open) {
      casacore::ArrayColumn<double> column(open.antenna(), "POSITION");
      for (casacore::rownr_t a = 0; a < antennas; ++a) column.put(a, positions[a]);
    });
  }
  std::vector<double> ratios_of(const std::string& name, const Change& change) const {
    name_telescope(*this, name);
    move(change);
    return ratios(*this, "LSRK");
  }
  std::vector<std::string> remarks() const { return MeasurementSet(path(), in_frame("LSRK"), "data").remarks(); }

 private:
  Positions own_;
};

const auto as_they_are = [](Positions&) {};

/// Metres for kilometres and the like.
Change times(double size) {
  return [size](Positions& positions) {
    for (auto& position : positions)
      for (double& value : position) value *= size;
  };
}

}  // namespace

BOOST_AUTO_TEST_CASE(the_place_of_a_telescope_does_not_depend_on_the_order_of_its_antennas) {
  const Telescope set;
  for (const std::string name : {"NOWHERE", "EVLA", "MeerKAT", ""}) {
    const std::vector<double> before = set.ratios_of(name, as_they_are);
    for (const std::size_t turn : {1, 2, 3}) {
      const auto turned = [&](Positions& positions) {
        std::rotate(positions.begin(), positions.begin() + static_cast<std::ptrdiff_t>(turn), positions.end());
      };
      BOOST_TEST(set.ratios_of(name, turned) == before, boost::test_tools::per_element());
    }
  }
}

BOOST_AUTO_TEST_CASE(positions_far_below_and_above_the_ground_are_none) {
  const Telescope set;
  const std::vector<double> vla = set.ratios_of("VLA", times(0));
  for (const double size : {0.0, 1e-3, 0.9, 1.1, 100.0, 1e3, nan_value}) {
    for (const double ratio : set.ratios_of("NOWHERE", times(size))) BOOST_TEST(std::isfinite(ratio));
    BOOST_REQUIRE(set.remarks().size() == 1U);
    BOOST_TEST(contains(set.remarks().front(), "without the Earth's rotation"));
    for (const std::string name : {"VLA", "EVLA", "evla", "JVLA"}) {
      BOOST_TEST(set.ratios_of(name, times(size)) == vla, boost::test_tools::per_element());
      BOOST_TEST(set.remarks().empty());
    }
  }
}

// casacore takes the beginning of a name for it.
BOOST_AUTO_TEST_CASE(antennas_that_stand_far_from_the_telescope_of_that_name_are_believed_with_a_word) {
  const Telescope set;
  const std::vector<double> antennas_own = set.ratios_of("NOWHERE", as_they_are);
  for (const std::string name : {"MeerKAT", "WSRT", "SKA1-MID", "SK", "W", "ME", "VLA-sim"}) {
    BOOST_TEST(set.ratios_of(name, as_they_are) == antennas_own, boost::test_tools::per_element());
    const std::vector<std::string> remarks = set.remarks();
    const bool whole_name = name.size() > 3 && name != "VLA-sim";
    BOOST_TEST(remarks.size() == (whole_name ? 1U : 0U), name);
    for (const std::string& remark : remarks)
      BOOST_TEST(contains(remark, "TELESCOPE_NAME is '" + name + "', which casacore places "), remark);
  }
}

namespace {

/// Every third row, of antennas 1 and 2 here, is one of a second observation.
void add_observation(const SmallSet& set, const std::string& first, const std::string& second) {
  set.modify([&](casacore::MeasurementSet& open) {
    open.observation().addRow(1);
    casacore::ScalarColumn<casacore::String> name(open.observation(), "TELESCOPE_NAME");
    name.put(0, first);
    name.put(1, second);
    casacore::ScalarColumn<int> id(open, "OBSERVATION_ID"), one(open, "ANTENNA1"), other(open, "ANTENNA2");
    for (casacore::rownr_t row = 0; row < open.nrow(); ++row) {
      const bool of_second = row % 3 == 1;
      id.put(row, of_second ? 1 : 0);
      one.put(row, of_second ? 1 : 0);
      other.put(row, of_second ? 2 : 3);
    }
  });
}

}  // namespace

BOOST_AUTO_TEST_CASE(each_row_is_seen_from_its_own_telescope) {
  const auto first_two = [](Positions& positions) { positions = {positions[0], positions[0], positions[3], positions[3]}; };
  const auto elsewhere = [](Positions& positions) {
    positions[1] = positions[2] = positions[0];
    positions[1](0) = positions[2](0) = -positions[0](0);
  };
  const auto all_elsewhere = [&](Positions& positions) {
    elsewhere(positions);
    positions[0] = positions[3] = positions[1];
  };
  struct Law {
    std::string first, second;
    Change positions, alone;
  };
  for (const Law& law : {Law{"VLA", "ATCA", as_they_are, times(0)}, Law{"NOWHERE", "NEITHER", elsewhere, all_elsewhere}}) {
    const Telescope set;
    const Change one_alone = law.first == "VLA" ? times(0) : Change(first_two);
    const std::vector<double> one = set.ratios_of(law.first, one_alone), other = set.ratios_of(law.second, law.alone);
    set.move(law.positions);
    add_observation(set, law.first, law.second);
    const std::vector<double> both = ratios(set, "LSRK");
    BOOST_REQUIRE(both.size() == one.size());
    for (std::size_t row = 0; row < both.size(); ++row) BOOST_TEST(both[row] == (row % 3 == 1 ? other : one)[row]);
  }
}

BOOST_AUTO_TEST_CASE(frames_go_by_the_names_of_casa) {
  BOOST_TEST(parse_spectral_frame("lsrk") == "LSRK");
  BOOST_TEST(parse_spectral_frame("Bary") == "BARYCENT");
  BOOST_TEST(parse_spectral_frame("CMB") == "CMBDIPOL");
  for (const std::string unknown : {"", "LSR", "SOURCE", "TOPOCENT"}) {
    const std::string message =
        "spectral frame '" + unknown + "'; expected one of LSRK, LSRD, BARY, GEO, TOPO, GALACTO, LGROUP, CMB";
    const auto said = [&](const auto& error) { return error.what() == message; };
    BOOST_CHECK_EXCEPTION(parse_spectral_frame(unknown), std::invalid_argument, said);
  }
}

BOOST_AUTO_TEST_CASE(windows_at_rest_or_of_no_frame_are_refused) {
  for (const auto& [code, what] : {std::pair{0, "at rest in the source"}, {77, "no frame that is known"}}) {
    const SmallSet set(observed_at_three_times());
    set.modify([&, frame = code](casacore::MeasurementSet& changed) {
      casacore::ScalarColumn<int>(changed.spectralWindow(), "MEAS_FREQ_REF").put(0, frame);
    });
    const auto named = [text = what](const auto& error) { return std::string(error.what()).find(text) != std::string::npos; };
    BOOST_CHECK_EXCEPTION(ratios(set, "LSRK"), std::runtime_error, named);
  }
}

BOOST_AUTO_TEST_SUITE_END()
