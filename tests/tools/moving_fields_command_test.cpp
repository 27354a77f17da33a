// Sets whose phase centre moves, as images and predictions.
#include "imager/files/fits_image_reader.h"
#include "tests/moving_fields.h"
#include "tests/tools/program.h"
#include "tests/tools/ranks_program.h"
#include "tests/tools/set_changes.h"

BOOST_AUTO_TEST_SUITE(moving_fields_command)

namespace {

using namespace misfit;
using namespace misfit::testing;
using namespace misfit::tools::testing;

constexpr double degree = M_PI / 180, day_s = 86400;
constexpr SkyPoint place{10 * degree, 35 * degree};
const std::string at_place = "0h40m00s +35d00m00s";

/// An hour of the VLA's smallest array, whose field passes a source of 1 Jy that stands still.
struct MovingSet {
  TemporaryFolder folder;
  std::string set = folder / "moving.ms";

  explicit MovingSet(Path way) : way_(way) {
    simulate(set);
    put_fixed_source(set, {MovingField(set, 0, way, place)}, place, 1);
    std::ofstream(folder / "fixed.csv") << "ra_deg,dec_deg,flux_jy\n10,35,1\n";
  }
  Arguments image(const std::vector<std::string>& sets = {}) const {
    return Arguments{"image", "--vis"} + (sets.empty() ? Arguments{set} : sets) +
           Arguments{"--imagename", folder / "a", "--imsize", "128", "--cell", "15arcsec", "--datacolumn", "data", "--quiet"};
  }
  Arguments fixed(const std::vector<std::string>& sets = {}) const {
    return image(sets) + Arguments{"--phasecenter", (way_ == Path::ephemeris ? "ICRS " : "J2000 ") + at_place};
  }
  Arguments predict(const Arguments& model) const { return Arguments{"predict", "--vis", set, "--quiet"} + model; }
  std::string simulate_another(const std::string& name) const {
    simulate(folder / name);
    return folder / name;
  }

 private:
  static void simulate(const std::string& set) {
    std::ofstream(set + ".csv") << "l_arcsec,m_arcsec,flux_jy\n0,0,1\n";
    succeed({"simulate", "--output",   set,     "--sky",           set + ".csv", "--array",    "vla-d", "--ra",
             "10deg",    "--dec",      "35deg", "--hours",         "1",          "--interval", "600",   "--frequency",
             "1.4GHz",   "--channels", "3",     "--channel-width", "2MHz",       "--quiet"});
  }

