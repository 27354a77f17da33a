#include <algorithm>
#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <random>

#include "imager/beams/airy_pattern.h"
#include "imager/data/noise.h"
#include "imager/files/fits_image_reader.h"
#include "imager/files/fits_image_writer.h"
#include "imager/mosaic/band_limited_image.h"
#include "imager/mosaic/linear_mosaic.h"
#include "ms_io/casa_image.h"
#include "tests/tools/beam_files.h"
#include "tests/tools/program.h"

BOOST_AUTO_TEST_SUITE(mosaic_command)

namespace bdata = boost::unit_test::data;
using namespace misfit;
using namespace misfit::tools::testing;
using misfit::testing::TemporaryFolder;

namespace {

constexpr double degree = std::numbers::pi / 180, arcsec = degree / 3600, hz = 1.4e9;

/// A point on the sky.
struct Point {
  imager::SkyDirection at;
  double flux_jy;
};

/// A pointing with an image of its own.
struct Pointed {
  imager::ImageGeometry geometry;
  imager::Beam beam;
};

double gaussian(const imager::Beam& beam, double l, double m) {
  const double s = std::sin(beam.position_angle_rad), c = std::cos(beam.position_angle_rad);
  const double along = (l * s + m * c) / beam.major_rad, across = (l * c - m * s) / beam.minor_rad;
  return std::exp(-4 * std::log(2.0) * (along * along + across * across));
}

double power(const imager::VoltagePattern& pattern, imager::DirectionCosines at) {
  return std::pow(pattern.voltage(std::hypot(at.l, at.m), hz), 2);
}

/// What a pointing sees at a place, restored with its beam.
double apparent(const Pointed& pointing, const imager::VoltagePattern& pattern, const std::vector<Point>& sky,
                imager::DirectionCosines at) {
  double sum = 0;
  for (const Point& point : sky) {
    const imager::DirectionCosines of = imager::direction_cosines(point.at, pointing.geometry.phase_centre);
    sum += point.flux_jy * power(pattern, of) * gaussian(pointing.beam, at.l - of.l, at.m - of.m);
  }
  return sum;
}

imager::ImageHeader header_of(const imager::ImageGeometry& geometry, int channels = 1, const std::string& stokes = "I") {
  imager::ImageHeader header;
  header.geometry = geometry;
  header.spectral = {hz, 1e6, channels, "TOPOCENT", 0, false};
  header.observation = {"MARS", "", "", "2026-01-31T12:00:00.0", geometry.phase_centre, hz, 1e6, "TOPOCENT"};
  header.stokes = imager::parse_stokes(stokes);
  return header;
}

void write(const std::string& path, const Pointed& pointing, const imager::Image& pixels) {
  const auto file = imager::create_fits_image(header_of(pointing.geometry), path, imager::PixelFormat::float64);
  file->write({}, pixels, pointing.beam);
  file->finish();
}

imager::Image apparent_image(const Pointed& pointing, const imager::VoltagePattern& pattern, const std::vector<Point>& sky) {
  imager::Image image(pointing.geometry.width, pointing.geometry.height);
  for (int r = 0; r < image.height; ++r)
    for (int c = 0; c < image.width; ++c) image.at(r, c) = apparent(pointing, pattern, sky, pointing.geometry.at(r, c));
  return image;
}

/// Three pointings near the pole, where norths differ, with images of other cells and sizes whose phase centres lie off their
/// middles; and points all over.
struct Triple {
  imager::SkyDirection middle{1, 80 * degree, "FK5"};
  std::vector<Pointed> pointings;
  std::vector<Point> sky;

  explicit Triple(const std::vector<imager::Beam>& beams) {
    const double sizes[] = {200, 190, 213}, cells[] = {10, 11, 9};
    for (std::size_t p = 0; p < 3; ++p) {
      const double angle = 2.1 * static_cast<double>(p);
      imager::ImageGeometry geometry{
          static_cast<int>(sizes[p]), 201, cells[p] * arcsec,
          imager::sky_direction({0.1 * degree * std::sin(angle), 0.1 * degree * std::cos(angle)}, middle)};
      geometry.centre = {3.4 * arcsec * static_cast<double>(p), -25 * arcsec};
      pointings.push_back({geometry, beams[p]});
    }
    for (int k = 0; k < 9; ++k) {
      const double angle = 2.4 * k, radius = 0.025 * degree * k;
      sky.push_back({imager::sky_direction({radius * std::sin(angle), radius * std::cos(angle)}, middle), 1 + 0.3 * k});
    }
  }

