// Cubes by the program itself, of simulated lines.
#include <cmath>

#include "imager/beams/beam.h"
#include "imager/files/fits_image_reader.h"
#include "ms_io/measurement_set.h"
#include "ms_io/simulated_set.h"
#include "tests/tools/program.h"
#include "tools/formats/image_file.h"

BOOST_AUTO_TEST_SUITE(cube_command)

namespace {

using namespace misfit;
using namespace misfit::tools::testing;

constexpr std::size_t antennas = 5, baselines = 10, channels = 32;
constexpr double first_hz = 1.42e9, channel_hz = 20e3;  // 4.2 km/s: within a year lines move by ±7 channels

/// Days apart, each with some integrations.
std::vector<double> times() {
  std::vector<double> all;
  for (const double day : {0.0, 90.0, 180.0, 270.0})
    for (int i = 0; i < 3; ++i) all.push_back(4.9e9 + day * 86400 + 600 * i);
  return all;
}

ms_io::SimulatedObservation observation() {
  ms_io::SimulatedObservation o;
  o.fields.front().phase_centre = {1.25, 0.3, "FK5"};
  for (std::size_t a = 0; a < antennas; ++a) {
    const double east = 90.0 * static_cast<double>(a * a);
    o.antenna_name.push_back("A" + std::to_string(a));
    o.antenna_itrf_m.push_back({-1601185.4 + east, -5041977.5 + 0.3 * east, 3554875.9});
  }
  o.time_mjd_s = times();
  for (std::size_t c = 0; c < channels; ++c) o.frequency_hz.push_back(first_hz + channel_hz * static_cast<double>(c));
  o.channel_width_hz = channel_hz;
  return o;
}

/// So that all lie within the grid of the images below.
std::vector<double> uvw(std::size_t integration) {
  std::vector<double> all;
  for (std::size_t b = 0; b < baselines; ++b) {
    const double angle = 0.26 * static_cast<double>(integration) + 0.31 * static_cast<double>(b);
    const double length = 60 + 55 * static_cast<double>(b);
    all.insert(all.end(), {length * std::cos(angle), length * std::sin(angle), 0});
  }
  return all;
}

using Spectrum = std::function<double(std::size_t integration, double hz)>;

/// A point in the phase centre with a spectrum, in the frame of the data.
void write_point(const std::string& path, const Spectrum& spectrum) {
  std::size_t now = 0;
  const auto coordinates = [&](std::size_t integration) { return uvw(now = integration); };
  const auto visibilities = [&](const imager::SampleCoordinates& at) {
    std::vector<std::complex<double>> all;
    for (std::size_t row = 0; row < at.rows(); ++row)
      for (const double hz : at.frequency_hz) all.emplace_back(spectrum(now, hz));
    return all;
  };
  ms_io::write_simulated_set(path, observation(), coordinates, visibilities, {});
}

/// [integration], see VisibilityBlock::frame_ratio, which tests of ms_io compare with others'.
std::vector<double> frame_ratios(const std::string& set, const std::string& frame) {
  ms_io::Selection selection;
  selection.spectral_frame = ms_io::parse_spectral_frame(frame);
  const ms_io::MeasurementSet read(set, selection, "data");
  const auto block = read.open()->next();
  std::vector<double> ratios;
  for (std::size_t row = 0; row < block->rows(); row += baselines) ratios.push_back(block->frame_ratio[row]);
  return ratios;
}

/// A Gaussian in one frame.
struct Line {
  double at_hz;
  double width_hz = 1.2 * channel_hz;  ///< σ

  double operator()(double hz) const { return std::exp(-0.5 * std::pow((hz - at_hz) / width_hz, 2)); }
};

Arguments cube(const std::string& set, const std::string& imagename) {
  return {"image", "--vis", set, "--imagename", imagename, "--imsize", "16", "--cell", "20arcsec", "--specmode", "cube"};
}

/// [plane], of the middle pixel.
std::vector<double> spectrum_of(const imager::ImageReader& file) {
  std::vector<double> all;
  for (int plane = 0; plane < file.header().spectral.channels; ++plane) all.push_back(file.read({plane, 0}).at(8, 8));
  return all;
}

/// The point with a line in `frame` at the middle of the band at the first time.
struct LineSet {
  TemporaryFolder folder;
  std::string set = folder / "line.ms";
  Line line{};

