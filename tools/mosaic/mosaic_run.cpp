#include "tools/mosaic/mosaic_run.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>
#include <stdexcept>
#include <system_error>

#include "imager/beams/common_beam.h"
#include "imager/data/image_statistics.h"
#include "imager/mosaic/band_limited_image.h"
#include "imager/mosaic/linear_mosaic.h"
#include "imager/mosaic/resolution.h"
#include "imager/numerics/parallel.h"
#include "tools/base/files.h"
#include "tools/base/numbers.h"
#include "tools/base/progress.h"
#include "tools/formats/grid_offset.h"
#include "tools/mosaic/mosaic_grid.h"
#include "tools/mosaic/pointing_noise.h"
#include "tools/run/field_beams.h"
#include "tools/run/image_files.h"
#include "tools/run/left_over.h"
#include "tools/run/name_lock.h"

namespace misfit::tools {
namespace {

/// The images that are written, as they follow NAME; the mosaic itself appears last.
constexpr std::array products{"weight", "noise", "pb", "image"};

std::string beam_text(const imager::Beam& beam) {
  return angle_text(beam.major_rad, 4) + " × " + angle_text(beam.minor_rad, 4) + ", " +
         significant(beam.position_angle_rad * 180 / M_PI, 3) + "°";
}

imager::Beam turned(imager::Beam beam, double by_rad) {
  beam.position_angle_rad = std::remainder(beam.position_angle_rad + by_rad, M_PI);
  return beam;
}

bool has_values(const imager::Image& image) {
  return std::any_of(image.pixel.begin(), image.pixel.end(), [](double value) { return !std::isnan(value); });
}

bool is_zero(const imager::Image& image) {
  return std::all_of(image.pixel.begin(), image.pixel.end(), [](double value) { return value == 0 || std::isnan(value); });
}

/// The range of a number of an image over its planes.
struct Range {
  double least = 0, largest = 0;

  void take(double value) {
    least = largest == 0 ? value : std::min(least, value);
    largest = std::max(largest, value);
  }
  std::string text() const {
    const std::string first = with_prefix(least, "Jy/beam", 3);
    return least == largest ? first : first + " to " + with_prefix(largest, "Jy/beam", 3);
  }
};

class MosaicRun {
 public:
  MosaicRun(const MosaicOptions& options, const CommandCall& call)
      : o_(options),
        call_(call),
        threads_(o_.threads == 0 ? imager::available_threads() : o_.threads),
        asked_noises_jy_(o_.noises_jy()),
        progress_(o_.quiet) {}

  void run() {
    open();
    claim_paths();
    lay_out();
    open_files();
    progress_.begin("mosaic");
    for (int channel = 0; channel < header_.spectral.channels; ++channel)
      for (int stokes = 0; stokes < static_cast<int>(header_.stokes.size()); ++stokes) make_plane({channel, stokes});
    progress_.end();
    say_what_is_left_out();
    for (const char* product : products) files_.at(product)->finish();
    conclude(outcome(), o_.quiet, call_.outcome);
  }

 private:
  /// An image's part in the mosaic.
  struct Tally {
    Range noise;
    std::size_t pixels = 0;  ///< of the mosaic, to which it adds
    int smoothed = 0;        ///< planes that were brought to another beam
    bool empty = true;       ///< no plane of it has values
  };

  void open() {
    for (const std::string& path : o_.images) {
      Pointing& pointing = pointings_.emplace_back();
      pointing.image = std::make_unique<PointingImage>(path);
      require_alike(*pointing.image, *pointings_.front().image);
      require_new(path);
      pointing.beam = pointing_beam(*pointing.image, o_.beam);
      for (const std::string& doubt : pointing.beam->doubts())
        if (doubts_.insert(doubt).second) progress_.say("warning: " + doubt);
      warn_of_coarse_pixels(*pointing.image);
    }
    tallies_.resize(pointings_.size());
    warn_of_shared_references();
  }