  std::vector<std::string> write_all(const TemporaryFolder& folder, const imager::VoltagePattern& pattern) const {
    std::vector<std::string> paths;
    for (const Pointed& pointing : pointings) {
      paths.push_back(folder / (std::string(1, static_cast<char>('a' + paths.size())) + ".image.fits"));
      write(paths.back(), pointing, apparent_image(pointing, pattern, sky));
    }
    return paths;
  }
};

Arguments mosaic_of(const std::vector<std::string>& paths, const std::string& output) {
  return Arguments{"mosaic"} + paths + Arguments{"--output", output};
}

imager::SkyImage product(const std::string& output, const std::string& kind) {
  return imager::read_fits(output + "." + kind + ".fits");
}

/// Whether a place lies in an image, and not too near its border.
bool is_known(const imager::ImageGeometry& geometry, imager::DirectionCosines at) {
  constexpr double margin = imager::BandLimitedImage::margin;
  const double column = geometry.centre_column() - (at.l - geometry.centre.l) / geometry.cell_rad,
               row = geometry.centre_row() + (at.m - geometry.centre.m) / geometry.cell_height_rad();
  return column > margin - 0.5 && column < geometry.width - margin - 0.5 && row > margin - 0.5 &&
         row < geometry.height - margin - 0.5;
}

void check_refusal(const Arguments& arguments, int code, const std::string& expected, const std::string& output) {
  const Outcome outcome = run(arguments);
  BOOST_TEST(outcome.code == code, outcome.err);
  BOOST_TEST(outcome.err.find(expected) != std::string::npos, outcome.err);
  for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(output).parent_path()))
    BOOST_TEST(entry.path().string().rfind(output + ".", 0) != 0, entry.path().string());
}

}  // namespace

/// Pixels are written in single precision. Beams come by a formula, and the images by degridding, right to 1e-6.
BOOST_AUTO_TEST_CASE(each_pixel_is_the_definition_at_its_place_on_the_sky) {
  const imager::Pattern pattern = imager::airy_pattern({40, 0});
  const imager::Beam round{45 * arcsec, 45 * arcsec, 0};
  const Triple triple({round, round, round});
  const TemporaryFolder folder;
  const std::vector<std::string> paths = triple.write_all(folder, *pattern);
  const std::string output = folder / "m";
  succeed(mosaic_of(paths, output) + Arguments{"--beam", "airy:40", "--rms", "1mJy,2mJy,0.7mJy", "--pblimit", "0.3"});
  const imager::SkyImage image = product(output, "image");
  const imager::Image weight = product(output, "weight").image, noise = product(output, "noise").image,
                      joint = product(output, "pb").image;
  const double sigmas[] = {1e-3, 2e-3, 0.7e-3};
  double largest = 0, most = 0, peak = 0;
  int defined = 0, on_rims = 0;
  for (int r = 0; r < image.image.height; ++r)
    for (int c = 0; c < image.image.width; ++c) {
      if (std::isnan(image.image.at(r, c))) continue;
      const imager::SkyDirection there = imager::sky_direction(image.geometry.at(r, c), image.geometry.phase_centre);
      double sum = 0, squares = 0;
      for (std::size_t p = 0; p < 3; ++p) {
        const Pointed& pointing = triple.pointings[p];
        const imager::DirectionCosines at = imager::direction_cosines(there, pointing.geometry.phase_centre);
        const double beam = power(*pattern, at);
        if (beam < imager::LinearMosaic::least_beam || !is_known(pointing.geometry, at)) continue;
        sum += beam * apparent(pointing, *pattern, triple.sky, at) / (sigmas[p] * sigmas[p]);
        squares += beam * beam / (sigmas[p] * sigmas[p]);
      }
      ++defined;
      most = std::max(most, squares);
      peak = std::max(peak, sum / squares);
      // On the rim of a beam, whether a pixel takes part may hang on rounding.
      if (std::abs(weight.at(r, c) / squares - 1) > 1e-5) {
        ++on_rims;
        continue;
      }
      largest = std::max(largest, std::abs(image.image.at(r, c) - sum / squares));
      BOOST_TEST(std::abs(noise.at(r, c) * std::sqrt(squares) - 1) < 1e-5);
    }
  BOOST_TEST(defined > 15000);
  BOOST_TEST(on_rims < 0.001 * defined);
  BOOST_TEST(peak > 3);
  BOOST_TEST(largest < 5e-6 * peak);
  double top = 0, bottom = 1;
  for (std::size_t i = 0; i < joint.pixel.size(); ++i) {
    if (std::isnan(joint.pixel[i])) continue;
    top = std::max(top, joint.pixel[i]);
    bottom = std::min(bottom, joint.pixel[i]);
    BOOST_TEST(std::abs(joint.pixel[i] / std::sqrt(weight.pixel[i] / most) - 1) < 1e-5);
  }
  BOOST_TEST(top == 1);
  BOOST_TEST(bottom >= 0.3);
  BOOST_TEST(image.geometry.width % 2 == 0);
  BOOST_TEST(image.geometry.cell_rad == 9 * arcsec, boost::test_tools::tolerance(1e-9));
}

