#include "tools/run/image_files.h"

#include <algorithm>
#include <cmath>

#include "imager/files/fits_image_reader.h"
#include "ms_io/casa_image.h"
#include "tests/example_cube.h"
#include "tests/tools/program.h"

BOOST_AUTO_TEST_SUITE(image_files)

namespace {

using namespace misfit;
using namespace misfit::tools::testing;
using misfit::testing::example_beam;
using misfit::testing::example_header;
using misfit::testing::example_plane;
using nlohmann::json;

constexpr double degree = M_PI / 180;

/// Whether the other readers are installed; says so where they are not.
bool readers_are_there() {
  if (std::system("/usr/bin/python3 -c 'import astropy.wcs, casacore.images' > /dev/null 2>&1") == 0) return true;
  BOOST_TEST_MESSAGE("skipped: /usr/bin/python3 has no astropy and casacore (python3-astropy, python3-casacore)");
  return false;
}

/// What they read of images of these names.
json read_by_others(const std::vector<std::string>& names) {
  Child child(Arguments{MISFIT_SOURCE_DIR "/tests/tools/read_images.py"} + names, "/usr/bin/python3");
  const Outcome outcome = child.wait();
  BOOST_TEST_INFO(outcome.err);
  BOOST_REQUIRE_EQUAL(outcome.code, 0);
  return json::parse(outcome.out);
}

/// Both formats, some planes with beams, one with a pixel without value.
void write_both(const std::string& name, const imager::ImageHeader& header) {
  const auto writer = tools::open_image_files(name, header, imager::PixelFormat::float32, "both");
  for (const imager::PlaneIndex& at : {imager::PlaneIndex{1, 0}, {2, 0}, {2, 1}}) {
    imager::Image image = example_plane(header, at);
    if (at.channel == 2) image.at(1, 2) = std::nan("");
    writer->write(at, image, example_beam(at));
  }
  writer->add_cards({{"ERRMEAS", 1.5e-7, "measured"}});
  writer->finish();
}

double apart_deg(const imager::SkyDirection& a, double ra_deg, double dec_deg) {
  const double dec_rad = dec_deg * degree, dec = dec_rad - a.dec_rad, ra = ra_deg * degree - a.ra_rad;
  const double half = std::pow(std::sin(dec / 2), 2) + std::cos(a.dec_rad) * std::cos(dec_rad) * std::pow(std::sin(ra / 2), 2);
  return 2 * std::asin(std::sqrt(half)) / degree;
}

void check_world(const json& file, const imager::ImageHeader& header) {
  for (std::size_t i = 0; i < file["at"].size(); ++i) {
    const auto at = file["at"][i].get<std::array<int, 4>>();  // channel, Stokes, row, column
    const auto world = file["world"][i].get<std::array<double, 4>>();
    const imager::SkyDirection expected = sky_direction(header.geometry.at(at[2], at[3]), header.geometry.phase_centre);
    BOOST_TEST(apart_deg(expected, world[0], world[1]) < 1e-9);
    BOOST_TEST(std::abs(world[2] / header.spectral.frequency_hz(at[0]) - 1) < 1e-9);
    BOOST_TEST(world[3] == static_cast<double>(header.stokes.at(static_cast<std::size_t>(at[1]))));
  }
}

std::vector<std::string> names_in(const std::string& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) names.push_back(entry.path().filename());
  std::sort(names.begin(), names.end());
  return names;
}

bool is_there(const std::string& path) {
  return std::filesystem::exists(path);
}

}  // namespace

