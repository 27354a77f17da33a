// Columns whose writing was cut short, and what the next run makes of them.
#include <sys/wait.h>

#include <boost/test/unit_test.hpp>
#include <chrono>
#include <thread>

#include "ms_io/model_writer.h"
#include "tests/ms_io/small_set.h"

namespace misfit::ms_io {

using namespace testing;

namespace {

using casacore::Complex;

constexpr std::size_t rows_at_once = 4;

/// A model that depends on row and channel.
std::vector<std::complex<double>> model(const imager::SampleCoordinates& where) {
  std::vector<std::complex<double>> values = small_visibilities(where);
  for (std::complex<double>& value : values) value = {value.imag() / 3, value.real() / 7};
  return values;
}

/// Two fields and two spectral windows; one field is selected, and some channels.
struct MixedSet : SmallSet {
  MixedSet() {
    add_field(1.5, -0.25);
    add_spectral_window();
  }
};
const Selection selection{"1", "0~1:1~4"};

struct Told {
  std::vector<std::string> sentences;
  ModelWriteReport report;
};

struct Stop {};

/// Writes the model; `stop_after` blocks a Stop comes through.
Told write(const SmallSet& set, ModelColumn column, const Selection& which = selection, int stop_after = 1 << 20,
           std::uint64_t fingerprint = 1) {
  Told told;
  column.origin = {"misfit predict --model a.fits", fingerprint, [&](const std::string& s) { told.sentences.push_back(s); }};
  int blocks = 0;
  const auto progress = [&](std::uint64_t, std::uint64_t) {
    if (++blocks == stop_after) throw Stop();
  };
  try {
    told.report = write_model(set.path(), which, column, model, progress, rows_at_once * 4);
  } catch (const Stop&) {
  }
  return told;
}

std::vector<Complex> all_of(const SmallSet& set, const std::string& column) {
  std::vector<Complex> values;
  for (std::size_t r = 0; r < rows; ++r) {
    const auto cell = set.cell(column, r).tovector();
    values.insert(values.end(), cell.begin(), cell.end());
  }
  return values;
}

/// What a run that is not interrupted makes of an equal set.
const std::vector<Complex>& whole(const ModelColumn& column) {
  static std::map<std::string, std::vector<Complex>> known;
  std::vector<Complex>& values = known[column.name];
  if (values.empty()) {
    const MixedSet set;
    write(set, column);
    values = all_of(set, column.name);
  }
  return values;
}

const ModelColumn plain{"MODEL_DATA"}, difference{"CORRECTED_DATA", "DATA", false};

}  // namespace

BOOST_AUTO_TEST_SUITE(unfinished_column)

BOOST_AUTO_TEST_CASE(a_run_that_was_stopped_goes_on_to_the_same_bits) {
  for (const ModelColumn& column : {plain, difference}) {
    const std::vector<Complex> expected = whole(column);
    for (const int stop_after : {1, 3}) {
      const MixedSet set;
      write(set, column, selection, stop_after);
      const std::string incomplete = incomplete_column(set.path(), column.name);
      BOOST_TEST(contains(incomplete, column.name + " of " + set.path() + " is incomplete: "));
      BOOST_TEST(contains(incomplete, "of 15 rows were written before by misfit predict --model a.fits"));
      const Told told = write(set, column);
      BOOST_REQUIRE(told.sentences.size() == 1U);
      BOOST_TEST(told.sentences.front() == incomplete + ", going on");
      BOOST_TEST(told.report.rows == 15U);
      BOOST_TEST(told.report.rows_before > 0U);
      BOOST_TEST(told.report.rows_before < 15U);
      BOOST_TEST(told.report.samples == 15U * 4U);
      BOOST_TEST((all_of(set, column.name) == expected));
      BOOST_TEST(incomplete_column(set.path(), column.name) == "");
    }
  }
}

BOOST_AUTO_TEST_CASE(rows_with_a_nonfinite_uvw_are_counted_once_over_both_runs) {
  const MixedSet set;
  set.put("UVW", 1, 0, 0, nan_value);
  write(set, plain, selection, 2);
  BOOST_TEST(write(set, plain).report.nonfinite_uvw_rows == 1U);
}

BOOST_AUTO_TEST_CASE(another_model_or_selection_begins_anew) {
  for (const auto& [which, fingerprint] : {std::pair(selection, 2), {Selection{"1", "0~1:1~3"}, 1}, {selection, 0}}) {
    const MixedSet set;
    write(set, plain, selection, 1);
    const Told told = write(set, plain, which, 1 << 20, static_cast<std::uint64_t>(fingerprint));
    BOOST_REQUIRE(told.sentences.size() == 1U);
    BOOST_TEST(contains(told.sentences.front(), "begins anew"));
    BOOST_TEST(told.report.rows_before == 0U);
    BOOST_TEST((all_of(set, "MODEL_DATA") == whole(plain)) == (which.spectral_window == selection.spectral_window));
    BOOST_TEST(incomplete_column(set.path(), "MODEL_DATA") == "");
  }
}

BOOST_AUTO_TEST_CASE(rows_that_another_program_changed_are_written_again) {
  const MixedSet set;
  write(set, plain, selection, 2);
  set.put("MODEL_DATA", 1, 0, 2, Complex(99));
  const Told told = write(set, plain);
  BOOST_REQUIRE(told.sentences.size() == 1U);
  BOOST_TEST(contains(told.sentences.front(), "have changed since; this run begins anew"));
  BOOST_TEST((all_of(set, "MODEL_DATA") == whole(plain)));
}

BOOST_AUTO_TEST_CASE(a_column_that_must_be_new_is_taken_up_by_the_run_that_made_it_alone) {
  const MixedSet set;
  write(set, difference, selection, 1);
  BOOST_TEST(contains(error_of([&] { write(set, difference, selection, 1 << 20, 2); }), "CORRECTED_DATA already"));
  write(set, difference);
  BOOST_TEST((all_of(set, "CORRECTED_DATA") == whole(difference)));
}

BOOST_AUTO_TEST_CASE(a_column_that_another_program_made_or_changed_is_left_alone_whatever_the_record_says) {
  // Killed before it made the column; then calibration makes it.
  const MixedSet made, changed;
  write(made, difference, selection, 1);
  made.modify([](casacore::MeasurementSet& ms) {
    ms.removeColumn("CORRECTED_DATA");
    ms.addColumn(casacore::ArrayColumnDesc<Complex>("CORRECTED_DATA", 2));
    casacore::ArrayColumn<Complex> corrected(ms, "CORRECTED_DATA"), data(ms, "DATA");
    for (casacore::rownr_t row = 0; row < ms.nrow(); ++row) corrected.put(row, data(row));
  });
  BOOST_TEST(contains(error_of([&] { write(made, difference); }), "CORRECTED_DATA already"));
  write(changed, difference, selection, 2);
  changed.put("CORRECTED_DATA", 1, 0, 2, Complex(99));
  BOOST_TEST(contains(error_of([&] { write(changed, difference); }), "CORRECTED_DATA already"));
}

BOOST_AUTO_TEST_CASE(a_record_without_its_column_is_none) {
  const MixedSet set;
  write(set, plain, selection, 1);
  set.modify([](casacore::MeasurementSet& ms) { ms.removeColumn("MODEL_DATA"); });
  BOOST_TEST(incomplete_column(set.path(), "model") == "");
  BOOST_TEST(write(set, plain).sentences.empty());
  BOOST_TEST((all_of(set, "MODEL_DATA") == whole(plain)));
}

BOOST_AUTO_TEST_CASE(a_record_that_cannot_be_read_counts_as_nothing_written) {
  const MixedSet set;
  write(set, plain, selection, 2);
  std::filesystem::resize_file(set.path() + "/misfit_unfinished_MODEL_DATA", 60);
  const Told told = write(set, plain);
  BOOST_REQUIRE(told.sentences.size() == 1U);
  BOOST_TEST(contains(told.sentences.front(), "a run that left no trace"));
  BOOST_TEST((all_of(set, "MODEL_DATA") == whole(plain)));
}

BOOST_AUTO_TEST_CASE(a_run_that_was_killed_leaves_a_set_that_opens_and_its_record_claims_no_more_than_is_written) {
  const std::vector<Complex> expected = whole(plain), subtracted = whole(difference);
  for (int wait_us = 0; wait_us < 60'000; wait_us += 6'000) {
    const ModelColumn& column = wait_us % 12'000 == 0 ? plain : difference;
    const MixedSet set;
    const pid_t child = fork();
    if (child == 0) {
      write(set, column);
      _exit(0);
    }
    std::this_thread::sleep_for(std::chrono::microseconds(wait_us));
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    BOOST_TEST(read_all(MeasurementSet(set.path(), {"0", ""}, "DATA")).counts.rows_read == 15U);
    const std::string incomplete = incomplete_column(set.path(), column.name);
    // Killed between its last row and the record's removal it is complete, and may not be made again.
    const bool complete = incomplete.empty() && casacore::MeasurementSet(set.path()).tableDesc().isColumn(column.name);
    if (!complete) BOOST_TEST(write(set, column).sentences.size() == (incomplete.empty() ? 0U : 1U));
    BOOST_TEST((all_of(set, column.name) == (column.subtracted_from.empty() ? expected : subtracted)));
    BOOST_TEST(incomplete_column(set.path(), column.name) == "");
  }
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace misfit::ms_io