/// Under flat beams a mosaic is a mean of images of one resolution, whatever way their norths are turned. Beams are turned from
/// one north to another at reference directions alone, and foreshortened by 2e-6.
BOOST_AUTO_TEST_CASE(points_have_the_beam_that_the_header_states_where_beams_differ) {
  const imager::Pattern flat = imager::airy_pattern({0.5, 0});
  const Triple triple({{60 * arcsec, 45 * arcsec, 0.3}, {70 * arcsec, 50 * arcsec, -0.8}, {55 * arcsec, 50 * arcsec, 1.3}});
  const TemporaryFolder folder;
  const std::string output = folder / "m";
  succeed(mosaic_of(triple.write_all(folder, *flat), output) + Arguments{"--beam", "airy:0.5", "--rms", "1mJy"});
  const imager::SkyImage image = product(output, "image");
  BOOST_REQUIRE(image.has_beam);
  BOOST_TEST(image.beam.minor_rad > 50 * arcsec);
  BOOST_TEST(image.beam.major_rad < 80 * arcsec);
  double largest = 0;
  int defined = 0;
  for (int r = 0; r < image.image.height; ++r)
    for (int c = 0; c < image.image.width; ++c) {
      if (std::isnan(image.image.at(r, c))) continue;
      ++defined;
      const imager::DirectionCosines at = image.geometry.at(r, c);
      double exact = 0;
      for (const Point& point : triple.sky) {
        const imager::DirectionCosines of = imager::direction_cosines(point.at, image.geometry.phase_centre);
        exact += point.flux_jy * gaussian(image.beam, at.l - of.l, at.m - of.m);
      }
      largest = std::max(largest, std::abs(image.image.at(r, c) - exact));
    }
  BOOST_TEST(defined > 20000);
  BOOST_TEST(largest < 1e-3 * 3.4);  // the brightest is of 3.4 Jy
}

/// Between its pixels a beam is a polynomial through four by four, right to 1e-7 where it is a hundred wide.
BOOST_AUTO_TEST_CASE(beams_of_images_are_taken_before_formulas) {
  const imager::Beam beam{45 * arcsec, 45 * arcsec, 0};
  const Triple triple({beam, beam, beam});
  const imager::Pattern pattern = imager::airy_pattern({40, 0});
  const TemporaryFolder folder;
  const std::vector<std::string> paths = triple.write_all(folder, *pattern);
  const Arguments how{"--rms", "1mJy", "--imsize", "180"};
  succeed(mosaic_of(paths, folder / "formula") + how + Arguments{"--beam", "airy:40"});
  for (std::size_t p = 0; p < 3; ++p) {
    const imager::ImageGeometry& geometry = triple.pointings[p].geometry;
    imager::Image power_image(geometry.width, geometry.height);
    for (int r = 0; r < geometry.height; ++r)
      for (int c = 0; c < geometry.width; ++c) power_image.at(r, c) = power(*pattern, geometry.at(r, c));
    std::string path = paths[p];
    write(path.replace(path.find(".image"), 6, ".pb"), triple.pointings[p], power_image);
  }
  const Outcome outcome = run(mosaic_of(paths, folder / "images") + how);
  BOOST_TEST(outcome.code == 0, outcome.err);
  BOOST_TEST(outcome.out.find("primary beam " + (folder / "a.pb.fits")) != std::string::npos, outcome.out);
  const imager::Image formula = product(folder / "formula", "image").image, images = product(folder / "images", "image").image;
  const imager::Image joint = product(folder / "formula", "pb").image;
  double largest = 0;
  for (std::size_t i = 0; i < formula.pixel.size(); ++i)
    if (joint.pixel[i] > 0.5) largest = std::max(largest, std::abs(images.pixel[i] - formula.pixel[i]));
  BOOST_TEST(largest < 1e-5);  // of up to 3.4 Jy; pixels are written in single precision
}

