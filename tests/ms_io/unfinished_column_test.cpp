// Columns whose writing was cut short, and what the next run makes of them.
#include <sys/wait.h>

#include <boost/test/unit_test.hpp>
#include <fstream>
#include <iterator>
#include <thread>

#include "ms_io/model_writer.h"
#include "tests/ms_io/small_set.h"

namespace misfit::ms_io {

BOOST_AUTO_TEST_SUITE(unfinished_column)

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

/// Writes the model; `stop_after` blocks, or before the first one is predicted, a Stop comes through.
Told write(const SmallSet& set, ModelColumn column, const Selection& which = selection, int stop_after = 1 << 20,
           std::uint64_t fingerprint = 1) {
  Told told;
  column.origin = {"misfit predict --model a.fits", fingerprint, [&](const std::string& s) { told.sentences.push_back(s); }};
  int blocks = 0;
  const auto progress = [&](std::uint64_t, std::uint64_t) {
    if (++blocks == stop_after) throw Stop();
  };
  const auto predict = [&](const imager::SampleCoordinates& where) {
    if (stop_after == 0) throw Stop();
    return model(where);
  };
  try {
    told.report = write_model(set.path(), which, column, predict, progress, {rows_at_once * 4});
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

/// As another program does that writes the whole column.
void fill(const SmallSet& set, const std::string& column, const Complex& value) {
  set.modify([&](casacore::MeasurementSet& ms) {
    casacore::ArrayColumn<Complex> cells(ms, column);
    for (casacore::rownr_t row = 0; row < ms.nrow(); ++row) cells.put(row, casacore::Array<Complex>(cells.shape(row), value));
  });
}

std::string record(const SmallSet& set, const ModelColumn& column) {
  std::ifstream file(set.path() + "/misfit_unfinished_" + column.name);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The set opens, and the next run begins or goes on to what an uninterrupted one makes.
void check_rest(const SmallSet& set, const ModelColumn& column, const std::vector<Complex>& expected) {
  BOOST_TEST(read_all(MeasurementSet(set.path(), {"0", ""}, "DATA")).counts.rows_read == 15U);
  const std::string incomplete = incomplete_column(set.path(), column.name);
  const Told told = write(set, column);
  BOOST_TEST(told.sentences.size() == (incomplete.empty() ? 0U : 1U));
  for (const std::string& sentence : told.sentences) BOOST_TEST(sentence == incomplete + ", going on");
  BOOST_TEST((all_of(set, column.name) == expected));
  BOOST_TEST(incomplete_column(set.path(), column.name) == "");
}

const ModelColumn plain{"MODEL_DATA"}, difference{"CORRECTED_DATA", "DATA", false}, in_place{"MODEL_DATA", "MODEL_DATA"};

}  // namespace

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
    BOOST_TEST((all_of(set, "MODEL_DATA") == whole(plain)) == (which.spectral_window.of(0) == selection.spectral_window.of(0)));
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

BOOST_AUTO_TEST_CASE(data_that_changed_after_the_model_was_subtracted_from_them_are_taken_anew) {
  for (const std::size_t row : {std::size_t{1}, rows - 1}) {  // is written before the run stops, and is not
    const MixedSet set, equal;
    for (const MixedSet* one : {&set, &equal}) {
      if (one == &set) write(set, difference, selection, 2);
      one->put("DATA", row, 0, 2, Complex(99));
    }
    const Told told = write(set, difference);
    BOOST_REQUIRE(told.sentences.size() == 1U);
    BOOST_TEST(contains(told.sentences.front(),
                        row == 1 ? " from DATA, which has changed since; this run begins anew" : ", going on"));
    write(equal, difference);
    BOOST_TEST((all_of(set, "CORRECTED_DATA") == all_of(equal, "CORRECTED_DATA")));
  }
}

BOOST_AUTO_TEST_CASE(coordinates_that_changed_since_begin_anew) {
  const auto move = [](const MixedSet& set) { set.put("UVW", 1, 0, 0, 99.0); };
  const auto retune = [](const MixedSet& set) {
    set.modify([](casacore::MeasurementSet& ms) {
      casacore::MSSpWindowColumns window(ms.spectralWindow());
      for (casacore::rownr_t w = 0; w < ms.spectralWindow().nrow(); ++w) {
        casacore::Vector<double> frequency = window.chanFreq()(w);
        for (double& f : frequency) f *= 1.5;
        window.chanFreq().put(w, frequency);
      }
    });
  };
  for (const std::function<void(const MixedSet&)>& change : {std::function<void(const MixedSet&)>(move), {retune}}) {
    const MixedSet set, equal;
    write(set, plain, selection, 2);
    for (const MixedSet* one : {&set, &equal}) change(*one);
    const Told told = write(set, plain);
    BOOST_REQUIRE(told.sentences.size() == 1U);
    BOOST_TEST(contains(told.sentences.front(), "other coordinates, and begins anew"));
    write(equal, plain);
    BOOST_TEST((all_of(set, "MODEL_DATA") == all_of(equal, "MODEL_DATA")));
  }
}

BOOST_AUTO_TEST_CASE(data_of_another_column_begin_anew) {
  const MixedSet set;
  write(set, {"RESIDUAL", "DATA"}, selection, 2);
  write(set, {"OTHER_DATA", "DATA"}, {"1", "0~1:2"});
  const Told told = write(set, {"RESIDUAL", "OTHER_DATA"});
  BOOST_REQUIRE(told.sentences.size() == 2U);
  BOOST_TEST(contains(told.sentences.front(), "begins anew"));
  BOOST_TEST(contains(told.sentences.back(), " has already been subtracted from OTHER_DATA of " + set.path()));
}

BOOST_AUTO_TEST_CASE(a_column_that_another_program_wrote_since_is_complete_and_the_next_run_begins_anew) {
  for (const int stop_after : {0, 3}) {
    const MixedSet set;
    write(set, plain, selection, stop_after);
    BOOST_TEST(incomplete_column(set.path(), "MODEL_DATA") != "");
    fill(set, "MODEL_DATA", Complex(0.5F, 2));
    BOOST_TEST(incomplete_column(set.path(), "MODEL_DATA") == "");
    const Told told = write(set, plain);
    BOOST_REQUIRE(told.sentences.size() == 1U);
    BOOST_TEST(contains(told.sentences.front(), "have changed since; this run begins anew"));
    BOOST_TEST(told.report.rows_before == 0U);
    const MixedSet equal;
    write(equal, plain);
    fill(equal, "MODEL_DATA", Complex(0.5F, 2));
    write(equal, plain);
    BOOST_TEST((all_of(set, "MODEL_DATA") == all_of(equal, "MODEL_DATA")));
  }
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
  // Stopped before it wrote a row; then calibration writes them all.
  const MixedSet calibrated;
  write(calibrated, difference, selection, 0);
  fill(calibrated, "CORRECTED_DATA", Complex(1, 1));
  BOOST_TEST(contains(error_of([&] { write(calibrated, difference); }), "CORRECTED_DATA already"));
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

BOOST_AUTO_TEST_CASE(a_model_is_subtracted_in_place_once_however_often_the_run_is_stopped) {
  const MixedSet set, whole_set;
  for (const MixedSet* one : {&set, &whole_set})
    for (const char* field : {"0", "1"}) write(*one, plain, {field, ""}, 1 << 20, 7);
  write(whole_set, in_place);
  for (const int stop_after : {0, 1, 1, 2}) write(set, in_place, selection, stop_after);
  BOOST_TEST(contains(incomplete_column(set.path(), "model"), "is incomplete"));
  BOOST_TEST(contains(error_of([&] { write(set, in_place, selection, 1 << 20, 2); }), "expected that command again"));
  BOOST_TEST(contains(error_of([&] { write(set, in_place, {"1", "0~1:1~3"}); }), "expected that command again"));
  write(set, in_place);
  BOOST_TEST((all_of(set, "MODEL_DATA") == all_of(whole_set, "MODEL_DATA")));
  BOOST_TEST(incomplete_column(set.path(), "model") == "");
}

BOOST_AUTO_TEST_CASE(data_that_another_program_wrote_after_a_run_in_place_was_cut_are_not_overwritten_by_what_that_kept) {
  for (const int stop_after : {0, 1, 2}) {
    const MixedSet set, equal;
    for (const MixedSet* one : {&set, &equal}) {
      for (const char* field : {"0", "1"}) write(*one, plain, {field, ""}, 1 << 20, 7);
      if (one == &set) write(*one, in_place, selection, stop_after);
      fill(*one, "MODEL_DATA", Complex(0.5F, 2));
      write(*one, in_place);
    }
    BOOST_TEST((all_of(set, "MODEL_DATA") == all_of(equal, "MODEL_DATA")));
  }
}

BOOST_AUTO_TEST_CASE(data_that_lack_a_model_lose_it_once_and_tell_of_it_when_another_is_subtracted) {
  const MixedSet set;
  write(set, difference);
  const auto corrected = all_of(set, "CORRECTED_DATA");
  const ModelColumn again{"CORRECTED_DATA", "CORRECTED_DATA"}, beside{"TWICE", "CORRECTED_DATA"};
  const std::string refusal = error_of([&] { write(set, again); });
  BOOST_TEST(contains(refusal, "the model of misfit predict --model a.fits"), refusal);
  BOOST_TEST(contains(refusal, " has already been subtracted from CORRECTED_DATA of "), refusal);
  BOOST_TEST((all_of(set, "CORRECTED_DATA") == corrected));
  const auto told = [&](const ModelColumn& column, std::uint64_t fingerprint) {
    return write(set, column, selection, 1 << 20, fingerprint).sentences;
  };
  BOOST_TEST(told(beside, 1).size() == 1U);  // into another column it may be subtracted twice
  BOOST_TEST(told(again, 2).size() == 1U);   // this one lacks two from here on
  BOOST_TEST(told(again, 3).size() == 2U);
  BOOST_TEST(contains(error_of([&] { write(set, again); }), "has already been subtracted from"));
  BOOST_TEST(told({"CORRECTED_DATA", "DATA"}, 1).empty());  // and one
  BOOST_TEST(told(again, 2).size() == 1U);
  fill(set, "CORRECTED_DATA", Complex(1, 1));  // and none
  BOOST_TEST(told(again, 1).empty());
  write(set, {"CORRECTED_DATA"});  // a prediction is no data
  BOOST_TEST(told(again, 2).empty());
}

BOOST_AUTO_TEST_CASE(models_that_the_data_lack_are_told_of_with_their_selections_and_that_of_the_run) {
  const ModelColumn in_place{"MODEL_DATA", "MODEL_DATA"};
  std::vector<std::pair<Selection, std::string>> parts{
      {{"1", ""}, "--field '1'"}, {{"", "0:1~2"}, "--spw '0:1~2'"}, {{"0", "1"}, "--field '0' --spw '1'"}, {{}, ""}};
  for (auto& [part, words] : parts) part.phase_centre = imager::SkyDirection{1.25, -0.5, "FK5"};
  for (const auto& [first, first_words] : parts)
    for (const auto& [second, second_words] : parts) {
      if (first_words == second_words) continue;
      const MixedSet set;
      write(set, plain, parts.back().first);
      write(set, in_place, first);
      const std::vector<std::string> sentences = write(set, in_place, second).sentences;
      BOOST_REQUIRE(sentences.size() == 1U);
      const std::string before =
          "a.fits" + (first_words.empty() ? "" : " " + first_words) + " has already been subtracted from ";
      BOOST_TEST(contains(sentences.front(), before), sentences.front());
      BOOST_TEST(contains(sentences.front(), "; this run selects " + (second_words.empty() ? "all rows" : second_words)),
                 sentences.front());
    }
}

BOOST_AUTO_TEST_CASE(what_the_data_lack_is_known_though_another_program_changed_some_baselines) {
  for (std::size_t baseline = 0; baseline < baselines; ++baseline) {
    const MixedSet set;
    write(set, difference);
    set.modify([&](casacore::MeasurementSet& ms) {
      casacore::ArrayColumn<Complex> cells(ms, "CORRECTED_DATA");
      for (casacore::rownr_t row = baseline; row < ms.nrow(); row += baselines)
        cells.put(row, casacore::Array<Complex>(cells.shape(row), Complex(1, 1)));
    });
    BOOST_TEST(contains(error_of([&] {
                          write(set, {"CORRECTED_DATA", "CORRECTED_DATA"});
                        }),
                        "has already been subtracted from"));
  }
}

BOOST_AUTO_TEST_CASE(the_command_that_reads_the_data_tells_what_they_lack) {
  const MixedSet set;
  write(set, difference);
  const auto columns = MeasurementSet(set.path(), {"0", ""}, "auto").data_columns();
  BOOST_REQUIRE(columns.size() == 1U);
  BOOST_TEST(columns.front().name == "CORRECTED_DATA");
  BOOST_TEST(columns.front().subtracted ==
             std::vector<std::string>{"misfit predict --model a.fits --field '1' --spw '0~1:1~4'"});
  BOOST_TEST(MeasurementSet(set.path(), {"0", ""}, "data").data_columns().front().subtracted.empty());
}

BOOST_AUTO_TEST_CASE(a_run_that_was_killed_leaves_the_record_of_one_that_was_stopped_and_goes_on) {
  for (const ModelColumn& column : {plain, difference}) {
    const std::vector<Complex> expected = whole(column);
    for (const int blocks : {0, 3}) {
      const MixedSet set, stopped;
      write(stopped, column, selection, blocks);
      const pid_t child = fork();
      if (child == 0) {
        int predictions = 0;
        const auto predict = [&](const imager::SampleCoordinates& where) {
          while (predictions == blocks) pause();
          ++predictions;
          return model(where);
        };
        ModelColumn told = column;
        told.origin = {"misfit predict --model a.fits", 1, {}};
        try {
          write_model(set.path(), selection, told, predict, {}, {rows_at_once * 4});
        } catch (...) {
        }
        _exit(1);
      }
      while (record(set, column) != record(stopped, column) && waitpid(child, nullptr, WNOHANG) == 0) std::this_thread::yield();
      kill(child, SIGKILL);
      waitpid(child, nullptr, 0);
      check_rest(set, column, expected);
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()

}  // namespace misfit::ms_io
