#include "tools/mosaic/pointing_beam.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "imager/beams/cubic_weights.h"
#include "imager/beams/primary_beam.h"
#include "imager/data/image_statistics.h"
#include "imager/mosaic/linear_mosaic.h"
#include "imager/numerics/constants.h"
#include "imager/numerics/parallel.h"
#include "ms_io/celestial_frames.h"
#include "tools/base/numbers.h"
#include "tools/formats/grid_offset.h"
#include "tools/formats/image_file.h"
#include "tools/run/dish_beams.h"

namespace misfit::tools {
namespace {

/// A pattern that is not round, as its mean over position angles.
class MeanPattern : public imager::VoltagePattern {
 public:
  explicit MeanPattern(imager::Pattern of) : of_(std::move(of)) {}

  double voltage(double sine, double frequency_hz) const override { return of_->voltage(sine, frequency_hz); }
  double main_lobe_sine(double frequency_hz) const override { return of_->main_lobe_sine(frequency_hz); }
  double detail_sine(double frequency_hz) const override { return of_->detail_sine(frequency_hz); }

 private:
  imager::Pattern of_;
};

/// The largest relative departure of a pattern's power from its mean over position angles, where the mean is a half.
double departure(const imager::VoltagePattern& pattern, double half_sine, double frequency_hz) {
  constexpr int angles = 360;
  const double mean = std::pow(pattern.voltage(half_sine, frequency_hz), 2);
  double most = 0;
  for (int k = 0; k < angles; ++k) {
    const double voltage = pattern.voltage_at(half_sine, 2 * imager::pi * k / angles, frequency_hz);
    most = std::max(most, std::abs(voltage * voltage / mean - 1));
  }
  return most;
}

class FormulaBeam : public PointingBeam {
 public:
  FormulaBeam(const PointingImage& image, const imager::BeamModel& model) : image_(image), because_(model.because) {
    const double hz = image.header().spectral.band().middle_hz();
    if (!(hz > 0) || !std::isfinite(hz))
      throw std::runtime_error(image.path() +
                               " states no frequency, on which its primary beam depends; expected an axis FREQ, " +
                               "or an image " + beam_name(image) + " beside it");
    pattern_ = model.pattern->is_round() ? model.pattern : std::make_shared<MeanPattern>(model.pattern);
    if (const std::string doubt = model.doubt_at(hz); !doubt.empty()) doubts_.push_back(doubt);
    if (!model.pattern->is_round()) doubt_roundness(*model.pattern, hz);
  }

  /// Pixels of a round beam make it round to a thousandth or so.
  void doubt_roundness(const imager::VoltagePattern& pattern, double hz) {
    constexpr double little = 5e-3;
    const double half = 0.5 * imager::PrimaryBeam({{pattern_, pattern_, hz, 1}}).half_power_width_rad();
    const double away = departure(pattern, std::sin(half), hz);
    if (away < little) return;
    doubts_.push_back(because_ +
                      " is not round, and images do not say how it was turned: its mean over position angles is "
                      "taken, from which it departs by " +
                      significant(100 * away, 2) + " % where that is a half, which images .pb of misfit image --beam know");
  }

  imager::Image on(const imager::ImageHeader& mosaic, int channel, int threads) const override {
    return imager::primary_beam_image(imager::PrimaryBeam(shares(channel)), mosaic.geometry,
                                      {axis_on(mosaic.geometry), imager::LinearMosaic::least_beam, threads});
  }
  std::string origin() const override { return because_ + ", about its reference direction"; }
  bool is_about_reference() const override { return true; }
  std::vector<std::string> doubts() const override { return doubts_; }

  static std::string beam_name(const PointingImage& image) { return image.beam_path().empty() ? "X.pb" : image.beam_path(); }

 private:
  /// The frequencies of a plane, with equal weights, in steps over which a beam hardly changes.
  std::vector<imager::BeamShare> shares(int channel) const {
    constexpr double step = 1e-3;
    constexpr int most = 1000;
    const imager::FrequencyBand band = image_.header().spectral.planes(channel, 1);
    const int count =
        band.low_hz > 0 ? std::clamp(static_cast<int>(std::ceil(band.width_hz() / (step * band.middle_hz()))), 1, most) : 1;
    std::vector<imager::BeamShare> shares;
    for (int k = 0; k < count; ++k)
      shares.push_back({pattern_, pattern_, band.low_hz + (k + 0.5) / count * band.width_hz(), 1});
    return shares;
  }

  imager::DirectionCosines axis_on(const imager::ImageGeometry& mosaic) const {
    try {
      return imager::direction_cosines(ms_io::in_frame(image_.grid().reference, mosaic.phase_centre.frame),
                                       mosaic.phase_centre);
    } catch (const std::invalid_argument&) {
      throw std::runtime_error(image_.path() + " lies more than 90 degrees from the middle of the mosaic, " +
                               sexagesimal(mosaic.phase_centre) + "; expected images of one hemisphere");
    }
  }

