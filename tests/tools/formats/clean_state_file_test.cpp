#include "tools/formats/clean_state_file.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <stdexcept>

#include "tests/temporary_folder.h"
#include "tools/base/files.h"

BOOST_AUTO_TEST_SUITE(clean_state_file)

using namespace misfit;
using namespace misfit::tools;

namespace {

imager::CleanState some_state() {
  imager::ComponentModel model(7, 5, {0, 3.7});
  model.add({{0, 1, 2, 0.1}, {1, 4, 6, -1.0 / 3}, {0, 0, 0, 1e-300}});
  imager::CleanState state = imager::first_state(model);
  state.model.add({{0, 3, 3, 2}});
  state.mask = {imager::Image(7, 5), imager::Image(7, 5), true};
  for (const std::size_t i : {0U, 1U, 8U, 33U, 34U}) state.mask.allowed.pixel[i] = 1;
  state.mask.negative.pixel[8] = 1;
  state.cycles = {{0, 3, 0.3, 0, 0, "", 9, 0},
                  {10, 1.0 / 3, 0.1, 5, 0.5, "reached its depth", 1, 1e-3, 0, 0.4, 33, {0.2, true, 5, 3, 4, 2, 1, 9}}};
  state.cycles[0].rms_jy = std::numeric_limits<double>::quiet_NaN();
  state.now = 1;
  state.best = 1;
  state.tightened = 2;
  state.exact_from = 2;
  state.found_nothing = true;
  return state;
}

CleanStateOwner owner() {
  return {"1.0", {{"gain", "0.1"}, {"mask", ""}}, 42, 1, {7, 5, {0, 3.7}}};
}

bool same(const imager::ComponentModel& a, const imager::ComponentModel& b) {
  return a.scale_pixels() == b.scale_pixels() && a.image(1).pixel == b.image(1).pixel &&
         a.components().size() == b.components().size();
}

std::string refusal(const std::function<void()>& act) {
  try {
    act();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

}  // namespace

BOOST_AUTO_TEST_CASE(spectra_come_back_bit_for_bit) {
  const misfit::testing::TemporaryFolder folder;
  imager::CleanState was = some_state();
  was.model.add({{0, 1, 1, 0, {-0.7, 1.0 / 3}}, {1, 2, 3, 2, {0.1, 0}}});
  write_clean_state(folder / "a.state", was, owner());
  const imager::CleanState is = read_clean_state(folder / "a.state", owner()).state;
  for (const int term : {0, 1, 2}) BOOST_TEST((is.model.image(1, term).pixel == was.model.image(1, term).pixel));
  BOOST_TEST(same(is.best_model, was.best_model));
}

BOOST_AUTO_TEST_CASE(a_state_comes_back_bit_for_bit) {
  const misfit::testing::TemporaryFolder folder;
  const imager::CleanState was = some_state();
  write_clean_state(folder / "a.state", was, owner());
  const imager::CleanState is = read_clean_state(folder / "a.state", owner()).state;
  BOOST_TEST(same(is.model, was.model));
  BOOST_TEST(same(is.best_model, was.best_model));
  BOOST_TEST((is.mask.allowed.width == 7 && is.mask.allowed.pixel == was.mask.allowed.pixel));
  BOOST_TEST((is.mask.negative.pixel == was.mask.negative.pixel && is.mask.final));
  const imager::MaskExtension& masked = is.cycles[1].masked;
  BOOST_TEST((masked.threshold_jy == 0.2 && masked.by_sidelobes && masked.regions == 5 && masked.pruned == 3));
  BOOST_TEST((masked.grown_regions == 4 && masked.grown_pruned == 2 && masked.negative == 1 && masked.added == 9));
  BOOST_REQUIRE(is.cycles.size() == 2U);
  BOOST_TEST(std::isnan(is.cycles[0].rms_jy));
  BOOST_TEST(is.cycles[1].peak_residual_jy == was.cycles[1].peak_residual_jy);
  BOOST_TEST(is.cycles[1].ended == was.cycles[1].ended);
  BOOST_TEST(is.cycles[1].mean_square_jy2 == was.cycles[1].mean_square_jy2);
  BOOST_TEST(is.cycles[1].accuracy == was.cycles[1].accuracy);
  BOOST_TEST((is.cycles[1].peak_anywhere_jy == 0.4 && is.cycles[1].mask_pixels == 33));
  BOOST_TEST((is.now == 1 && is.best == 1 && is.tightened == 2 && is.found_nothing));
}

BOOST_AUTO_TEST_CASE(a_state_of_other_options_is_refused_by_the_name_of_the_option) {
  const misfit::testing::TemporaryFolder folder;
  write_clean_state(folder / "a.state", some_state(), owner());
  CleanStateOwner other = owner();
  other.options["gain"] = "0.2";
  const std::string message = refusal([&] { read_clean_state(folder / "a.state", other); });
  BOOST_TEST(message.ends_with("a.state was saved with --gain '0.1', but this run has '0.2'; expected --gain '0.1', or no "
                               "--restart to begin anew"),
             message);
  other = owner();
  other.options["mask"] = "m.fits";
  BOOST_TEST(refusal([&] { read_clean_state(folder / "a.state", other); }).find("--mask") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(a_state_of_other_data_or_another_version_is_refused) {
  const misfit::testing::TemporaryFolder folder;
  write_clean_state(folder / "a.state", some_state(), owner());
  CleanStateOwner other = owner();
  other.checksum = 43;
  BOOST_TEST(refusal([&] { read_clean_state(folder / "a.state", other); }).find("other data") != std::string::npos);
  other = owner();
  other.version = "1.1";
  BOOST_TEST(refusal([&] { read_clean_state(folder / "a.state", other); }).find("version") != std::string::npos);
  other = owner();
  other.ranks = 3;
  const std::string message = refusal([&] { read_clean_state(folder / "a.state", other); });
  BOOST_TEST(message.find("was saved with mpirun -n 1, but this run has 3; expected mpirun -n 1,") != std::string::npos,
             message);
}

BOOST_AUTO_TEST_CASE(what_is_cut_or_no_state_is_refused_by_name) {
  const misfit::testing::TemporaryFolder folder;
  write_clean_state(folder / "a.state", some_state(), owner());
  const std::string whole = read_file(folder / "a.state");
  for (std::size_t length = 0; length < whole.size(); length += 7) {
    write_file(folder / "b.state", whole.substr(0, length));
    const std::string message = refusal([&] { read_clean_state(folder / "b.state", owner()); });
    BOOST_REQUIRE(message.find("b.state") != std::string::npos);
    BOOST_REQUIRE(message.find("damaged") != std::string::npos);
  }
}

BOOST_AUTO_TEST_CASE(no_byte_of_a_state_can_change_unnoticed) {
  const misfit::testing::TemporaryFolder folder;
  write_clean_state(folder / "a.state", some_state(), owner());
  const std::string whole = read_file(folder / "a.state");
  for (std::size_t i = 0; i < whole.size(); i += 3) {
    std::string other = whole;
    other[i] = static_cast<char>(other[i] ^ 0x55);
    write_file(folder / "b.state", other);
    BOOST_REQUIRE(refusal([&] { read_clean_state(folder / "b.state", owner()); }).find("b.state is damaged") !=
                  std::string::npos);
  }
}

BOOST_AUTO_TEST_CASE(numbers_may_be_written_differently) {
  const misfit::testing::TemporaryFolder folder;
  write_clean_state(folder / "a.state", some_state(), owner());
  CleanStateOwner other = owner();
  other.options["gain"] = "1e-1";
  BOOST_TEST(refusal([&] { read_clean_state(folder / "a.state", other); }) == "");
}

BOOST_AUTO_TEST_CASE(with_other_ways_there_is_the_model_to_go_on_from) {
  const misfit::testing::TemporaryFolder folder;
  CleanStateOwner was = owner();
  was.ways = {{"cyclefactor", "1"}, {"scales", "0 5"}};
  was.ways_checksum = 5;
  const imager::CleanState state = some_state();
  write_clean_state(folder / "a.state", state, was);
  BOOST_TEST(read_clean_state(folder / "a.state", was).changed.empty());
  CleanStateOwner other = was;
  other.ways["cyclefactor"] = "2";
  other.like = {7, 5, {0, 2.5, 3.7}};  // among them the same scales
  const ReadCleanState read = read_clean_state(folder / "a.state", other);
  BOOST_TEST(read.changed == std::vector<std::string>{"cyclefactor"}, boost::test_tools::per_element());
  BOOST_TEST(read.state.cycles.empty());
  BOOST_TEST(read.state.iterations == 10);
  BOOST_TEST((read.state.model.image(1).pixel == state.model.image(1).pixel));
  BOOST_TEST((read.state.best_model.image(1).pixel == state.model.image(1).pixel));
  other = was;
  other.ways_checksum = 6;  // of a mask whose file is another
  BOOST_TEST(read_clean_state(folder / "a.state", other).changed == std::vector<std::string>{"mask"},
             boost::test_tools::per_element());
  other.like = {7, 5, {0}};
  BOOST_TEST(refusal([&] { read_clean_state(folder / "a.state", other); }).find("has components of scale") !=
             std::string::npos);
}

BOOST_AUTO_TEST_CASE(the_checksum_notices_every_pixel) {
  imager::Image dirty(4, 3), psf(4, 3);
  const imager::Image mask(4, 3);
  const std::uint64_t before = checksum({&dirty, &psf, nullptr});
  BOOST_TEST(checksum({&dirty, &psf}) == before);
  BOOST_TEST(checksum({&dirty, &psf, &mask}) != before);
  for (imager::Image* image : {&dirty, &psf})
    for (double& pixel : image->pixel) {
      pixel = 1e-300;
      BOOST_TEST(checksum({&dirty, &psf}) != before);
      pixel = 0;
    }
}

BOOST_AUTO_TEST_SUITE_END()