BOOST_AUTO_TEST_CASE(astropy_and_casacore_find_pixels_and_planes_where_the_header_has_them,
                     *boost::unit_test::label("others")) {
  if (!readers_are_there()) return;
  const TemporaryFolder folder;
  const std::vector<imager::ImageGeometry> geometries{
      {8, 6, 1e-6, {3.2, -0.2, "FK5"}},
      {7, 5, 1e-6, {3.2, -0.2, "ICRS"}},
      {101, 100, 5e-3, {6.2, 0.7, "FK5"}},
      {6, 9, 1e-5, {0.001, 1.2, "FK5"}, {0.1, -0.07}},
      {64, 65, 1e-4, {1.5, 90 * degree - 1e-3, "FK5"}},
      {9, 8, 1e-4, {1.5, 90 * degree, "ICRS"}},
      {9, 8, 1e-4, {4, -90 * degree, "FK5"}},
  };
  std::vector<std::string> names;
  std::vector<imager::ImageHeader> headers;
  for (const imager::ImageGeometry& geometry : geometries) {
    headers.push_back(example_header(4, "IQ"));
    headers.back().geometry = geometry;
    names.push_back(folder / ("a" + std::to_string(names.size())));
    write_both(names.back(), headers.back());
  }
  const json read = read_by_others(names);
  for (std::size_t i = 0; i < names.size(); ++i) {
    check_world(read[i]["fits"], headers[i]);
    check_world(read[i]["casa"], headers[i]);
    BOOST_TEST(read[i]["fits"]["at"].size() == 32);
    BOOST_TEST(read[i]["fits"]["pixels"] == read[i]["casa"]["pixels"]);
  }
}

BOOST_AUTO_TEST_CASE(astropy_and_casacore_read_the_same_headers_beams_masks_and_history, *boost::unit_test::label("others")) {
  if (!readers_are_there()) return;
  const TemporaryFolder folder;
  const imager::ImageHeader header = example_header(4, "IQ");
  write_both(folder / "a", header);
  const json read = read_by_others({folder / "a"})[0];
  for (const char* key : {"fits", "casa"}) {
    const json& file = read[key];
    BOOST_TEST(file["unit"] == "Jy/beam");
    BOOST_TEST(file["telescope"] == "EVLA");
    BOOST_TEST(file["observer"] == "me");
    BOOST_TEST(file["object"] == "M87");
    BOOST_TEST(file["mjd"] == 61071.5);
    BOOST_TEST(file["rest_hz"] == header.spectral.rest_frequency_hz);
    BOOST_TEST(file["spectral_frame"] == "LSRK");
    BOOST_TEST(file["asked"] == 2.5e-7);
    BOOST_TEST(file["measured"] == 1.5e-7);
    BOOST_TEST(file["history"] == header.history[0] + header.history[1]);
    BOOST_TEST(std::count(file["pixels"].begin(), file["pixels"].end(), json()) == 5 * 28 + 2);
    BOOST_TEST_REQUIRE(file["beams"].size() == 8);
    for (int plane = 0; plane < 8; ++plane) {
      const imager::PlaneIndex at{plane % 4, plane / 4};
      const bool written = (at.channel == 1 && at.stokes == 0) || at.channel == 2;
      const double expected = written ? example_beam(at).major_rad / degree * 3600 : 1e-6;
      BOOST_TEST(std::abs(file["beams"][static_cast<std::size_t>(plane)][0].get<double>() / expected - 1) < 1.2e-7);
    }
  }
  BOOST_TEST(read["fits"]["frame"] == "FK5");
  BOOST_TEST(read["casa"]["frame"] == "J2000");
}

BOOST_AUTO_TEST_CASE(a_writer_of_both_formats_that_is_not_finished_leaves_neither) {
  const TemporaryFolder folder;
  {
    const auto writer = tools::open_image_files(folder / "a", example_header(2), imager::PixelFormat::float32, "both");
    writer->write({0, 0}, example_plane(example_header(2), {0, 0}), std::nullopt);
  }
  BOOST_TEST(names_in(folder / "").empty());
}