  explicit LineSet(const std::string& frame) {
    write_point(folder / "empty.ms", [](auto, auto) { return 0; });
    const std::vector<double> ratio = frame_ratios(folder / "empty.ms", frame);
    line.at_hz = (first_hz + 16.3 * channel_hz) * ratio.front();
    write_point(set, [&](std::size_t integration, double hz) { return line(hz * ratio[integration]); });
  }
};

bool all_nan(const imager::Image& image) {
  return std::all_of(image.pixel.begin(), image.pixel.end(), [](double x) { return std::isnan(x); });
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_line_lands_in_its_channel_in_every_frame) {
  for (const std::string frame : {"LSRK", "BARY", "GEO", "TOPO", "LSRD", "GALACTO", "LGROUP", "CMB"}) {
    const LineSet data(frame);
    for (const std::string interpolation : {"linear", "nearest"}) {
      BOOST_TEST_CONTEXT(frame << ", " << interpolation) {
        succeed(cube(data.set, data.folder / "a") + Arguments{"--outframe", frame, "--interpolation", interpolation});
        const auto file = imager::open_fits_image(data.folder / "a.residual.fits");
        const imager::SpectralAxis& axis = file->header().spectral;
        BOOST_TEST(axis.frame == ms_io::parse_spectral_frame(frame));
        BOOST_TEST_REQUIRE(axis.channels == 32);
        const std::vector<double> spectrum = spectrum_of(*file);
        const double at = axis.plane_of(data.line.at_hz);
        const auto peak = std::max_element(spectrum.begin() + 8, spectrum.begin() + 24) - spectrum.begin();
        BOOST_TEST(std::abs(static_cast<double>(peak) - at) <= 0.5);
        // Interpolated between channels of 1/1.2 σ, a Gaussian errs by 1/8 of the square of that times its second derivative at
        // most; the nearest channel is half a channel off, where the slope is 0.61/σ at most.
        const double tolerance = interpolation == "linear" ? 0.125 / 1.44 : 0.61 * 0.5 / 1.2;
        for (int plane = 8; plane < 24; ++plane)
          BOOST_TEST(std::abs(spectrum[static_cast<std::size_t>(plane)] - data.line(axis.frequency_hz(plane))) < tolerance);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(a_line_of_another_frame_is_smeared) {
  const LineSet data("LSRK");
  succeed(cube(data.set, data.folder / "a") + Arguments{"--outframe", "TOPO"});
  const std::vector<double> spectrum = spectrum_of(*imager::open_fits_image(data.folder / "a.residual.fits"));
  BOOST_TEST(*std::max_element(spectrum.begin(), spectrum.end()) < 0.6);
}

BOOST_AUTO_TEST_CASE(planes_without_samples_have_no_values_and_no_beam) {
  const LineSet data("TOPO");
  succeed(cube(data.set, data.folder / "a") +
          Arguments{"--outframe", "TOPO", "--start", "1.41990GHz", "--nchan", "8", "--niter", "20", "--outformat", "both"});
  for (const char* name : {"a.residual.fits", "a.image.fits", "a.psf.fits", "a.model.fits", "a.image", "a.psf"}) {
    BOOST_TEST_CONTEXT(name) {
      const auto file = tools::open_image_file(data.folder / name);
      for (int plane = 0; plane < 8; ++plane) {  // the first channel's lower edge is 90 kHz above the first plane's middle
        const bool empty = plane < 5;
        BOOST_TEST(all_nan(file->read({plane, 0})) == empty);
        if (std::string(name).find("model") == std::string::npos) BOOST_TEST(file->beam({plane, 0}).has_value() == !empty);
      }
    }
  }
  const nlohmann::json report = report_of(data.folder / "a");
  BOOST_TEST(report["warnings"][0] == "5 of 8 planes have no samples: they have no values and no beam");
}

BOOST_AUTO_TEST_CASE(a_cube_without_data_is_refused) {
  const LineSet data("TOPO");
  const Outcome outcome = run(cube(data.set, data.folder / "a") + Arguments{"--start", "1.5GHz", "--nchan", "4"});
  BOOST_TEST(outcome.code == 2);
  BOOST_TEST(outcome.err.find("hold no data; expected planes within 1.42") != std::string::npos);
  BOOST_TEST(!std::filesystem::exists(data.folder / "a.residual.fits"));
}

BOOST_AUTO_TEST_CASE(planes_read_again_and_again_are_those_held) {
  const LineSet data("LSRK");
  const Arguments options{"--weighting", "briggs", "--niter", "30", "--nchan", "6", "--start", "13"};
  succeed(cube(data.set, data.folder / "held") + options);
  const Outcome refused = run(cube(data.set, data.folder / "x") + options + Arguments{"--memory", "0.001"});
  const std::string before = "expected at least ";
  const auto at = refused.err.find(before);
  BOOST_TEST_REQUIRE(at != std::string::npos);
  const std::string least =
      refused.err.substr(at + before.size(), refused.err.find(' ', at + before.size()) - at - before.size());
  succeed(cube(data.set, data.folder / "read") + options + Arguments{"--memory", least});
  for (const char* kind : {"residual", "image", "psf", "model"}) {
    const auto held = imager::open_fits_image(data.folder / ("held." + std::string(kind) + ".fits"));
    const auto read = imager::open_fits_image(data.folder / ("read." + std::string(kind) + ".fits"));
    for (int plane = 0; plane < 6; ++plane)
      BOOST_TEST(held->read({plane, 0}).pixel == read->read({plane, 0}).pixel, boost::test_tools::per_element());
  }
}

BOOST_AUTO_TEST_CASE(each_plane_is_cleaned_and_restarted_by_itself) {
  const LineSet data("LSRK");
  const Arguments options{"--nchan", "4", "--start", "15"};
  succeed(cube(data.set, data.folder / "a") + options + Arguments{"--niter", "10"});
  succeed(cube(data.set, data.folder / "a") + options + Arguments{"--niter", "40", "--restart"});
  const nlohmann::json planes = report_of(data.folder / "a")["planes"];
  BOOST_TEST_REQUIRE(planes.size() == 4U);
  const auto image = imager::open_fits_image(data.folder / "a.image.fits");
  for (int plane = 0; plane < 4; ++plane) {
    BOOST_TEST(planes[static_cast<std::size_t>(plane)]["clean"]["iterations"] == 40);
    BOOST_TEST(std::filesystem::exists(data.folder / ("a.clean/" + std::to_string(plane) + ".state")));
    const double flux = data.line(image->header().spectral.frequency_hz(plane));
    BOOST_TEST(std::abs(image->read({plane, 0}).at(8, 8) - flux) < 0.1);  // as above; CLEAN leaves 0.9⁴⁰ of it
  }
}

/// Or it would go on from them, once it was killed, in planes that it had not reached.
BOOST_AUTO_TEST_CASE(a_run_that_begins_anew_leaves_no_states_of_an_earlier_one) {
  const LineSet data("LSRK");
  const Arguments options{"--nchan", "4", "--start", "15", "--threads", "1"};
  succeed(cube(data.set, data.folder / "a") + options + Arguments{"--niter", "10"});
  const std::string last = data.folder / "a.clean/3.state";
  BOOST_TEST_REQUIRE(std::filesystem::exists(last));
  Child anew(cube(data.set, data.folder / "a") + options +
             Arguments{"--niter", "1000000", "--gain", "0.0001", "--cycleniter", "2", "--quiet"});
  anew.wait_until([&] { return !std::filesystem::exists(last); });
  BOOST_TEST(!std::filesystem::exists(last));
  anew.signal(SIGKILL);
  BOOST_TEST(anew.wait().code == -SIGKILL);
}

BOOST_AUTO_TEST_CASE(planes_are_restored_with_one_beam_on_demand) {
  const LineSet data("TOPO");
  const Arguments options{"--outframe", "TOPO", "--nchan", "3", "--start", "1", "--chanwidth", "12", "--niter", "20"};
  succeed(cube(data.set, data.folder / "own") + options);
  succeed(cube(data.set, data.folder / "one") + options + Arguments{"--restoringbeam", "common"});
  const auto own = imager::open_fits_image(data.folder / "own.image.fits");
  const auto one = imager::open_fits_image(data.folder / "one.image.fits");
  const auto model = imager::open_fits_image(data.folder / "one.model.fits");
  const auto residual = imager::open_fits_image(data.folder / "one.residual.fits");
  const imager::Beam common = *one->beam({0, 0});
  for (int plane = 0; plane < 2; ++plane) {  // the third lies beyond the band in part
    const imager::Beam beam = *one->beam({plane, 0}), fitted = *own->beam({plane, 0});
    BOOST_TEST(beam.major_rad == common.major_rad);
    BOOST_TEST(beam.minor_rad == common.minor_rad);
    BOOST_TEST(beam.major_rad >= fitted.major_rad * (1 - 1e-6));  // as headers round it
    BOOST_TEST(beam.minor_rad >= fitted.minor_rad * (1 - 1e-6));
    const imager::Image sum = imager::convolve_with_beam(model->read({plane, 0}), common, one->header().geometry.cell_rad, 1);
    const imager::Image image = one->read({plane, 0}), left = residual->read({plane, 0});
    for (std::size_t i = 0; i < image.pixel.size(); ++i)  // in single precision
      BOOST_TEST(std::abs(image.pixel[i] - sum.pixel[i] - left.pixel[i]) < 1e-6);
  }
}

BOOST_AUTO_TEST_CASE(what_other_runs_left_goes) {
  const LineSet data("TOPO");
  const Arguments options{"--outframe", "TOPO", "--nchan", "2", "--start", "15"};
  const auto there = [&](const char* name) { return std::filesystem::exists(data.folder / name); };
  const auto quiet = [](const Arguments& arguments) {  // it says what it removes, but not when quiet
    const Outcome outcome = run(arguments + Arguments{"--quiet"});
    BOOST_TEST_INFO(outcome.err);
    BOOST_TEST(outcome.code == 0);
  };
  Arguments band = cube(data.set, data.folder / "a");
  band.resize(band.size() - 2);  // without --specmode
  quiet(band + Arguments{"--niter", "5"});
  BOOST_TEST(there("a.components.csv"));
  quiet(cube(data.set, data.folder / "a") + options + Arguments{"--niter", "5", "--usemask", "auto"});
  for (const char* gone : {"a.components.csv", "a.clean.state", "a.dirty.png", "a.uv.png"}) BOOST_TEST(!there(gone), gone);
  for (const char* made : {"a.image.fits", "a.mask.fits", "a.clean/1.state"}) BOOST_TEST(there(made), made);
  quiet(cube(data.set, data.folder / "a") + options);
  for (const char* gone : {"a.image.fits", "a.model.fits", "a.mask.fits", "a.image.png", "a.clean"})
    BOOST_TEST(!there(gone), gone);
  BOOST_TEST(there("a.residual.fits"));
}

BOOST_AUTO_TEST_CASE(headers_state_the_error_of_all_planes) {
  const LineSet data("TOPO");
  succeed(cube(data.set, data.folder / "a") +
          Arguments{"--outframe", "TOPO", "--start", "1.41990GHz", "--nchan", "8", "--verify", "16"});  // the first are empty
  const std::string header = content(data.folder / "a.residual.fits").substr(0, 2880 * 4);
  for (const char* card : {"ERRASKED", "ERREXPEC", "ERRBOUND", "ERRBMAX", "ERRMEAS", "ERRPRED"})
    BOOST_TEST(header.find(card) != std::string::npos, card);
}

BOOST_AUTO_TEST_CASE(masks_of_another_frame_are_refused) {
  const LineSet data("TOPO");
  const Arguments options{"--nchan", "3", "--start", "1.4202GHz", "--niter", "5"};
  succeed(cube(data.set, data.folder / "a") + options + Arguments{"--outframe", "TOPO"});
  const Outcome outcome = run(cube(data.set, data.folder / "b") + options +
                              Arguments{"--outframe", "LSRK", "--startmodel", data.folder / "a.model.fits"});
  BOOST_TEST(outcome.code == 1);
  BOOST_TEST_INFO(outcome.err);
  BOOST_TEST(outcome.err.find("in TOPOCENT; expected one plane, or the image's") != std::string::npos);
}

BOOST_AUTO_TEST_SUITE_END()