/// An image does not say how the dishes were turned, and one plane of a file none of the other frequencies.
BOOST_AUTO_TEST_CASE(beams_that_are_not_round_are_their_mean_with_a_warning) {
  const imager::Beam beam{45 * arcsec, 45 * arcsec, 0};
  const Triple triple({beam, beam, beam});
  const TemporaryFolder folder;
  const std::vector<std::string> paths = triple.write_all(folder, *imager::airy_pattern({40, 0}));
  const Arguments how{"--rms", "1mJy", "--imsize", "120", "--beam"};
  const auto write_elliptical = [&](const std::string& name, double ratio) {
    write_beam_file(folder / name, {.step = 0.01}, [ratio](double east, double north, double) {
      return std::exp(-4 * std::log(2.0) * (east * east * ratio + north * north / ratio) / (0.3 * 0.3));
    });
  };
  write_elliptical("round.fits", 1);
  write_elliptical("elliptical.fits", 1.2);
  const Outcome round = run(mosaic_of(paths, folder / "r") + how + Arguments{folder / "round.fits"});
  const Outcome elliptical = run(mosaic_of(paths, folder / "e") + how + Arguments{folder / "elliptical.fits"});
  BOOST_TEST(round.code == 0, round.err);
  BOOST_TEST(elliptical.code == 0, elliptical.err);
  BOOST_TEST(round.err.find("warning: ") == std::string::npos, round.err);
  BOOST_TEST(elliptical.err.find("is not round") != std::string::npos, elliptical.err);
  BOOST_TEST(elliptical.err.find("its mean over position angles is taken") != std::string::npos, elliptical.err);
  BOOST_TEST(product(folder / "e", "weight").image.at(60, 60) / product(folder / "r", "weight").image.at(60, 60) == 1,
             boost::test_tools::tolerance(0.02));
}

/// Simulated, imaged and cleaned one at a time; sources lie on pixels of the mosaic, and between those of the images.
BOOST_AUTO_TEST_CASE(fluxes_and_noise_of_pointings_are_those_of_the_sky) {
  constexpr int cell = 15;
  const imager::SkyDirection middle{60 * degree, 40 * degree, "FK5"};
  const std::pair<int, int> places[] = {{0, 0}, {31, 12}, {-40, 5}, {8, -46}, {20, 50}};  // pixels to the east and north
  const TemporaryFolder folder;
  std::ofstream list(folder / "sky.csv"), mask(folder / "mask.crtf");
  list.precision(15);
  mask << "#CRTFv0\n";
  list << "ra_deg,dec_deg,flux_jy\n";
  for (const auto& [east, north] : places) {
    const imager::SkyDirection at = imager::sky_direction({east * cell * arcsec, north * cell * arcsec}, middle);
    list << at.ra_rad / degree << ',' << at.dec_rad / degree << ",1.5\n";
    mask << "circle[[" << at.ra_rad / degree << "deg, " << at.dec_rad / degree << "deg], 60arcsec], coord=J2000\n";
  }
  list.close();
  mask.close();
  std::vector<std::string> paths;
  for (const double offset_arcsec : {-450.0, 450.0}) {
    const std::string name = folder / ("p" + std::to_string(paths.size()));
    const imager::SkyDirection at = imager::sky_direction({offset_arcsec * arcsec, 0.3 * offset_arcsec * arcsec}, middle);
    succeed({"simulate",
             "--output",
             name + ".ms",
             "--sky",
             folder / "sky.csv",
             "--array",
             "vla-d",
             "--primary-beam",
             "--ra",
             std::to_string(at.ra_rad / degree) + "deg",
             "--dec",
             std::to_string(at.dec_rad / degree) + "deg",
             "--frequency",
             "1.4GHz",
             "--hours",
             "3",
             "--interval",
             "300",
             "--noise",
             "50mJy",
             "--seed",
             std::to_string(paths.size() + 1)});
    succeed({"image", "--vis", name + ".ms", "--imagename", name, "--imsize", "256", "--cell", std::to_string(cell) + "arcsec",
             "--niter", "5000", "--nsigma", "0.3", "--mask", folder / "mask.crtf", "--pblimit", "0.1"});
    paths.push_back(name + ".image.fits");
  }
  const Arguments asked{"--phasecenter", "J2000 60deg 40deg", "--imsize", "200", "--cell", std::to_string(cell) + "arcsec"};
  succeed(mosaic_of(paths, folder / "with") + asked);
  for (const char* pointing : {"p0", "p1"}) std::filesystem::remove(folder / (std::string(pointing) + ".pb.fits"));
  succeed(mosaic_of(paths, folder / "without") + asked);
  for (const char* name : {"with", "without"}) {
    const imager::Image image = product(folder / name, "image").image, noise = product(folder / name, "noise").image;
    for (const auto& [east, north] : places) BOOST_TEST(std::abs(image.at(100 + north, 100 - east) / 1.5 - 1) < 0.003);
    imager::Image ratio = image;
    for (std::size_t i = 0; i < ratio.pixel.size(); ++i) ratio.pixel[i] /= noise.pixel[i];
    BOOST_TEST(std::abs(imager::robust_noise(ratio) - 1) < 0.08);  // of about 1000 beams
  }
}

