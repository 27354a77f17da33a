// What a run leaves whose disk is full: of CASA images and columns, which casacore writes, and of cubes.
#include <sys/syscall.h>

#include <cstring>

#include "imager/files/fits_image_reader.h"
#include "ms_io/casa_image.h"
#include "tests/faults/faulty_run.h"
#include "tests/tools/set_changes.h"

BOOST_AUTO_TEST_SUITE(full_disks)

using namespace misfit::tools::testing;
using misfit::testing::changing_calls;

namespace {

namespace fs = std::filesystem;
namespace imager = misfit::imager;
namespace ms_io = misfit::ms_io;

bool takes_room(const SystemCall& call) {
  return call.number == SYS_write || call.number == SYS_writev || call.number == SYS_pwrite64 || call.number == SYS_mkdir ||
         call.number == SYS_ftruncate || (call.number == SYS_openat && call.changes_file());
}

/// Runs once for every so many of the calls that take room below `folder`: from that one on, the disk is full.
void fill_at_each(const Arguments& arguments, const std::string& folder, std::size_t runs, const std::function<void()>& restore,
                  const std::function<void(const Outcome&)>& look) {
  std::size_t all = 0;
  const auto full_from = [&](std::size_t first, std::string& failed) {
    restore();
    std::size_t calls = 0;
    const Outcome outcome = run_with_faults(arguments, changing_calls, [&](const SystemCall& call) {
      if (!takes_room(call) || call.path().rfind(folder, 0) != 0 || calls++ < first) return Answer{};
      if (failed.empty()) failed = call.path();
      return Answer{ENOSPC};
    });
    all = std::max(all, calls);
    return outcome;
  };
  std::string none;
  BOOST_TEST(full_from(1000000, none).code == 0);
  BOOST_TEST(all > 10U);
  const std::size_t each = std::max<std::size_t>(1, all / runs);
  for (std::size_t first = 0; first < all; first += each * stride) {
    std::string failed;
    const Outcome outcome = full_from(first, failed);
    BOOST_TEST_CONTEXT("call " << first << " of " << all << ", of " << failed << ": " << outcome.err) look(outcome);
  }
}

/// Or nothing that was written was needed. casacore does not keep what the system said of its lock files.
void expect_told(const Outcome& outcome) {
  BOOST_TEST((outcome.code == 1 || outcome.code == 0));
  BOOST_TEST(std::count(outcome.err.begin(), outcome.err.end(), '\n') == outcome.code);
  const bool why = outcome.err.find(std::strerror(ENOSPC)) != std::string::npos ||
                   outcome.err.find("lock file cannot be written") != std::string::npos;
  BOOST_TEST((why || outcome.code == 0));
}

}  // namespace

BOOST_AUTO_TEST_CASE(casa_images_are_whole_or_absent) {
  const TemporaryFolder folder;
  const Arguments image = small_image(snapshot(), folder / "a") + Arguments{"--outformat", "casa", "--threads", "1", "--quiet"};
  const auto restore = [&] {
    for (const auto& file : fs::directory_iterator(folder / "")) fs::remove_all(file.path());
  };
  fill_at_each(image, folder / "a.", 50, restore, [&](const Outcome& outcome) {
    expect_told(outcome);
    for (const char* kind : {"psf", "residual"})
      if (const std::string path = folder / "a." + kind; fs::exists(path))
        BOOST_TEST(ms_io::open_casa_image(path)->read({0, 0}).pixel.size() == 64U * 64);
  });
  BOOST_TEST(run(image).code == 0);
  for (const auto& file : files_below(folder / "")) BOOST_TEST(file.first.find(".part") == std::string::npos, file.first);
}

BOOST_AUTO_TEST_CASE(cubes_are_whole_or_absent) {
  const TemporaryFolder folder;
  const std::string set = folder / "cube.ms";
  succeed({"simulate", "--output", set, "--channels", "3"});
  const Arguments cube = small_image(set, folder / "out/a") +
                         Arguments{"--specmode", "cube", "--outframe", "TOPO", "--niter", "10", "--threads", "1", "--quiet"};
  const auto restore = [&] {
    fs::remove_all(folder / "out");
    fs::create_directory(folder / "out");
  };
  fill_at_each(cube, folder / "out/a.", 40, restore, [&](const Outcome& outcome) {
    BOOST_TEST(outcome.code == 1);
    expect_told(outcome);
    for (const auto& [path, bytes] : files_below(folder / "out"))
      if (path.find(".fits") != std::string::npos)
        BOOST_TEST(imager::open_fits_image(path)->read({2, 0}).pixel.size() == 64U * 64, path);
  });
}

BOOST_AUTO_TEST_CASE(a_set_keeps_what_it_had_and_the_next_run_finishes_its_column) {
  const TemporaryFolder folder;
  const std::string set = folder / "a.ms", other = folder / "b.ms";
  std::ofstream(folder / "sky.csv") << "l_arcsec,m_arcsec,flux_jy\n1,2,1\n";
  const auto predict = [&](const std::string& into) {
    return Arguments{"predict", "--vis", into, "--components", folder / "sky.csv", "--quiet"};
  };
  fs::copy(snapshot(), other, fs::copy_options::recursive);
  succeed(predict(other));
  const auto restore = [&] {
    fs::remove_all(set);
    fs::copy(snapshot(), set, fs::copy_options::recursive);
  };
  fill_at_each(predict(set), set, 100, restore, [&](const Outcome& outcome) {
    expect_told(outcome);
    BOOST_TEST((visibilities(set, "DATA") == visibilities(snapshot(), "DATA")));
    const Outcome next = run(predict(set));
    BOOST_TEST(next.code == 0, next.err);
    BOOST_TEST((visibilities(set, "MODEL_DATA") == visibilities(other, "MODEL_DATA")));
  });
}

BOOST_AUTO_TEST_SUITE_END()