  const PointingImage& image_;
  imager::Pattern pattern_;
  std::string because_;
  std::vector<std::string> doubts_;
};

class ImageBeam : public PointingBeam {
 public:
  explicit ImageBeam(const PointingImage& image) : path_(image.beam_path()), file_(open_image_file(path_, imager::Grids::any)) {
    const imager::SpectralAxis& axis = image.header().spectral;
    if (!file_->grid())
      throw std::runtime_error(path_ +
                               " does not say where its pixels lie on the sky; expected right ascension and declination");
    if (file_->header().spectral.channels != axis.channels)
      throw std::runtime_error(path_ + " has " + std::to_string(file_->header().spectral.channels) +
                               " planes of frequency; expected " + std::to_string(axis.channels) + " as " + image.path() +
                               " has, or --beam");
    if (axis.channels > 1) channel_for(*file_, path_, axis, 0);
    if (bands_apart(file_->header().observation, image.header().observation))
      throw std::runtime_error(path_ + " is of " + frequency_text(file_->header().observation.frequency_hz, 6) + "; expected " +
                               frequency_text(image.header().observation.frequency_hz, 6) + " as " + image.path() +
                               " has, or --beam");
  }

  imager::Image on(const imager::ImageHeader& mosaic, int channel, int threads) const override {
    constexpr double most = 1.1;
    const imager::Image beam = file_->read({channel, 0});
    if (const double largest = imager::statistics_of(beam, threads).largest; !(largest <= most))
      throw std::runtime_error(path_ + " has a pixel of " + significant(largest, 4) + "; expected a beam, 1 at most");
    const GridBeside beside(*file_, "image " + path_, mosaic);
    imager::Image on(mosaic.geometry.width, mosaic.geometry.height);
    imager::parallel_for(static_cast<std::size_t>(on.height), threads, [&](std::size_t row) {
      const int r = static_cast<int>(row);
      for (int c = 0; c < on.width; ++c) {
        const double value = between_pixels(beam, beside.map()(r, c));
        on.at(r, c) = value >= imager::LinearMosaic::least_beam ? value : std::numeric_limits<double>::quiet_NaN();
      }
    });
    return on;
  }
  std::string origin() const override { return path_; }
  bool is_about_reference() const override { return false; }

 private:
  /// The polynomial through four by four pixels: a beam is smooth over many.
  static double between_pixels(const imager::Image& beam, const imager::PixelPlace& place) {
    constexpr double none = std::numeric_limits<double>::quiet_NaN();
    const double column = std::floor(place.column), row = std::floor(place.row);
    if (!(column >= 1 && column + 2 < beam.width && row >= 1 && row + 2 < beam.height)) return none;
    const auto along = imager::cubic_weights(place.column - column), across = imager::cubic_weights(place.row - row);
    double sum = 0;
    for (int r = 0; r < 4; ++r) {
      const double* pixel = beam.row(static_cast<int>(row) - 1 + r) + static_cast<std::ptrdiff_t>(column) - 1;
      double of_row = 0;
      for (int c = 0; c < 4; ++c) of_row += along[static_cast<std::size_t>(c)] * pixel[c];
      sum += across[static_cast<std::size_t>(r)] * of_row;
    }
    return sum;
  }

  std::string path_;
  std::unique_ptr<imager::ImageReader> file_;
};

/// The beam of the telescope that the header names. A header does not say how large the dishes are.
imager::BeamModel telescope_beam(const PointingImage& image) {
  const std::string& telescope = image.header().observation.telescope;
  const std::string expected = "; expected the image " + FormulaBeam::beam_name(image) + " beside it, or --beam";
  try {
    return DishBeams().of({telescope, 0});
  } catch (const imager::NoSimpleBeam&) {
    if (telescope.empty())
      throw std::runtime_error(image.path() + " names no telescope, so that its primary beam is not known" + expected);
    const bool several = imager::is_beam_name(telescope);
    throw std::runtime_error(image.path() + " is of " + telescope + ", " +
                             (several ? "whose dishes are of several sizes, of which it does not say which made it"
                                      : "of whose antennas no simple primary beam is known") +
                             expected);
  }
}

}  // namespace

std::unique_ptr<PointingBeam> pointing_beam(const PointingImage& image, const std::string& asked) {
  std::error_code absent;
  if (!asked.empty())
    return std::make_unique<FormulaBeam>(image, DishBeams(asked).of({image.header().observation.telescope, 0}));
  if (!image.beam_path().empty() && std::filesystem::exists(image.beam_path(), absent))
    return std::make_unique<ImageBeam>(image);
  return std::make_unique<FormulaBeam>(image, telescope_beam(image));
}

}  // namespace misfit::tools