BOOST_AUTO_TEST_CASE(planes_of_cubes_are_mosaics_of_their_own_and_of_any_number_of_threads) {
  const imager::Beam beam{45 * arcsec, 40 * arcsec, 0.2};
  const Triple triple({beam, beam, beam});
  const TemporaryFolder folder;
  std::vector<std::string> paths;
  for (const Pointed& pointing : triple.pointings) {
    paths.push_back(folder / ("c" + std::to_string(paths.size()) + ".image.fits"));
    const auto file =
        imager::create_fits_image(header_of(pointing.geometry, 3, "IQ"), paths.back(), imager::PixelFormat::float32);
    imager::Image image = apparent_image(pointing, *imager::airy_pattern({40, 0}), triple.sky);
    std::minstd_rand random(static_cast<unsigned>(paths.size()));
    for (double& pixel : image.pixel)
      pixel += 1e-12 * static_cast<double>(random());  // noise to tell by how much it is smoothed
    for (const imager::PlaneIndex& at : {imager::PlaneIndex{0, 0}, {0, 1}, {2, 0}, {2, 1}}) {  // channel 1 has no data
      imager::Image scaled = image;
      for (double& pixel : scaled.pixel) pixel *= 1 + at.channel - 2 * at.stokes;
      file->write(at, scaled, at.channel == 2 && paths.size() == 2 ? imager::Beam{50 * arcsec, 45 * arcsec, 0.2} : beam);
    }
    file->finish();
  }
  const Arguments how{"--beam", "airy:40", "--rms", "1mJy", "--imsize", "160", "150"};
  succeed(mosaic_of(paths, folder / "one") + how + Arguments{"--threads", "1"});
  succeed(mosaic_of(paths, folder / "three") + how + Arguments{"--threads", "3"});
  const auto one = imager::open_fits_image(folder / "one.image.fits"),
             three = imager::open_fits_image(folder / "three.image.fits");
  const auto at_middle = [&](const imager::PlaneIndex& at) { return one->read(at).at(75, 80); };
  BOOST_TEST(at_middle({0, 0}) > 0.5);
  BOOST_TEST(std::abs(at_middle({0, 1}) + at_middle({0, 0})) < 1e-6);
  BOOST_TEST(at_middle({2, 1}) / at_middle({2, 0}) == 1.0 / 3, boost::test_tools::tolerance(1e-6));
  BOOST_TEST(std::isnan(at_middle({1, 0})));
  BOOST_TEST(!one->beam({1, 0}).has_value());
  BOOST_TEST(one->beam({0, 0})->minor_rad < 41 * arcsec);  // only where beams differ they are changed
  BOOST_TEST(one->beam({2, 0})->minor_rad > 44 * arcsec);
  for (const imager::PlaneIndex& at : {imager::PlaneIndex{0, 0}, {2, 1}}) {
    const imager::Image a = one->read(at), b = three->read(at);
    BOOST_TEST(std::equal(a.pixel.begin(), a.pixel.end(), b.pixel.begin(),
                          [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); }));
  }
}