BOOST_AUTO_TEST_CASE(runs_write_the_formats_asked_for_with_the_same_pixels_and_remove_the_others) {
  const TemporaryFolder folder;
  const Arguments clean = small_image(snapshot(), folder / "a") + Arguments{"--niter", "20", "--outformat"};
  succeed(clean + Arguments{"both"});
  for (const char* kind : {"psf", "residual", "model", "image"}) {
    const std::string name = folder / (std::string("a.") + kind);
    const auto fits = imager::open_fits_image(name + ".fits"), casa = ms_io::open_casa_image(name);
    BOOST_TEST((fits->read({0, 0}).pixel == casa->read({0, 0}).pixel));
    BOOST_TEST(fits->header().unit == casa->header().unit);
    const bool seen_with_beam = std::string(kind) != "model";
    BOOST_TEST(fits->beam({0, 0}).has_value() == seen_with_beam);
    BOOST_TEST(casa->beam({0, 0}).has_value() == seen_with_beam);
  }
  for (const char* format : {"fits", "casa", "fits"}) {
    const Outcome outcome = run(clean + Arguments{format});
    BOOST_REQUIRE_EQUAL(outcome.code, 0);
    BOOST_TEST(outcome.err.find("removed what an earlier run left: ") != std::string::npos);
    BOOST_TEST(is_there(folder / "a.image.fits") == (std::string(format) == "fits"));
    BOOST_TEST(is_there(folder / "a.image") == (std::string(format) == "casa"));
  }
}

BOOST_AUTO_TEST_CASE(images_of_others_stay_where_no_image_takes_their_place) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "a.mask");
  std::ofstream(folder / "a.mask/precious") << "yes";
  std::ofstream(folder / "a.clean") << "no folder of states";
  succeed(small_image(snapshot(), folder / "a"));
  BOOST_TEST(content(folder / "a.mask/precious") == "yes");
  BOOST_TEST(content(folder / "a.clean") == "no folder of states");
  const Outcome outcome = run(small_image(snapshot(), folder / "a") + Arguments{"--outformat", "casa"});
  BOOST_TEST(outcome.code == 1);
  BOOST_TEST(outcome.err.find("a.mask: it is there already and no casacore image") != std::string::npos);
  BOOST_TEST(content(folder / "a.mask/precious") == "yes");
  BOOST_TEST(is_there(folder / "a.residual.fits"));
}

BOOST_AUTO_TEST_CASE(a_folder_where_a_report_is_to_be_is_told_of_before_a_visibility_is_read) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "a.report.json");
  const Outcome outcome = run(small_image(snapshot(), folder / "a") + Arguments{"--niter", "20"});
  BOOST_TEST(outcome.code == 1);
  BOOST_TEST(outcome.err.find("a.report.json: it is a folder; expected another --imagename") != std::string::npos, outcome.err);
  BOOST_TEST(!is_there(folder / "a.psf.fits"));
}

BOOST_AUTO_TEST_CASE(masks_and_models_may_be_casa_images_and_stay_as_they_are) {
  const TemporaryFolder folder;
  const Arguments clean = small_image(snapshot(), folder / "a") + Arguments{"--niter", "20"}, both{"--outformat", "both"};
  succeed(clean + both + Arguments{"--usemask", "auto"});
  std::filesystem::copy(folder / "a.mask", folder / "own.mask", std::filesystem::copy_options::recursive);
  std::filesystem::copy(folder / "a.mask.fits", folder / "own.fits");
  std::filesystem::copy(folder / "a.model", folder / "own.model", std::filesystem::copy_options::recursive);
  std::filesystem::copy(folder / "a.model.fits", folder / "model.fits");
  const auto result = [&](const std::string& mask, const std::string& model) {
    succeed(clean + both + Arguments{"--mask", folder / mask, "--startmodel", folder / model});
    return pixels_of(folder / "a", "image").pixel;
  };
  BOOST_TEST((result("own.mask", "own.model") == result("own.fits", "model.fits")));
  succeed(clean + both + Arguments{"--mask", folder / "a.mask"});
  BOOST_TEST(is_there(folder / "a.mask.fits"));
  succeed(clean + Arguments{"--mask", folder / "a.mask"});
  BOOST_TEST(is_there(folder / "a.mask"));
  BOOST_TEST(!is_there(folder / "a.image"));
}

BOOST_AUTO_TEST_SUITE_END()
