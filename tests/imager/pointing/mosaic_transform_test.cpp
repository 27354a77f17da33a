#include "imager/pointing/mosaic_transform.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <map>
#include <tuple>

#include "imager/beams/airy_pattern.h"
#include "imager/beams/telescopes.h"
#include "imager/data/phase.h"
#include "imager/direct/verify.h"
#include "imager/numerics/constants.h"
#include "imager/plan/accurate_imaging.h"
#include "imager/pointing/mosaic_response.h"
#include "tests/imager/comparison.h"
#include "tests/imager/vla_samples.h"

BOOST_AUTO_TEST_SUITE(mosaic_transform)

using namespace misfit::imager;
using namespace misfit::imager::testing;

namespace {

constexpr double arcmin = pi / 180 / 60;
constexpr double declination_rad = 0.6;

/// A mosaic of so many pointings on a spiral, of two sorts of dishes, at 1.2 to 1.8 GHz. Beams of the outermost do
/// not reach those of the others on the opposite side; one pointing more has no data, one sees nothing of the image.
struct Mosaic {
  ImageGeometry geometry;
  std::vector<AxisFrame> fields;
  std::vector<VisibilityBlock> blocks;

  Pattern one;
  Pattern other;
  double max_w_m;

  Mosaic(int pointings, double cell_arcmin, int pixels, double largest_w_m, double dish_m = 25,
         DirectionCosines centre = {0.002, -0.001})
      : one(airy_pattern({dish_m, dish_m / 12})), other(airy_pattern({dish_m / 2, 0})), max_w_m(largest_w_m) {
    geometry = {pixels, pixels - 6, cell_arcmin * arcmin, {1, declination_rad}, centre};
    const double reach = 0.4 * pixels * geometry.cell_rad;
    for (int p = 0; p < pointings; ++p) {
      const double radius = reach * std::sqrt((p + 0.5) / pointings), angle = 2.4 * p;
      fields.emplace_back(
          DirectionCosines{geometry.centre.l + radius * std::cos(angle), geometry.centre.m + radius * std::sin(angle)},
          declination_rad);
    }
    fields.emplace_back(DirectionCosines{centre.l + 0.001, centre.m + 0.001}, declination_rad);
    fields.emplace_back(DirectionCosines{-0.6, 0.2}, declination_rad);
    for (int p = 0; p < pointings; ++p) blocks.push_back(block_of({p}, pixels));
    blocks.push_back(block_of({0, pointings + 1, pointings - 1}, pixels));  // several in a block
  }

  MosaicScene scene(double tolerance) const {
    return {geometry, RowBeams({one, other}, fields), blocks.front().frequency_hz, false, 1e-3, tolerance, max_abs_w()};
  }

  double max_abs_w() const { return max_w_m * 1.8e9 / speed_of_light_m_s; }

 private:
  VisibilityBlock block_of(const std::vector<int>& of_fields, int pixels) const {
    constexpr std::size_t rows = 6;
    VisibilityBlock block;
    for (int c = 0; c < 7; ++c) block.frequency_hz.push_back(1.2e9 + 0.1e9 * c);
    const double reach_m = 0.45 / geometry.cell_rad * speed_of_light_m_s / 1.8e9;
    const auto at = [&](std::size_t i) { return std::sin(1.7 * static_cast<double>(i * i + 1) + of_fields.front()); };
    for (std::size_t r = 0; r < rows; ++r) {
      for (const double coordinate : {reach_m * at(3 * r), reach_m * at(3 * r + 1), max_w_m * at(3 * r + 2)})
        block.uvw_m.edit().push_back(coordinate);
      block.sights.push_back({r % 3 == 0 ? 1 : 0, r % 2 == 0 ? 1 : 0, of_fields[r % of_fields.size()], 0});
    }
    const Image values = random_image(2 * static_cast<int>(block.channels()), static_cast<int>(rows),
                                      static_cast<unsigned>(of_fields.front() + pixels));
    for (std::size_t i = 0; i < block.samples(); ++i) {
      block.visibility.emplace_back(static_cast<float>(values.pixel[2 * i]), static_cast<float>(values.pixel[2 * i + 1]));
      block.weight.push_back(i % 11 == 0 ? 0 : 0.5F + 0.1F * static_cast<float>(i % 5));
    }
    return block;
  }
};

/// A beam that is twice as wide along one axis as along the other.
class EllipticPattern : public VoltagePattern {
 public:
  double voltage(double sine, double hz) const override { return std::exp(-2 * std::pow(sine / width(hz), 2)); }
  bool is_round() const override { return false; }
  double voltage_at(double sine, double angle_rad, double hz) const override {
    return std::exp(-std::pow(sine / width(hz), 2) * (2.5 - 1.5 * std::cos(2 * angle_rad)));
  }
  double main_lobe_sine(double hz) const override { return 3 * width(hz); }
  double detail_sine(double hz) const override { return width(hz); }