  /// Throws where the last image is one of those before.
  void require_new(const std::string& path) const {
    for (std::size_t p = 0; p + 1 < pointings_.size(); ++p)
      if (std::error_code absent; std::filesystem::equivalent(path, pointings_[p].image->path(), absent))
        throw std::runtime_error(path + " is " + pointings_[p].image->path() + " again; expected each image once");
  }

  /// Warns of images of several pointings that were phased to one direction.
  void warn_of_shared_references() {
    constexpr double rounding_rad = 1e-8;
    const Pointing* before = nullptr;
    for (const Pointing& pointing : pointings_) {
      if (!pointing.beam->is_about_reference()) continue;
      if (before != nullptr &&
          angle_between(before->image->grid().reference, pointing.image->grid().reference) < rounding_rad) {
        progress_.say(
            "warning: " + before->image->path() + " and " + pointing.image->path() + " have one reference direction, " +
            sexagesimal(pointing.image->grid().reference) +
            ", and their beams are taken to be about it; if antennas pointed elsewhere, put an image .pb beside each");
        return;
      }
      before = &pointing;
    }
  }

  void warn_of_coarse_pixels(const PointingImage& image) {
    constexpr double enough = 3;  // pixels: 1.4e-3 of the beam's spectrum is beyond what is interpolated exactly
    const std::optional<imager::Beam> beam = image.beam({0, 0});
    const double cell_rad = std::max(image.grid().column_step_rad(), image.grid().row_step_rad());
    if (beam && beam->minor_rad < enough * cell_rad)
      progress_.say("warning: the beam of " + image.path() + " is " + significant(beam->minor_rad / cell_rad, 3) +
                    " pixels wide: between its pixels the image has an error of about a part of " +
                    power_of_ten(std::erfc(0.4 * M_PI * beam->minor_rad / cell_rad / std::sqrt(4 * std::log(2.0))), 1));
  }

  /// Claims the paths of the products; no file that is read is replaced.
  void claim_paths() {
    check_writable_folder(o_.output);
    for (const char* product : products) {
      const std::string name = o_.output + "." + product;
      check_image_paths(name, o_.outformat, "--output");
      for (const std::string& path : image_paths(name, o_.outformat))
        for (const Pointing& pointing : pointings_)
          for (const std::string& read : {pointing.image->path(), pointing.image->beam_path(), pointing.image->residual_path()})
            if (std::error_code absent; !read.empty() && std::filesystem::equivalent(path, read, absent))
              throw std::runtime_error("--output " + o_.output + ": " + path + " would take the place of " + read +
                                       ", which belongs to an image of the mosaic; expected another name");
    }
    lock_ = std::make_unique<NameLock>(o_.output, "--output");
    remove_half_written(o_.output);
  }

  void lay_out() {
    progress_.begin("grid");
    header_ = mosaic_header(o_, pointings_, threads_);
    header_.cards.clear();
    header_.history = {call_.command_line};
    header_.unit = "Jy/beam";
    header_.taylor = {};
    for (const Pointing& pointing : pointings_) {
      maps_.push_back(GridBeside(pointing.image->reader(), "image " + pointing.image->path(), header_).map());
      turns_rad_.push_back(north_turn_rad(*pointing.image, header_.geometry));
    }
    progress_.end();
  }

  void open_files() {
    for (const char* product : products) {
      imager::ImageHeader header = header_;
      if (product == std::string("weight")) header.unit = "beam2 Jy-2";
      if (product == std::string("pb")) header.unit = "";
      files_[product] = open_image_files(o_.output + "." + product, header, imager::PixelFormat::float32, o_.outformat);
    }
  }

  /// The restoring beams of the images' planes about the mosaic's north, nothing where there is none.
  std::vector<std::optional<imager::Beam>> beams_at(const imager::PlaneIndex& at) const {
    std::vector<std::optional<imager::Beam>> beams;
    for (std::size_t p = 0; p < pointings_.size(); ++p) {
      beams.push_back(pointings_[p].image->beam(at));
      if (beams.back()) beams.back() = turned(*beams.back(), turns_rad_[p]);
    }
    return beams;
  }

