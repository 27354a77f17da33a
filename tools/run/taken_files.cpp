#include "tools/run/taken_files.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <mutex>
#include <stdexcept>

#include "imager/data/stokes.h"
#include "tools/base/numbers.h"
#include "tools/base/option_checks.h"
#include "tools/formats/grid_offset.h"
#include "tools/formats/image_file.h"
#include "tools/formats/model_image.h"
#include "tools/run/image_files.h"
#include "tools/run/image_options.h"
#include "tools/run/product_kinds.h"

namespace misfit::tools {

void declare(CLI::App& command, TypedTaken& o) {
  command
      .add_option(
          "--calcpsf", o.calcpsf,
          "false: take <imagename>.psf, which must be that of these samples and weights, to 1e-3 of its peak, instead of "
          "making it")
      ->check(values_are({"true", "false"}));
  command
      .add_option(
          "--calcres", o.calcres,
          "false: take <imagename>.residual, which must be that of these samples to 1e-2 of its RMS; or with --startmodel "
          "what that model leaves, which where w counts is believed until the next major cycle")
      ->check(values_are({"true", "false"}));
}

void check_taken(const ImageOptions& o) {
  if (!o.taken.any()) return;
  const char* const option = o.taken.calcpsf ? "calcres" : "calcpsf";
  if (o.clean.restart) refuse_option(option, "false", "true beside --restart, which makes its images from its state");
  if (o.verify > 0 && !o.taken.calcres && !o.clean.startmodel.empty())
    refuse_option("calcres", "false", "true beside --verify, as the residual of a model is not that of the data");
}

namespace {

std::size_t index_of(const std::vector<imager::Stokes>& all, imager::Stokes wanted, const std::string& path) {
  const auto found = std::find(all.begin(), all.end(), wanted);
  if (found == all.end())
    throw std::runtime_error(path + " has no plane of " + stokes_name(wanted) + ", which --stokes asks for");
  return static_cast<std::size_t>(found - all.begin());
}

/// Throws where a pixel above the horizon has no value.
void require_values(const imager::Image& image, const imager::ImageGeometry& geometry, const std::string& path) {
  for (int row = 0; row < image.height; ++row)
    for (int column = 0; column < image.width; ++column)
      if (!std::isfinite(image.at(row, column)) && !beyond_horizon(geometry.at(row, column)))
        throw std::runtime_error(path + " has no value at pixel " + std::to_string(column) + ", " + std::to_string(row) +
                                 "; expected one wherever samples are imaged");
}

}  // namespace

TakenFiles::TakenFiles(const ImageOptions& options, const imager::ImageHeader& image) : o_(options), image_(image) {
  const int terms = o_.taylor.nterms;
  for (int k = 0; !o_.taken.calcpsf && k < 2 * terms - 1; ++k) psf_.push_back(open("psf", k, "calcpsf"));
  for (int t = 0; !o_.taken.calcres && t < terms; ++t) residual_.push_back(open("residual", t, "calcres"));
  const std::optional<std::string> sumwt = newest_image(o_.imagename + "." + product_name("sumwt", {0, terms}));
  if (sumwt && is_own_image(*sumwt))  // others may count weights otherwise
    sumwt_ = File{*sumwt, open_image_file(*sumwt, imager::Grids::any, ms_io::Masks::ignored)};
}

TakenFiles::File TakenFiles::open(const std::string& kind, int order, const char* option) const {
  const imager::TaylorTerm term{order, o_.taylor.nterms};
  const std::string name = o_.imagename + "." + product_name(kind, term);
  const std::optional<std::string> path = newest_image(name);
  if (!path) throw std::runtime_error(name + " is not there; expected it, or --" + option + " true");
  File file{*path, open_image_file(*path, imager::Grids::upright, ms_io::Masks::ignored)};
  if (term.several()) require_taylor_term(*file.reader, *path, order, taylor_expansion(o_.taylor, image_.observation));
  require_same_pixels(*file.reader, *path, image_);
  return file;
}

imager::Plan TakenFiles::decisions() const {
  imager::Plan decisions;
  const auto add = [&](const char* what, const std::vector<File>& files, const char* option, const char* checked) {
    std::string names;
    for (const File& file : files) names += (names.empty() ? "" : ", ") + file.path;
    if (!files.empty()) decisions.push_back({what, "taken from " + names, std::string("--") + option + " false; " + checked});
  };
  add("PSF", psf_, "calcpsf", "its middle is compared with direct sums");
  add("residual", residual_, "calcres",
      o_.clean.startmodel.empty() ? "its middle is compared with direct sums"
                                  : "its middle is compared with what the start model leaves, but where w counts");
  return decisions;
}

/// Of a channel of the image.
imager::Image TakenFiles::read(const File& file, int channel, std::size_t stokes) const {
  const int of_file = channel_for(*file.reader, file.path, image_.spectral, channel);
  const std::lock_guard lock(image_files_mutex());
  return file.reader->read({of_file, static_cast<int>(stokes)});
}

/// Whose values are all there.
imager::Image TakenFiles::read_whole(const File& file, int channel, std::size_t stokes) const {
  imager::Image image = read(file, channel, stokes);
  require_values(image, image_.geometry, file.path);
  return image;
}

imager::TakenImages TakenFiles::read(int channel, bool images_here) const {
  imager::TakenImages taken;
  taken.of_model = !o_.clean.startmodel.empty();
  if (!psf_.empty()) taken.psf = images_here ? read_whole(psf_.front(), channel, 0) : imager::Image();
  if (residual_.empty()) return taken;
  taken.dirty.emplace();
  const File& file = residual_.front();
  for (const imager::Stokes stokes : image_.stokes)
    taken.dirty->push_back(images_here ? read_whole(file, channel, index_of(file.reader->header().stokes, stokes, file.path))
                                       : imager::Image());
  return taken;
}

std::optional<std::vector<imager::Image>> TakenFiles::further(const std::vector<File>& files) const {
  if (files.empty()) return std::nullopt;
  std::vector<imager::Image> images;
  for (std::size_t t = 1; t < files.size(); ++t) images.push_back(read_whole(files[t], 0, 0));
  return images;
}

std::optional<std::vector<imager::Image>> TakenFiles::further_dirty() const {
  return further(residual_);
}

std::optional<std::vector<imager::Image>> TakenFiles::further_psf() const {
  return further(psf_);
}

void TakenFiles::refuse(const imager::UnlikeSamples& unlike) const {
  const std::string of = unlike.stokes && image_.stokes.size() > 1 ? " of " + stokes_name(image_.stokes[*unlike.stokes]) : "";
  const bool residual = unlike.stokes.has_value();
  throw std::runtime_error((residual ? residual_ : psf_).front().path + of + " " + unlike.what() + "; expected " +
                           (residual ? std::string("the residual of the same data, selection") +
                                           (o_.clean.startmodel.empty() ? " and weighting" : ", weighting and start model") +
                                           ", or --calcres true"
                                     : "the PSF of the same selection and weighting, or --calcpsf true"));
}

void TakenFiles::require_weights(int channel, const std::vector<imager::SampleSums>& sums) const {
  if (!sumwt_) return;
  constexpr double rounding = 1e-5;  // of single precision, and of sums in another order
  for (std::size_t s = 0; s < sums.size(); ++s) {
    const std::size_t stokes = index_of(sumwt_->reader->header().stokes, image_.stokes[s], sumwt_->path);
    const double has = read(*sumwt_, channel, stokes).pixel.front(), expected = sumwt_of(sums[s]);
    if (!(std::abs(has / expected - 1) < rounding))
      throw std::runtime_error(sumwt_->path + " is " + significant(has, 8) + ", where these samples weigh " +
                               significant(expected, 8) +
                               "; expected the same selection and weighting, or --calcpsf true and "
                               "--calcres true");
  }
}

}  // namespace misfit::tools
