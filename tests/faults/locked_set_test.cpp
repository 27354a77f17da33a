// Runs whose MeasurementSet another process has locked.
#include "tests/faults/replaced_products.h"
#include "tests/tools/set_changes.h"

BOOST_AUTO_TEST_SUITE(locked_set)

using namespace misfit::tools::testing;

namespace {

/// A set, with a model for it.
struct Scene {
  Scene() {
    std::filesystem::copy(snapshot(), set, std::filesystem::copy_options::recursive);
    std::ofstream(folder / "sky.csv") << "l_arcsec,m_arcsec,flux_jy\n1,2,1\n";
  }
  Arguments predict() const { return {"predict", "--vis", set, "--components", folder / "sky.csv", "--quiet"}; }
  std::map<std::string, std::string> files() const {
    std::map<std::string, std::string> files = files_below(set);
    for (auto file = files.begin(); file != files.end();)
      file = ends_with(file->first, "table.lock") ? files.erase(file) : std::next(file);
    return files;
  }

  TemporaryFolder folder;
  std::string set = folder / "a.ms";
};

}  // namespace

BOOST_AUTO_TEST_CASE(a_locked_set_is_imaged) {
  const Scene scene;
  succeed(small_image(scene.set, scene.folder / "free"));
  const LockedSet lock(scene.set);
  succeed(small_image(scene.set, scene.folder / "locked"));
  BOOST_TEST(pixels_of(scene.folder / "locked", "residual").pixel == pixels_of(scene.folder / "free", "residual").pixel);
}

BOOST_AUTO_TEST_CASE(a_locked_set_gets_no_column_and_is_named) {
  const Scene scene;
  const auto before = scene.files();
  const Arguments saving =
      small_image(scene.set, scene.folder / "a") + Arguments{"--niter", "10", "--savemodel", "modelcolumn", "--quiet"};
  {
    const LockedSet lock(scene.set);
    for (const Arguments& writing : {scene.predict(), saving}) {
      const Outcome outcome = run(writing);
      BOOST_TEST(outcome.code == 1);
      BOOST_TEST(outcome.err.rfind("misfit: " + scene.set + " is locked by another process", 0) == 0U, outcome.err);
      BOOST_TEST(std::count(outcome.err.begin(), outcome.err.end(), '\n') == 1);
    }
    BOOST_TEST(!std::filesystem::exists(scene.folder / "a.residual.fits"));
  }
  BOOST_TEST((scene.files() == before));
  succeed(scene.predict());
}

BOOST_AUTO_TEST_SUITE_END()
