// Runs whose MeasurementSet something else writes to meanwhile.
#include <limits>

#include "tests/faults/replaced_products.h"
#include "tests/tools/set_changes.h"

BOOST_AUTO_TEST_SUITE(changed_input)

using namespace misfit::tools::testing;
using misfit::testing::reading_calls;

namespace {

namespace fs = std::filesystem;

/// So large that --memory 0.2 has it read in every pass.
const std::string& long_track() {
  static const TemporaryFolder folder;
  static const std::string path = [] {
    succeed(
        {"simulate", "--output", folder / "long.ms", "--hours", "2", "--interval", "60", "--channels", "64", "--noncoplanar"});
    return folder / "long.ms";
  }();
  return path;
}

Arguments clean(const std::string& set, const std::string& name, const char* memory_gib = "0.2") {
  return {"image",   "--vis", set,        "--imagename", name,          "--imsize", "64",        "--cell", "0.1arcsec",
          "--niter", "40",    "--memory", memory_gib,    "--weighting", "briggs",   "--threads", "2",      "--quiet"};
}

fs::path copy_of(const std::string& set, const std::string& to) {
  fs::remove_all(to);
  fs::copy(set, to, fs::copy_options::recursive);
  return to;
}

/// Writes the bytes of the files of one set over those of another, as a program does that changes values.
void write_over(const fs::path& from, const fs::path& to) {
  for (const auto& file : fs::directory_iterator(from)) {
    const std::string name = file.path().filename();
    if (name.rfind("table.f", 0) != 0) continue;
    const std::string bytes = content(file.path());
    if (bytes != content(to / name)) std::fstream(to / name, std::ios::in | std::ios::out | std::ios::binary) << bytes;
  }
}

/// Reads of the values of the set, subtables apart.
bool reads_values(const SystemCall& call, const std::string& set) {
  return call.path().rfind(set + "/table.f", 0) == 0;
}

std::string warnings_of(const std::string& imagename) {
  return report_of(imagename)["warnings"].dump();
}

using Change = std::function<void(const std::string&)>;

/// Runs again and again, with a change at one read and at a later one of `places`.
void change_at_each(const Change& change, std::size_t places, bool may_fail) {
  const TemporaryFolder folder;
  const std::string set = folder / "a.ms", name = folder / "a";
  std::size_t all = places;
  for (std::size_t place = 0; place <= places; place += stride) {
    copy_of(long_track(), set);
    std::size_t calls = 0;
    bool done = false;
    const Outcome outcome = run_with_faults(clean(set, name), reading_calls, [&](const SystemCall& call) {
      if (reads_values(call, set) && calls++ * places >= (place == 0 ? 1000000000 : all * (place - 1)) && !done) {
        change(set);
        done = true;
      }
      return Answer{};
    });
    if (place == 0) all = calls;
    BOOST_TEST_CONTEXT("read " << (place == 0 ? 0 : all * (place - 1) / places) << " of " << all << ": " << outcome.err) {
      if (outcome.code == 1 && may_fail) {
        BOOST_TEST(outcome.err.find(set) != std::string::npos);
        BOOST_TEST(std::count(outcome.err.begin(), outcome.err.end(), '\n') == 1);
        continue;
      }
      BOOST_TEST(outcome.code == 0);
      BOOST_TEST((warnings_of(name).find("changed during the run") != std::string::npos) == done, warnings_of(name));
      BOOST_TEST((!done || warnings_of(name).find(set) != std::string::npos));
    }
  }
}

/// The change that makes of the set what `spoil` makes of it.
Change becoming(const TemporaryFolder& folder, const Change& spoil) {
  const std::string other = copy_of(long_track(), folder / "other.ms");
  spoil(other);
  return [other](const std::string& set) { write_over(other, set); };
}

}  // namespace

BOOST_AUTO_TEST_CASE(coordinates_that_grow_during_a_run_are_told_of) {
  const TemporaryFolder folder;
  change_at_each(becoming(folder, [](const std::string& set) { scale_uvw(set, 7); }), 4, false);
}

BOOST_AUTO_TEST_CASE(data_that_change_during_a_run_are_told_of) {
  const TemporaryFolder folder;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  change_at_each(becoming(folder, [&](const std::string& set) { scale_data(set, nan); }), 4, true);
}

BOOST_AUTO_TEST_CASE(flags_that_are_set_during_a_run_are_told_of) {
  const TemporaryFolder folder;
  change_at_each(becoming(folder, flag_all), 4, true);
}

BOOST_AUTO_TEST_CASE(files_that_are_cut_during_a_run_are_named) {
  const Change cut = [](const std::string& set) {
    for (const auto& file : fs::directory_iterator(set))
      if (file.path().filename().string().rfind("table.f", 0) == 0) fs::resize_file(file.path(), file.file_size() / 2);
  };
  change_at_each(cut, 4, true);
}

BOOST_AUTO_TEST_CASE(planes_of_data_that_change_are_told_of) {
  const TemporaryFolder folder;
  const std::string set = folder / "a.ms", name = folder / "a";
  copy_of(long_track(), set);
  bool done = false;
  const Outcome outcome =
      run_with_faults(clean(set, name, "0.3") + Arguments{"--specmode", "cube", "--outframe", "TOPO", "--nchan", "3"},
                      reading_calls, [&](const SystemCall& call) {
                        if (!std::exchange(done, done || reads_values(call, set)) && done) flag_row(set, 5);
                        return Answer{};
                      });
  BOOST_TEST(outcome.code == 0, outcome.err);
  BOOST_TEST(warnings_of(name).find("changed during the run") != std::string::npos);
}

BOOST_AUTO_TEST_SUITE_END()