  Path way_;
};

/// Whether the source is a point in the middle: of 1 Jy, to the accuracy of 1e-6 and roundings of single precision.
void check_point(const imager::Image& image) {
  const std::ptrdiff_t peak = std::max_element(image.pixel.begin(), image.pixel.end()) - image.pixel.begin();
  BOOST_TEST(peak == 64 * 128 + 64);
  BOOST_TEST(std::abs(image.at(64, 64) - 1) < 3e-6);
}

/// RMS of what is left of 1 Jy.
double rms(const std::string& set, const std::string& column) {
  double square = 0;
  const auto values = visibilities(set, column);
  for (const auto& value : values) square += std::norm(value);
  return std::sqrt(square / static_cast<double>(values.size()));
}

void check_model(const std::string& set) {
  const auto data = visibilities(set, "DATA"), model = visibilities(set, "MODEL_DATA");
  BOOST_REQUIRE(data.size() == model.size());
  // The component is the dirty image's peak, right to 3e-6, and predicted to 1e-6.
  for (std::size_t i = 0; i < data.size(); ++i) BOOST_TEST(std::abs(model[i] - data[i]) < 5e-6F);
}

bool warns(const std::string& imagename, const std::string& part) {
  return report_of(imagename)["warnings"].dump().find(part) != std::string::npos;
}

Outcome refused(const Arguments& arguments) {
  const Outcome outcome = run(arguments);
  BOOST_TEST(outcome.code == 1);
  BOOST_TEST(std::count(outcome.err.begin(), outcome.err.end(), '\n') == 1, outcome.err);
  return outcome;
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_source_that_stands_still_is_a_point_and_can_be_subtracted) {
  for (const Path way : all_paths) {
    BOOST_TEST_INFO(name_of(way));
    const MovingSet moving(way);
    succeed(moving.fixed());
    check_point(pixels_of(moving.folder / "a", "residual"));
    BOOST_TEST(imager::read_fits(moving.folder / "a.residual.fits").observation.moving_at == "");
    succeed(moving.predict({"--components", moving.folder / "fixed.csv", "--subtract"}));
    BOOST_TEST(rms(moving.set, "CORRECTED_DATA") < 1e-6);
  }
}

BOOST_AUTO_TEST_CASE(models_of_the_still_sky_come_back_into_the_moving_field) {
  for (const Path way : {Path::ephemeris, Path::azimuth}) {
    const MovingSet moving(way);
    const Arguments cleaned = moving.fixed() + Arguments{"--niter", "1", "--gain", "1", "--outformat", "both"};
    succeed(cleaned + Arguments{"--savemodel", "modelcolumn"});
    check_model(moving.set);
    for (const std::string model : {"a.model.fits", "a.model"}) {
      succeed(moving.predict({"--model", moving.folder / model, "--column", "MODEL_DATA"}));
      check_model(moving.set);
    }
    const Outcome said = run({"predict", "--vis", moving.set, "--components", moving.folder / "a.components.csv"});
    BOOST_TEST(said.code == 0);
    BOOST_TEST(said.err.find("the model stands still on the sky") != std::string::npos, said.err);
    check_model(moving.set);
  }
}

BOOST_AUTO_TEST_CASE(cubes_and_ranks_see_a_moving_field_as_one_image_does) {
  const MovingSet moving(Path::acceleration);
  const Arguments cube = moving.fixed() + Arguments{"--specmode", "cube", "--outframe", "LSRK", "--interpolation", "nearest"};
  succeed(cube + Arguments{"--memory", "0.1"});
  const auto check_cube = [&] {
    const auto reader = imager::open_fits_image(moving.folder / "a.residual.fits");
    for (int channel = 0; channel < reader->header().spectral.channels; ++channel) check_point(reader->read({channel, 0}));
    BOOST_TEST(reader->header().spectral.channels >= 3);
  };
  check_cube();
  if (!has_mpi()) return;
  for (const int size : {2, 3}) {
    succeed_together(size, cube);
    check_cube();
    succeed_together(size, moving.fixed());
    check_point(pixels_of(moving.folder / "a", "residual"));
    succeed_together(size, moving.predict({"--components", moving.folder / "fixed.csv", "--subtract", "--datacolumn", "data",
                                           "--column", "LEFT"}));
    BOOST_TEST(rms(moving.set, "LEFT") < 1e-6);
  }
}

BOOST_AUTO_TEST_CASE(several_days_are_one_image_of_what_stands_still) {
  const MovingSet moving(Path::ephemeris);
  const std::string later = moving.simulate_another("later.ms");
  move_times(later, 2 * day_s);
  put_fixed_source(later, {MovingField(later, 0, Path::ephemeris, {10.02 * degree, 34.99 * degree})}, place, 1);
  succeed(moving.fixed({moving.set, later}) + Arguments{"--niter", "1", "--gain", "1", "--savemodel", "modelcolumn"});
  check_point(imager::read_fits(moving.folder / "a.image.fits").image);
  for (const std::string& set : {moving.set, later}) check_model(set);
}

// The data are those of a source that moves along in the middle of the field, 1 Jy.
BOOST_AUTO_TEST_CASE(a_target_is_imaged_about_itself_and_everything_says_so) {
  const MovingSet moving(Path::ephemeris);
  const std::string later = moving.simulate_another("later.ms");
  const std::string first = moving.simulate_another("first.ms");
  move_times(later, 2 * day_s);
  MovingField(later, 0, Path::ephemeris, {14 * degree, 36 * degree});
  MovingField(first, 0, Path::ephemeris, place);
  for (const Arguments& sets : {Arguments{first}, Arguments{first, later}})
    for (const Arguments& centre : {Arguments{}, Arguments{"--phasecenter", "TRACKFIELD"}}) {
      succeed(moving.image(sets) + centre +
              Arguments{"--niter", "1", "--gain", "1", "--savemodel", "modelcolumn", "--outformat", "both"});
      check_point(imager::read_fits(moving.folder / "a.image.fits").image);
      for (const std::string& set : sets) check_model(set);
      BOOST_TEST(warns(moving.folder / "a", "images and models move along"));
      BOOST_TEST(content(moving.folder / "a.components.csv").find("l_arcsec,m_arcsec,flux_jy") == 0U);
    }
  succeed(moving.image({first}) + Arguments{"--niter", "1", "--gain", "1", "--outformat", "both"});
  const imager::SkyImage sky = imager::read_fits(moving.folder / "a.image.fits");
  BOOST_TEST(std::abs(sky.geometry.phase_centre.ra_rad - place.ra_rad) < 1e-10);
  BOOST_TEST(std::abs(sky.geometry.phase_centre.dec_rad - place.dec_rad) < 1e-10);
  BOOST_TEST(sky.geometry.phase_centre.frame == "ICRS");
  BOOST_TEST(sky.observation.moving_at.find("T") != std::string::npos);
  for (const Arguments& model : {Arguments{"--model", moving.folder / "a.model.fits"},
                                 {"--model", moving.folder / "a.model"},
                                 {"--components", moving.folder / "a.components.csv"}}) {
    const Arguments predict{"predict", "--vis", first, "--quiet", "--subtract", "--datacolumn", "data", "--column", "LEFT"};
    succeed(predict + model);
    BOOST_TEST(rms(first, "LEFT") < 5e-6);
  }
}

BOOST_AUTO_TEST_CASE(what_moves_and_what_stands_still_are_not_taken_for_each_other) {
  const MovingSet moving(Path::rate);
  succeed(moving.image() + Arguments{"--niter", "1"});
  const std::string still = moving.simulate_another("still.ms"), model = moving.folder / "a.model.fits";
  const std::string along = refused({"predict", "--vis", still, "--model", model}).err;
  BOOST_TEST(along.find(model + " moves along with its target (TRACKFLD is ") != std::string::npos, along);
  const std::string copy = moving.folder / "start.fits";
  std::filesystem::copy(model, copy);
  const std::string start = refused(moving.fixed() + Arguments{"--niter", "1", "--startmodel", copy}).err;
  BOOST_TEST(start.find("), expected one that stands still, as this image does") != std::string::npos, start);
  succeed(moving.fixed() + Arguments{"--niter", "1"});
  std::filesystem::copy(moving.folder / "a.model.fits", moving.folder / "still.fits");
  succeed(moving.image() + Arguments{"--niter", "2", "--startmodel", copy});
  BOOST_TEST(!warns(moving.folder / "a", "does not say that it moves along"));
  // The centres have to be one; the field passes the image's in the middle of its rows.
  succeed(moving.image() + Arguments{"--niter", "2", "--startmodel", moving.folder / "still.fits"});
  BOOST_TEST(warns(moving.folder / "a", "still.fits does not say that it moves along with its field (TRACKFLD)"));
  const std::string none =
      refused({"predict", "--vis", still, "--components", moving.folder / "fixed.csv", "--phasecenter", "TRACKFIELD"}).err;
  BOOST_TEST(none.find("no selected field of " + still + " moves") != std::string::npos, none);
}

BOOST_AUTO_TEST_CASE(masks_and_start_models_of_another_part_of_the_way_move_along) {
  const MovingSet moving(Path::rate);
  const auto [first_s, last_s] = time_range_s(moving.set);
  const auto minute = static_cast<int>(std::fmod(0.5 * (first_s + last_s), day_s) / 60);
  char middle[32];
  std::snprintf(middle, sizeof middle, "%02d:%02d:00", minute / 60, minute % 60);
  const Arguments points = moving.image() + Arguments{"--niter", "1", "--gain", "1"};
  succeed(points + Arguments{"--timerange", "<" + std::string(middle)});
  imager::SkyImage model = imager::read_fits(moving.folder / "a.model.fits");
  for (double& pixel : model.image.pixel) pixel = 0;
  model.image.at(70, 50) = 1;
  const std::string copy = moving.folder / "m.fits";
  imager::write_fits(model, copy, imager::PixelFormat::float32);
  const Arguments later{"--timerange", ">" + std::string(middle)};
  for (const char* option : {"--mask", "--startmodel"}) {
    succeed(points + later + Arguments{option, copy});
    BOOST_TEST(pixels_of(moving.folder / "a", "model").at(70, 50) != 0, option);
    BOOST_TEST(!warns(moving.folder / "a", copy));
  }
  const std::string mask = refused(moving.fixed() + Arguments{"--niter", "1", "--mask", copy}).err;
  BOOST_TEST(mask.find("mask " + copy + " moves along with its field") != std::string::npos, mask);
}

BOOST_AUTO_TEST_CASE(an_image_of_another_target_is_not_predicted) {
  const MovingSet moving(Path::ephemeris);
  succeed(moving.image() + Arguments{"--niter", "1"});
  const std::string other = moving.simulate_another("other.ms"), model = moving.folder / "a.model.fits";
  for (const double away_deg : {0.0, 0.01}) {
    MovingField(other, 0, Path::ephemeris, {place.ra_rad, place.dec_rad + away_deg * degree});
    const Arguments predict{"predict", "--vis", other, "--model", model, "--quiet"};
    if (away_deg == 0) {
      succeed(predict);
    } else {
      const std::string error = refused(predict).err;
      BOOST_TEST(error.find(model + " moves along with another target: at its TRACKFLD, ") != std::string::npos, error);
      BOOST_TEST(error.find("it was 36 arcsec away") != std::string::npos, error);
    }
  }
}

BOOST_AUTO_TEST_CASE(start_models_and_masks_of_another_target_are_refused) {
  const MovingSet moving(Path::ephemeris);
  succeed(moving.image() + Arguments{"--niter", "1"});
  const std::string model = moving.folder / "start.fits";
  std::filesystem::copy(moving.folder / "a.model.fits", model);
  const Arguments jupiter = moving.image() + Arguments{"--phasecenter", "JUPITER", "--niter", "1"};
  for (const std::string option : {"--startmodel", "--mask"}) {
    succeed(moving.image() + Arguments{"--niter", "1", option, model});
    const std::string error = refused(jupiter + Arguments{option, model}).err;
    BOOST_TEST(error.find(model + " moves along with another target: at its TRACKFLD, ") != std::string::npos, error);
  }
}

BOOST_AUTO_TEST_CASE(the_components_of_a_run_are_its_model_in_whatever_frame_it_was) {
  const MovingSet still(Path::rate);
  const std::string set = still.simulate_another("still.ms");
  for (const std::string centre : {"B1950 0h37m16s +34d43m33s", "ICRS 0h40m01s +35d00m10s", "J2000 0h40m01s +35d00m10s"}) {
    succeed(still.image({set}) +
            Arguments{"--phasecenter", centre, "--niter", "20", "--savemodel", "modelcolumn", "--accuracy", "1e-6"});
    const std::string list = still.folder / "a.components.csv";
    succeed({"predict", "--vis", set, "--components", list, "--column", "LISTED", "--quiet"});
    const auto model = visibilities(set, "MODEL_DATA"), listed = visibilities(set, "LISTED");
    float largest = 0;
    for (std::size_t i = 0; i < model.size(); ++i) largest = std::max(largest, std::abs(model[i] - listed[i]));
    // The accuracy, and roundings to single precision. In B1950 aberration bends, by 0.34 arcsec a radian, what lies about a
    // direction: here by 5e-5 arcsec between the image's centre and the set's, of beams of 46 arcsec.
    BOOST_TEST(largest < (centre[0] == 'B' ? 2e-5F : 5e-6F), centre << " " << largest);
  }
}

BOOST_AUTO_TEST_CASE(fields_of_which_one_moves_see_directions_on_the_sky_and_share_an_image_about_one) {
  const MovingSet moving(Path::rate);
  const MovingField field(moving.set, 0, Path::rate, place);
  add_still_field(moving.set, {10.01 * degree, 35.02 * degree});
  put_fixed_source(moving.set, {field}, place, 1);
  std::ofstream(moving.folder / "offsets.csv") << "l_arcsec,m_arcsec,flux_jy\n0,0,1\n";
  const std::string mixed = refused(moving.predict({"--components", moving.folder / "offsets.csv"})).err;
  BOOST_TEST(mixed.find("one moves, by") != std::string::npos, mixed);
  const Arguments predict = moving.predict({"--components", moving.folder / "fixed.csv", "--subtract", "--datacolumn", "data"});
  for (const Arguments& about : {Arguments{}, Arguments{"--phasecenter", "J2000 " + at_place}}) {
    succeed(predict + Arguments{"--column", "LEFT"} + about);
    BOOST_TEST(rms(moving.set, "LEFT") < 1e-6);
  }
  succeed(moving.fixed());
  check_point(pixels_of(moving.folder / "a", "residual"));
}

BOOST_AUTO_TEST_SUITE_END()