 private:
  static double width(double hz) { return 25 * arcmin * 1.5e9 / hz; }
};

struct Definition {
  Image dirty;
  Image sensitivity;
  Image psf;
};

/// The beams of rows at channels, over the whole image, each made once.
class BeamImages {
 public:
  BeamImages(const Mosaic& mosaic, const MosaicBeams& beams) : mosaic_(mosaic), beams_(beams) {}

  const Image& of(const RowSight& sight, double hz) {
    const auto key = std::tuple(sight.antenna_one, sight.antenna_other, sight.field, sight.zenith_rad, hz);
    const auto [place, is_new] = made_.insert({key, {}});
    if (!is_new) return place->second;
    SampleCoordinates one{std::vector<double>(3), {hz}, {sight}};
    const PairBeam beam = beams_.rows().groups(one).front().beam;
    const ImageGeometry& g = mosaic_.geometry;
    Image image(g.width, g.height);
    for (int row = 0; row < g.height; ++row)
      for (int column = 0; column < g.width; ++column)
        if (beam.frame.sine(g.at(row, column)) <= beams_.reach(beam)) image.at(row, column) = beam.power(g.at(row, column), hz);
    return place->second = image;
  }

 private:
  const Mosaic& mosaic_;
  const MosaicBeams& beams_;
  std::map<std::tuple<int, int, int, float, double>, Image> made_;
};

/// Sample by sample and pixel by pixel; the PSF that of a source in a pixel.
Definition by_definition(const Mosaic& mosaic, const MosaicBeams& beams, int psf_row, int psf_column) {
  const ImageGeometry& g = mosaic.geometry;
  Definition sums{Image(g.width, g.height), Image(g.width, g.height), Image(g.width, g.height)};
  BeamImages beam_images(mosaic, beams);
  const PhasePosition source = phase_position(g.at(psf_row, psf_column));
  for (const VisibilityBlock& block : mosaic.blocks)
    for (std::size_t i = 0; i < block.samples(); ++i) {
      const std::size_t row = i / block.channels();
      const double weight = block.weight[i], hz = block.frequency_hz[i % block.channels()];
      if (weight == 0) continue;
      const Image& beam = beam_images.of(block.sights[row], hz);
      const double from_source = turns_per_hz(&block.uvw_m[3 * row], source) * hz;
      const std::complex<double> v = block.visibility[i];
      for (int r = 0; r < g.height; ++r)
        for (int column = 0; column < g.width; ++column) {
          const double seen = beam.at(r, column);
          if (seen == 0) continue;
          const double turns = turns_per_hz(&block.uvw_m[3 * row], phase_position(g.at(r, column))) * hz;
          sums.dirty.at(r, column) += weight * seen * (v * std::polar(1.0, -2 * pi * turns)).real();
          sums.psf.at(r, column) += weight * seen * beam.at(psf_row, psf_column) * std::cos(2 * pi * (turns - from_source));
          sums.sensitivity.at(r, column) += weight * seen * seen;
        }
    }
  return sums;
}

GriddingRequest request_of(const Mosaic& mosaic, double accuracy, int psf_row, int psf_column) {
  GriddingRequest request;
  request.geometry = mosaic.geometry;
  request.mosaic = std::make_shared<const MosaicRequest>(
      MosaicRequest{std::make_shared<const MosaicBeams>(mosaic.scene(0.1 * accuracy)), psf_row, psf_column, true});
  request.accuracy = accuracy;
  request.samples = 100000000;  // so that samples are gridded, few as they are
  request.max_abs_w = mosaic.max_abs_w();
  request.threads = 2;
  return request;
}

}  // namespace