/// Under a mask as tclean leaves it pixels are stored: those beside the mask lose nothing by it.
BOOST_AUTO_TEST_CASE(casa_images_have_no_margin_beside_their_masks) {
  constexpr double masked_below = 0.3;
  const imager::Beam beam{45 * arcsec, 45 * arcsec, 0};
  const Triple triple({beam, beam, beam});
  const imager::Pattern pattern = imager::airy_pattern({40, 0});
  const TemporaryFolder folder;
  std::vector<std::string> paths = triple.write_all(folder, *pattern);
  const Pointed& first = triple.pointings[0];
  imager::Image mask(first.geometry.width, first.geometry.height);
  for (int r = 0; r < mask.height; ++r)
    for (int c = 0; c < mask.width; ++c)
      mask.at(r, c) = power(*pattern, first.geometry.at(r, c)) < masked_below ? std::nan("") : 1;
  write(folder / "mask.fits", first, mask);
  const auto file = ms_io::create_casa_image(header_of(first.geometry), folder / "masked.image");
  file->write({}, apparent_image(first, *pattern, triple.sky), beam);
  file->mask_like(*imager::open_fits_image(folder / "mask.fits"));
  file->finish();
  const Arguments how{"--beam", "airy:40", "--rms", "1mJy", "--outformat", "both"};
  succeed(mosaic_of(paths, folder / "whole") + how);
  paths.front() = folder / "masked.image";
  succeed(mosaic_of(paths, folder / "part") + how);
  const imager::SkyImage whole = product(folder / "whole", "image");
  const imager::Image part = product(folder / "part", "image").image, whole_weight = product(folder / "whole", "weight").image,
                      part_weight = product(folder / "part", "weight").image;
  BOOST_REQUIRE(part.pixel.size() == whole.image.pixel.size());
  int near = 0, without = 0;
  for (int r = 0; r < part.height; ++r)
    for (int c = 0; c < part.width; ++c) {
      if (std::isnan(part.at(r, c))) continue;
      const imager::SkyDirection there = imager::sky_direction(whole.geometry.at(r, c), whole.geometry.phase_centre);
      const double power_there = power(*pattern, imager::direction_cosines(there, first.geometry.phase_centre));
      const bool alike = std::abs(part_weight.at(r, c) / whole_weight.at(r, c) - 1) < 1e-5;
      if (power_there < masked_below - 0.02) without += alike ? 0 : 1;
      if (power_there < masked_below + 0.02) continue;
      near += power_there < masked_below + 0.1 ? 1 : 0;
      BOOST_TEST(alike);
      BOOST_TEST(std::abs(part.at(r, c) - whole.image.at(r, c)) < 1e-5);  // pixels of CASA's are in single precision
    }
  BOOST_TEST(near > 500);
  BOOST_TEST(without > 500);
  BOOST_TEST(ms_io::is_casa_image(folder / "part.weight"));
}

