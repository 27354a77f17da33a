#include "tools/run/taken_files.h"

#include <CLI/CLI.hpp>
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

namespace {

/// Throws where a pixel above the horizon has no value.
void require_values(const imager::Image& image, const imager::ImageGeometry& geometry, const std::string& path) {
  for (int row = 0; row < image.height; ++row)
    for (int column = 0; column < image.width; ++column)
      if (!std::isfinite(image.at(row, column)) && !beyond_horizon(geometry.at(row, column)))
        throw std::runtime_error(path + " has no value at pixel " + std::to_string(column) + ", " + std::to_string(row) +
                                 "; expected one wherever samples are imaged");
}

std::unique_ptr<imager::ImageReader> opened(const std::string& path, imager::Grids grids = imager::Grids::upright) {
  return open_image_file(path, grids, ms_io::Masks::ignored);
}

}  // namespace

void declare(CLI::App& command, TypedTaken& o) {
  const auto flag = [](CLI::Option* option) {
    option->default_str("true")->check(CLI::IsMember({"true", "false"}, CLI::ignore_case));
    mark(option, OptionMark::not_repeated);  // the run puts others in their places
  };
  flag(command.add_option("--calcpsf", o.calcpsf,
                          "false: take <imagename>.psf instead of making it. Some of its pixels are checked against direct "
                          "sums of the samples and weights, and may differ by a hundredth of the PSF's RMS"));
  flag(command.add_option(
      "--calcres", o.calcres,
      "false: take <imagename>.residual, the dirty image or, with --startmodel, that model's residual, instead of making it. "
      "Some of its pixels are checked as for --calcpsf. No state is kept for --restart"));
}

void check_taken(const ImageOptions& o) {
  if (o.taken.calcres) return;
  if (o.clean.restart) refuse_option("calcres", "false", "true beside --restart, which makes the residual of its state");
  if (o.verify > 0 && !o.clean.startmodel.empty())
    refuse_option("calcres", "false", "true beside --verify, as the residual of a model is not that of the data");
}

TakenFiles::TakenFiles(const ImageOptions& options, const imager::ImageHeader& image) : o_(options), image_(image) {
  const int terms = o_.taylor.nterms;
  for (int k = 0; !o_.taken.calcpsf && k < 2 * terms - 1; ++k) psf_.push_back(find("psf", k, "calcpsf"));
  for (int t = 0; !o_.taken.calcres && t < terms; ++t) residual_.push_back(find("residual", t, "calcres"));
  const std::optional<std::string> sumwt = newest_image(o_.imagename + "." + product_name("sumwt", {0, terms}));
  if (sumwt && is_own_image(*sumwt)) sumwt_ = *sumwt;  // others may count weights otherwise
}

std::string TakenFiles::find(const std::string& kind, int order, const char* option) const {
  const imager::TaylorTerm term{order, o_.taylor.nterms};
  const std::string name = o_.imagename + "." + product_name(kind, term);
  const std::optional<std::string> path = newest_image(name);
  if (!path) throw std::runtime_error(name + " does not exist; expected this image, or --" + option + " true");
  const auto file = opened(*path);
  if (kind == "residual" && file->header().unit != "Jy/beam")
    throw std::runtime_error(*path + " is in '" + file->header().unit + "', expected Jy/beam");
  if (term.several()) require_taylor_term(*file, *path, order, taylor_expansion(o_.taylor, image_.observation));
  require_same_pixels(*file, *path, image_);
  return *path;
}

imager::Plan TakenFiles::decisions() const {
  imager::Plan decisions;
  const auto add = [&](const char* what, const std::vector<std::string>& paths, const std::string& because) {
    if (!paths.empty())
      decisions.push_back({what, "taken from " + names_of(paths), because + "; pixels are compared with direct sums"});
  };
  add("PSF", psf_, "--calcpsf false");
  add("residual", residual_, "--calcres false, and no state of CLEAN is kept, as --restart would need the dirty image");
  return decisions;
}

/// Reads the planes of these Stokes parameters, whose values must all be there.
std::vector<imager::Image> TakenFiles::planes(const std::string& path, int channel,
                                              const std::vector<imager::Stokes>& stokes) const {
  const auto file = opened(path);
  const int of_file = channel_for(*file, path, image_.spectral, channel);
  std::vector<imager::Image> images;
  for (const imager::Stokes one : stokes) {
    const std::optional<int> plane = imager::plane_of(file->header().stokes, one);
    if (!plane) throw std::runtime_error(path + " has no plane of " + stokes_name(one) + ", which --stokes asks for");
    images.push_back(file->read({of_file, *plane}));
    require_values(images.back(), image_.geometry, path);
  }
  return images;
}

TakenPlanes TakenFiles::read(int channel) const {
  const std::lock_guard lock(image_files_mutex());
  TakenPlanes taken;
  for (const std::string& path : psf_)
    taken.psf.push_back(std::move(planes(path, channel, {opened(path)->header().stokes.front()}).front()));
  for (const std::string& path : residual_) taken.residual.push_back(planes(path, channel, image_.stokes));
  return taken;
}

void TakenFiles::require_weights(int channel, const std::vector<imager::SampleSums>& sums) const {
  if (sumwt_.empty()) return;
  const std::lock_guard lock(image_files_mutex());
  constexpr double rounding = 1e-5;  // of single precision, and of sums in another order
  const auto file = opened(sumwt_, imager::Grids::any);
  const int of_file = channel_for(*file, sumwt_, image_.spectral, channel);
  for (std::size_t s = 0; s < sums.size(); ++s) {
    const std::optional<int> plane = imager::plane_of(file->header().stokes, image_.stokes[s]);
    if (!plane) continue;
    const double has = file->read({of_file, *plane}).pixel.front(), expected = sumwt_of(sums[s]);
    if (!(std::abs(has / expected - 1) < rounding))
      throw std::runtime_error(sumwt_ + " is " + significant(has, 8) + ", but the weights of these samples sum to " +
                               significant(expected, 8) + "; expected the same selection and weighting, or no such file");
  }
}

void TakenFiles::refuse(const imager::UnlikeSamples& unlike) const {
  const imager::ImageKind& kind = unlike.kind;
  const std::string of = !kind.psf && image_.stokes.size() > 1 ? " of " + stokes_name(image_.stokes[kind.stokes]) : "";
  const std::string model = o_.clean.startmodel.empty() ? "" : ", and the start model";
  throw std::runtime_error((kind.psf ? psf_ : residual_).at(static_cast<std::size_t>(kind.order)) + of + " " + unlike.what() +
                           "; expected the " +
                           (kind.psf ? "PSF of the same selection and weighting, or --calcpsf true"
                                     : "residual of the same data, selection and weighting" + model + ", or --calcres true"));
}

}  // namespace misfit::tools