/// What follows from the terms is the beam, in any direction up to its radius, at all frequencies: of fits with ends of their
/// own in each band, of dishes, and of two sorts of them.
BOOST_AUTO_TEST_CASE(terms_of_beams_add_up_to_the_beams) {
  constexpr double tolerance = 1e-6;
  const auto named = [](const char* name) { return named_beam(name, {"", 25}).pattern; };
  struct Band {
    std::vector<Pattern> patterns;
    double low_hz, high_hz;
  };
  for (const Band& band : {Band{{named("VLA")}, 224e6, 480e6},
                           {{named("VLA")}, 337e6, 357e6},
                           {{named("VLA")}, 1e9, 2e9},
                           {{named("VLA")}, 5e9, 6.1e9},
                           {{named("GMRT")}, 550e6, 850e6},
                           {{named("airy:25"), named("airy:12:1")}, 1.2e9, 1.8e9}}) {
    constexpr int channels = 61;
    std::vector<double> hz;
    for (int c = 0; c < channels; ++c) hz.push_back(band.low_hz + (band.high_hz - band.low_hz) * c / (channels - 1));
    const AxisFrame frame({0, 0}, declination_rad);
    const ImageGeometry image{400, 400, 1 * arcmin, {1, declination_rad}, {0, 0}};
    const MosaicBeams beams({image, RowBeams(band.patterns, {frame}), hz, false, 1e-3, tolerance});
    for (const Pattern& one : band.patterns)
      for (const Pattern& other : band.patterns) {
        const PairBeam pair{one, other, frame, 0};
        constexpr int directions = 331;
        double worst = 0;
        for (int d = 0; d < directions; ++d) {
          const double sine = beams.reach(pair) * d / directions;
          const DirectionCosines at{sine * 0.6, sine * 0.8};
          std::vector<double> is(hz.size());
          double most = 1e-6;
          for (std::size_t c = 0; c < hz.size(); ++c) {
            const BeamSpan& span = *beams.spans({hz[c]}).front();
            const std::vector<double> share = span.shares(hz[c]), terms = beams.terms(pair, at, span);
            for (std::size_t k = 0; k < terms.size(); ++k) is[c] += share[k] * terms[k];
            most = std::max(most, beams.power(pair, at, hz[c]));
          }
          for (std::size_t c = 0; c < hz.size(); ++c)
            worst = std::max(worst, std::abs(is[c] - beams.power(pair, at, hz[c])) / most);
        }
        BOOST_TEST(worst < 3 * tolerance, "at " << band.low_hz << " Hz: " << worst);  // between the directions looked at
      }
  }
}