  /// The beam of a plane of the mosaic.
  struct PlaneBeam {
    std::optional<imager::Beam> beam;  ///< nothing where no image has one there
    bool differ = false;               ///< images have others
  };
  static PlaneBeam beam_of_plane(const std::vector<std::optional<imager::Beam>>& beams) {
    std::vector<imager::Beam> known;
    for (const auto& beam : beams)
      if (beam) known.push_back(*beam);
    if (known.empty()) return {};
    if (imager::of_one_resolution(known)) return {known.front(), false};
    return {imager::common_beam(known), true};
  }

  void make_plane(const imager::PlaneIndex& at) {
    const std::vector<std::optional<imager::Beam>> beams = beams_at(at);
    const auto [to, differ] = beam_of_plane(beams);
    imager::LinearMosaic mosaic(header_.geometry.width, header_.geometry.height);
    for (std::size_t p = 0; p < pointings_.size(); ++p) {
      progress_.update(done_++, total());
      const PointingImage& image = *pointings_[p].image;
      KnownPlane plane = image.read(at);
      if (!has_values(plane.shown)) continue;
      if (!beams[p] && is_zero(plane.shown)) continue;  // as channels without samples are written
      if (!beams[p])
        throw std::runtime_error(image.path() + " has no restoring beam for its plane " + plane_words(image, at) +
                                 ", which has values; expected one");
      std::optional<imager::BeamChange> change;
      if (differ && !imager::of_one_resolution({*beams[p], *to}))
        change = imager::BeamChange{turned(*beams[p], -turns_rad_[p]), turned(*to, -turns_rad_[p])};
      add(p, at, std::move(plane), change, mosaic);
    }
    write(at, mosaic.finished(o_.pblimit), to);
  }

  void add(std::size_t p, const imager::PlaneIndex& at, KnownPlane plane, const std::optional<imager::BeamChange>& change,
           imager::LinearMosaic& mosaic) {
    const PointingImage& image = *pointings_[p].image;
    Tally& tally = tallies_[p];
    tally.empty = false;
    const double noise_jy = noise_of(p, at, plane.shown, change);
    tally.noise.take(noise_jy);
    const imager::Image beam = pointings_[p].beam->on(header_, at.channel, threads_);
    if (!has_values(beam)) return;
    if (change) {
      plane.pixels = imager::with_beam(plane.pixels, *change, image.grid(), threads_);
      ++tally.smoothed;
    }
    const imager::BandLimitedImage between(plane.pixels, plane.shown, threads_);
    plane = {};
    const imager::Image apparent = imager::regridded(between, maps_[p], beam, threads_);
    tally.pixels += imager::statistics_of(apparent, threads_).count;
    mosaic.add({apparent, beam, noise_jy}, threads_);
  }

  double noise_of(std::size_t p, const imager::PlaneIndex& at, const imager::Image& shown,
                  const std::optional<imager::BeamChange>& change) {
    NoiseRequest request{{}, change, threads_};
    if (!asked_noises_jy_.empty()) request.given_jy = asked_noises_jy_[p];
    const PlaneNoise noise = noise_of_plane(*pointings_[p].image, at, shown, request);
    if (!noise.doubt.empty() && doubted_noises_.insert(p).second) progress_.say("warning: " + noise.doubt);
    return noise.noise_jy;
  }