BOOST_AUTO_TEST_CASE(what_is_no_image_of_a_pointing_is_refused_in_one_line) {
  const imager::Beam beam{45 * arcsec, 45 * arcsec, 0};
  const Triple triple({beam, beam, beam});
  const TemporaryFolder folder;
  const std::vector<std::string> paths = triple.write_all(folder, *imager::airy_pattern({40, 0}));
  const std::string a = paths[0], output = folder / "m";
  const imager::ImageGeometry& geometry = triple.pointings[1].geometry;
  const auto variant = [&](const std::string& name, const auto& change, bool with_beam = true) {
    imager::ImageHeader header = header_of(geometry);
    change(header);
    const auto file = imager::create_fits_image(header, folder / name, imager::PixelFormat::float32);
    imager::Image zeros(geometry.width, geometry.height);
    for (int channel = 0; channel < header.spectral.channels; ++channel)
      file->write({channel, 0}, zeros, with_beam ? std::optional(beam) : std::nullopt);
    file->finish();
    return folder / name;
  };
  const auto refused = [&](const std::string& other, const std::string& expected) {
    check_refusal(mosaic_of({a, other}, output) + Arguments{"--beam", "airy:40"}, 1, expected, output);
  };
  const auto nothing = [](imager::ImageHeader&) {};
  refused(variant("b.image.pbcor.fits", nothing), "is divided by the primary beam");
  refused(variant("b-image-pb.fits", nothing), "is divided by the primary beam");
  refused(variant("unit.fits", [](auto& header) { header.unit = "Jy/pixel"; }), "unit Jy/pixel; expected Jy/beam");
  refused(variant("nobeam.fits", nothing, false), "has no restoring beam");
  refused(variant("term.fits", [](auto& header) { header.taylor = {1, 2}; }), "Taylor term 1");
  refused(variant("moving.fits", [](auto& header) { header.observation.moving_at = "2026-01-31T12:00:00"; }), "TRACKFLD");
  refused(variant("stokes.fits", [](auto& header) { header.stokes = {imager::Stokes::V}; }), "has Stokes V; expected I");
  refused(variant("cube.fits", [](auto& header) { header.spectral.channels = 2; }), "has 2 planes of frequency; expected 1");
  refused(variant("band.fits", [](auto& header) { header.spectral.reference_hz = 2e9; }), "is of 2 GHz; expected 1.4 GHz");
  refused(variant("zero.fits", nothing), "has a noise of 0 Jy/beam");
  refused(folder / "none.fits", "none.fits");
  check_refusal(mosaic_of({a, paths[1]}, output), 1,
                "is of MARS, of whose antennas no simple primary beam is known; expected the image " + (folder / "a.pb.fits") +
                    " beside it, or --beam",
                output);
  check_refusal(mosaic_of({a}, output), 2, "expected two or more", output);
  const Arguments good = mosaic_of({a, paths[1]}, output) + Arguments{"--beam", "airy:40"};
  check_refusal(good + Arguments{"--rms", "1mJy,2mJy,3mJy"}, 2, "one for each of 2 images; there are 3", output);
  check_refusal(good + Arguments{"--rms", "0"}, 2, "--rms 0: expected", output);
  check_refusal(good + Arguments{"--pblimit", "1"}, 2, "--pblimit 1: expected", output);
  check_refusal(good + Arguments{"--imsize", "0"}, 2, "--imsize 0: expected", output);
  check_refusal(good + Arguments{"--phasecenter", "M31"}, 2, "--phasecenter 'M31': expected a direction", output);
  check_refusal(good + Arguments{"--phasecenter", "0deg 0deg", "--imsize", "99"}, 1, "no image reaches the mosaic", output);
  check_refusal(good + Arguments{"--phasecenter", "240deg -80deg"}, 1, "more than 90 degrees", output);
  check_refusal(good + Arguments{"--cell", "0.1mas"}, 1, "pixels wide or high; expected", output);
  check_refusal(mosaic_of({a, paths[1]}, output) + Arguments{"--beam", "airy"}, 2, "--beam airy: expected airy:D", output);
}

BOOST_AUTO_TEST_CASE(nothing_that_is_read_is_replaced_and_no_mosaic_is_part_of_one) {
  const imager::Beam beam{45 * arcsec, 45 * arcsec, 0};
  const Triple triple({beam, beam, beam});
  const TemporaryFolder folder;
  const std::vector<std::string> paths = triple.write_all(folder, *imager::airy_pattern({40, 0}));
  const Arguments how{"--beam", "airy:40", "--rms", "1mJy"};
  const std::string before = content(paths[0]);
  const Outcome over = run(mosaic_of(paths, folder / "a") + how);
  BOOST_TEST(over.code == 1);
  BOOST_TEST(over.err.find("would take the place of") != std::string::npos, over.err);
  BOOST_TEST(content(paths[0]) == before);
  succeed(mosaic_of(paths, folder / "m") + how);
  const Outcome again = run(mosaic_of({paths[0], folder / "m.image.fits"}, folder / "n") + how);
  BOOST_TEST(again.code == 1);
  BOOST_TEST(again.err.find("is a mosaic already") != std::string::npos, again.err);
}

BOOST_AUTO_TEST_SUITE_END()