/// For windows over which w matters so much that terms are gridded one by one; for such over which all are gridded together;
/// and without w.
BOOST_AUTO_TEST_CASE(images_and_predictions_are_those_of_the_definition, *boost::unit_test::label("sweep")) {
  struct Asked {
    Mosaic mosaic;
    std::vector<double> accuracies;
    bool curved;
  };
  const std::vector<double> all{1e-3, 1e-5, 1e-7};
  for (const auto& [mosaic, accuracies, curved] : {Asked{{2, 2.0, 120, 3000}, all, false},
                                                   {{7, 2.0, 150, 10}, all, true},
                                                   {{7, 0.5, 150, 1.5, 100}, all, true},
                                                   {{37, 1.6, 120, 0}, all, true}}) {
    const int pixels = mosaic.geometry.width;
    const int psf_row = pixels / 2 - 9, psf_column = pixels / 2 + 4;
    Definition should;
    for (const double accuracy : accuracies) {
      const GriddingPlan plan = plan_gridding(request_of(mosaic, accuracy, psf_row, psf_column));
      BOOST_TEST(plan.windows->unseeing == 1);
      BOOST_TEST((plan.windows->curved > 0) == curved);
      const MosaicBeams& beams = *plan.request.mosaic->beams;
      if (should.dirty.pixel.empty()) should = by_definition(mosaic, beams, psf_row, psf_column);
      const PlannedTransform transform(plan);
      const auto sum = transform.adjoint({.images = 1, .with_psf = true, .with_sensitivity = true});
      for (const VisibilityBlock& block : mosaic.blocks) sum->add(block);
      AdjointResult is = sum->finish();
      BOOST_TEST_CONTEXT(mosaic.fields.size() << " pointings, accuracy " << accuracy) {
        BOOST_TEST(relative_error(is.images[0].pixel, should.dirty.pixel) < accuracy);
        BOOST_TEST(relative_error(is.psf.pixel, should.psf.pixel) < accuracy);
        BOOST_TEST(relative_error(is.sensitivity.pixel, should.sensitivity.pixel) < accuracy);
        const StoredVisibilities source = stored(mosaic.blocks);
        const DirtyImages images = make_dirty_images(source, transform, {.with_psf = true}, {});
        const MeasuredError measured = measure_error(source, transform, mosaic.geometry, images, 200, {2},
                                                     std::make_shared<MosaicResponse>(plan.request.mosaic->beams));
        BOOST_TEST(measured.image.front().rms < 1.5 * accuracy);  // of some pixels
        BOOST_TEST(measured.predict_rms < accuracy);
        BOOST_TEST(images.psf.at(images.psf.height / 2, images.psf.width / 2) == 1,
                   boost::test_tools::tolerance(10 * accuracy));
        BOOST_TEST(largest_magnitude(images.psf) < 1 + 0.5);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(prediction_and_images_are_adjoint_to_rounding) {
  for (const double max_w_m : {0.0, 10.0, 3000.0}) {
    const Mosaic mosaic(7, 2, 90, max_w_m);
    GriddingRequest request = request_of(mosaic, 1e-4, 40, 40);
    request.precision = Precision::double_precision;
    const PlannedTransform transform(plan_gridding(request));
    const Image model = random_image(mosaic.geometry.width, mosaic.geometry.height, 5);
    const auto sum = transform.adjoint({.images = 1, .with_psf = true});
    const auto prediction = transform.predict(model);
    double in_samples = 0, size = 0;
    for (const VisibilityBlock& block : mosaic.blocks) {
      sum->add(block);
      const auto predicted = prediction->at_usable(block);
      for (std::size_t i = 0; i < block.samples(); ++i) {
        const double product =
            double{block.weight[i]} * (std::conj(std::complex<double>(block.visibility[i])) * predicted[i]).real();
        in_samples += product;
        size += std::abs(product);
      }
    }
    const AdjointResult result = sum->finish();
    double in_images = 0;
    for (std::size_t i = 0; i < model.pixel.size(); ++i) in_images += result.images[0].pixel[i] * model.pixel[i];
    BOOST_TEST(std::abs(in_images - in_samples) < 1e-12 * size);
  }
}

/// The same far from the phase centre, where a plane tangent to the sky makes 2.7 times as much of w; and for beams that are
/// not round, of which two turns see the sky.
BOOST_AUTO_TEST_CASE(mosaics_far_off_and_of_beams_that_are_not_round_are_those_of_the_definition) {
  constexpr double accuracy = 1e-5;
  Mosaic far(3, 2, 70, 5, 25, {0.75, -0.55});
  Mosaic elliptic(3, 2, 70, 20);
  elliptic.one = std::make_shared<const EllipticPattern>();
  for (VisibilityBlock& block : elliptic.blocks)
    for (std::size_t r = 0; r < block.sights.size(); r += 2) block.sights[r].zenith_rad = 0.7F;
  for (const Mosaic& mosaic : {far, elliptic}) {
    const GriddingPlan plan = plan_gridding(request_of(mosaic, accuracy, 30, 40));
    BOOST_TEST(plan.windows->curved > 0);
    const Definition should = by_definition(mosaic, *plan.request.mosaic->beams, 30, 40);
    const auto sum = PlannedTransform(plan).adjoint({.with_psf = true, .with_sensitivity = true});
    for (const VisibilityBlock& block : mosaic.blocks) sum->add(block);
    const AdjointResult is = sum->finish();
    BOOST_TEST(relative_error(is.images[0].pixel, should.dirty.pixel) < accuracy);
    BOOST_TEST(relative_error(is.psf.pixel, should.psf.pixel) < accuracy);
    BOOST_TEST(relative_error(is.sensitivity.pixel, should.sensitivity.pixel) < accuracy);
  }
}

/// Samples that are not usable may have any w.
BOOST_AUTO_TEST_CASE(errors_are_measured_on_usable_samples) {
  Mosaic mosaic(2, 2, 60, 10);
  for (VisibilityBlock& block : mosaic.blocks) {
    block.uvw_m.edit()[2] = 1e6;
    std::fill_n(block.weight.begin(), block.channels(), 0);
  }
  const GriddingPlan plan = plan_gridding(request_of(mosaic, 1e-4, 30, 30));
  const PlannedTransform transform(plan);
  const StoredVisibilities source = stored(mosaic.blocks);
  const DirtyImages images = make_dirty_images(source, transform, {.with_psf = true}, {});
  const MeasuredError measured = measure_error(source, transform, mosaic.geometry, images, 200, {2},
                                               std::make_shared<MosaicResponse>(plan.request.mosaic->beams));
  BOOST_TEST(measured.predict_rms < 1e-4);
}

/// Beams that more accuracy is asked of than they follow to are gridded term by term, and so are all where w makes too much.
BOOST_AUTO_TEST_CASE(curved_terms_are_left_where_they_are_not_enough) {
  const Mosaic mosaic(2, 2, 60, 10);
  GriddingRequest request = request_of(mosaic, 1e-4, 30, 30);
  request.accuracy = 1e-5;
  BOOST_TEST(plan_gridding(request).windows->curved == 0);
  MosaicScene scene = mosaic.scene(1e-6);
  BOOST_TEST(MosaicBeams(scene).curved_sizes().size() > 1);
  scene.max_abs_w = 1e9;
  BOOST_TEST(MosaicBeams(scene).curved_sizes().empty());
  scene.max_abs_w.reset();
  BOOST_TEST(MosaicBeams(scene).curved_sizes().empty());
}

/// Curved terms make what beams and w make, at all frequencies and w: of one window, and of two of which one has all but a few
/// of the channels.
BOOST_AUTO_TEST_CASE(curved_terms_add_up_to_beams_and_phases) {
  constexpr double tolerance = 1e-6;
  constexpr int channels = 61, directions = 41, steps = 17;
  const Pattern vla = named_beam("VLA", {"", 25}).pattern;
  const Pattern one = airy_pattern({25, 2}), other = airy_pattern({12.5, 0});
  const AxisFrame frame({0.1, -0.2}, declination_rad);
  const ImageGeometry image{400, 400, 1 * arcmin, {1, declination_rad}, {0.1, -0.2}};
  struct Scene {
    std::vector<Pattern> patterns;
    double low_hz, high_hz, max_abs_w;
    int narrow = 0;  ///< channels in the upper 1% of the band
  };
  for (const Scene& scene : {Scene{{vla}, 1.37e9, 1.43e9, 0},
                             {{vla}, 1.37e9, 1.43e9, 1e-3},
                             {{vla}, 1.37e9, 1.43e9, 2e4},
                             {{vla}, 1e9, 2e9, 2e4},
                             {{vla}, 1.4e9, 1.4e9, 1.6e5},
                             {{one, other}, 1.2e9, 1.8e9, 5e3},
                             {{one}, 1e9, 2e9, 0, 3000}}) {
    std::vector<double> hz;
    for (int c = 0; c < channels; ++c) hz.push_back(scene.low_hz + (scene.high_hz - scene.low_hz) * c / (channels - 1));
    for (int c = 0; c < scene.narrow; ++c)
      hz.push_back(scene.high_hz - 0.01 * (scene.high_hz - scene.low_hz) * c / scene.narrow);
    const bool at_each = scene.low_hz == scene.high_hz;
    const MosaicBeams beams({image, RowBeams(scene.patterns, {frame}), hz, at_each, 1e-3, tolerance, scene.max_abs_w});
    BOOST_TEST_CONTEXT(scene.low_hz << " Hz, w of " << scene.max_abs_w) {
      BOOST_TEST_REQUIRE(!beams.curved_sizes().empty());
      if (scene.max_abs_w < 1) BOOST_TEST(beams.curved_sizes().size() < 12);
      const BeamSpan& span = *beams.spans({hz.front()}).front();
      const CurvedTerms& terms = beams.curved(span);
      for (const Pattern& a : scene.patterns)
        for (const Pattern& b : scene.patterns) {
          const PairBeam pair{a, b, {{0, 0}, declination_rad}, 0};
          double worst = 0;
          for (int d = 0; d < directions; ++d) {
            const double sine = beams.reach(pair) * d / directions, q = terms.q(sine);
            const DirectionCosines at{sine * 0.6, sine * 0.8};
            std::vector<double> term(terms.terms());
            for (std::size_t k = 0; k < term.size(); ++k)
              for (std::size_t j = 0; j < term.size(); ++j) {
                const CurvedTerms::Node& node = terms.nodes()[j];
                const double beam = beams.power(pair, at, at_each ? hz.front() : node.frequency_hz);
                term[k] += terms.of_nodes(k)[j] * beam * node.wave(q);
              }
            double most = 1e-6;
            for (const double f : hz) most = std::max(most, beams.power(pair, at, f));
            for (std::size_t c = 0; c < channels; c += 5)
              for (int step = 0; step <= steps; ++step) {
                const double w = terms.most_abs_w() * step / steps;
                const ShareTable& table = terms.shares(hz[c]);
                const double place = w * terms.steps_a_wavelength();
                std::complex<double> is;
                for (int p = 0; p < ShareTable::points; ++p) {  // by Lagrange's formula
                  double weight = 1;
                  for (int other_p = 0; other_p < ShareTable::points; ++other_p)
                    if (other_p != p) weight *= (place - std::floor(place) + ShareTable::before - other_p) / (p - other_p);
                  const double* const share = table.at(static_cast<std::size_t>(place), 0.0) + p * table.point_stride();
                  for (std::size_t k = 0; k < term.size(); ++k)
                    is += weight * term[k] * std::complex<double>(share[k], share[table.part_stride() + k]);
                }
                worst = std::max(worst, std::abs(is - std::polar(beams.power(pair, at, hz[c]), 2 * pi * w * q)) / most);
              }
          }
          BOOST_TEST(worst < 3 * tolerance);  // between the directions looked at
        }
    }
  }
}

/// The same for all terms at once, and whatever memory has room for.
BOOST_AUTO_TEST_CASE(few_curved_terms_at_once_and_any_threads_make_the_same_images) {
  const Mosaic mosaic(7, 2, 90, 10);
  GriddingRequest request = request_of(mosaic, 1e-5, 40, 40);
  const auto image_by = [&](std::size_t samples_at_once, int threads, std::size_t stack_bytes) {
    request.samples_at_once = samples_at_once;
    request.threads = threads;
    request.stack_bytes = stack_bytes;
    const GriddingPlan plan = plan_gridding(request);
    BOOST_TEST(plan.windows->curved > 1);
    BOOST_TEST((plan.windows->curved_at_once < plan.windows->curved) == (stack_bytes == 1));
    const PlannedTransform transform(plan);
    const auto sum = transform.adjoint({.with_psf = true});
    for (const VisibilityBlock& block : mosaic.blocks) sum->add(block);
    AdjointResult made = sum->finish();
    std::vector<double> all = made.images.front().pixel;
    all.insert(all.end(), made.psf.pixel.begin(), made.psf.pixel.end());
    const auto predicted = transform.predict(made.images.front())->at_usable(mosaic.blocks.front());
    for (const std::complex<double>& v : predicted) all.insert(all.end(), {v.real(), v.imag()});
    return all;
  };
  constexpr std::size_t enough = std::size_t{1} << 30;
  const std::vector<double> all = image_by(100000, 1, enough);
  BOOST_TEST((image_by(100000, 3, enough) == all));
  BOOST_TEST(relative_error(image_by(100, 2, enough), all) < 1e-6);  // of sums in single precision
  BOOST_TEST(relative_error(image_by(100000, 2, 1), all) < 1e-6);
}

/// Samples may gather at once or in parts, and threads give the same bits.
BOOST_AUTO_TEST_CASE(few_samples_at_once_and_any_threads_make_the_same_images) {
  const Mosaic mosaic(7, 2, 90, 10);
  const auto beams = std::make_shared<const MosaicBeams>(mosaic.scene(1e-6));
  const auto image_by = [&](std::size_t samples_at_once, int threads, int side_by_side) {
    const MakeTermTransform direct = [](const ImageGeometry& g) { return std::make_shared<DirectTransform>(g, 1); };
    const std::vector<MakeTermTransform> of_term(beams->term_sizes().size(), direct);
    const MosaicTransform transform(beams, of_term, {40, 40, true, samples_at_once, threads, side_by_side});
    const auto sum = transform.adjoint({});
    for (const VisibilityBlock& block : mosaic.blocks) sum->add(block);
    return sum->finish().images.front().pixel;
  };
  const std::vector<double> all = image_by(100000, 1, 1);
  BOOST_TEST((image_by(100000, 3, 3) == all));
  BOOST_TEST((image_by(100000, 3, 1) == all));
  BOOST_TEST(relative_error(image_by(1, 2, 2), all) < 1e-13);
}

BOOST_AUTO_TEST_SUITE_END()