  void write(const imager::PlaneIndex& at, const imager::MosaicPlane& plane, const std::optional<imager::Beam>& beam) {
    const std::optional<imager::Beam> own = has_values(plane.sky) ? beam : std::nullopt;
    files_.at("image")->write(at, plane.sky, own);
    files_.at("weight")->write(at, plane.weight, std::nullopt);
    files_.at("noise")->write(at, plane.noise, own);
    files_.at("pb")->write(at, plane.beam, std::nullopt);
    for (const double noise_jy : plane.noise.pixel)
      if (noise_jy > 0 && (least_noise_jy_ == 0 || noise_jy < least_noise_jy_)) least_noise_jy_ = noise_jy;
    if (own) beams_.push_back(*own);
  }

  void say_what_is_left_out() {
    std::size_t pixels = 0;
    for (const Tally& tally : tallies_) pixels += tally.pixels;
    if (pixels == 0)
      throw std::runtime_error("no image reaches the mosaic, " + size_text() + " about " +
                               sexagesimal(header_.geometry.phase_centre) + "; expected another --phasecenter or --imsize");
    if (beams_.empty())
      throw std::runtime_error("no pixel of the mosaic has a value: the first image has noises from " +
                               with_prefix(tallies_.front().noise.least, "Jy/beam", 3) +
                               " on, whose squares are too large or too small for numbers; expected other noises, or --rms");
    for (std::size_t p = 0; p < tallies_.size(); ++p)
      if (tallies_[p].pixels == 0)
        progress_.say(
            "warning: " + pointings_[p].image->path() +
            (tallies_[p].empty ? " has no pixel with a value" : " does not reach the mosaic where its beam is known"));
  }

  Outcome outcome() const {
    std::string words;
    for (std::size_t p = 0; p < pointings_.size(); ++p) {
      const PointingImage& image = *pointings_[p].image;
      const Tally& tally = tallies_[p];
      if (tally.empty) continue;
      const std::string from = !asked_noises_jy_.empty()       ? "--rms"
                               : image.residual_path().empty() ? "measured in it"
                                                               : "measured in " + image.residual_path();
      words += image.path() + ": primary beam " + pointings_[p].beam->origin() + "; noise " + tally.noise.text() + ", " + from;
      if (tally.smoothed > 0) words += ", once brought to the mosaic's beam";
      words += "\n";
    }
    words += o_.output + ".image: " + size_text() + " of " + angle_text(header_.geometry.cell_rad, 6) + " about " +
             sexagesimal(header_.geometry.phase_centre) + " (" + header_.geometry.phase_centre.frame + "), beam " +
             beam_text(beams_.front()) + (beams_.size() > 1 ? " in its first plane" : "") + "; noise from " +
             with_prefix(least_noise_jy_, "Jy/beam", 3) + " on\n";
    return {true, {}, words};
  }

  std::string size_text() const {
    return std::to_string(header_.geometry.width) + " × " + std::to_string(header_.geometry.height) + " pixels";
  }

  std::uint64_t total() const {
    return pointings_.size() * static_cast<std::uint64_t>(header_.spectral.channels) * header_.stokes.size();
  }

  const MosaicOptions& o_;
  const CommandCall& call_;
  int threads_;
  std::vector<double> asked_noises_jy_;  ///< [image]; empty where they are measured
  ProgressLine progress_;
  std::vector<Pointing> pointings_;
  std::unique_ptr<NameLock> lock_;
  imager::ImageHeader header_;
  std::vector<imager::GridMap> maps_;  ///< [image], from the mosaic's pixels to its own
  std::vector<double> turns_rad_;      ///< [image], see north_turn_rad()
  std::map<std::string, std::unique_ptr<imager::ImageWriter>> files_;
  std::vector<Tally> tallies_;            ///< [image]
  std::set<std::string> doubts_;          ///< that were said
  std::set<std::size_t> doubted_noises_;  ///< images whose noises were doubted
  std::vector<imager::Beam> beams_;       ///< of planes with values
  std::uint64_t done_ = 0;
  double least_noise_jy_ = 0;
};

}  // namespace

void run_mosaic(const MosaicOptions& options, const CommandCall& call) {
  check(options);
  MosaicRun(options, call).run();
}

}  // namespace misfit::tools
