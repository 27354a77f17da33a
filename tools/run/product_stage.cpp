#include "tools/run/product_stage.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string_view>

#include "tools/base/files.h"
#include "tools/formats/component_list.h"
#include "tools/run/taylor_options.h"

namespace misfit::tools {
namespace {

/// Whether a file of one of our names is ours: people keep masks and models of theirs under such names too.
bool is_ours(const std::string& path) {
  if (!path.ends_with(".fits")) return true;
  std::ifstream file(path, std::ios::binary);
  std::string header(16 * 2880, '\0');  // ORIGIN stands before the history
  file.read(header.data(), static_cast<std::streamsize>(header.size()));
  return header.find("ORIGIN  = 'misfit") != std::string::npos;
}

/// A list of one, which an initializer cannot be moved into.
std::vector<imager::Image> alone(imager::Image image) {
  std::vector<imager::Image> list;
  list.push_back(std::move(image));
  return list;
}

}  // namespace

ProductStage::ProductStage(const ImageOptions& options, ProductScene scene, imager::StageTimes& times)
    : o_(options),
      scene_(std::move(scene)),
      times_(times),
      products_(o_.imagename, scene_.geometry, scene_.observation, o_.accuracy) {
  products_.set_stokes(scene_.stokes);
  products_.set_history(scene_.history);
  products_.set_cards(scene_.cards);
  if (scene_.restoring_beam) products_.set_beam(*scene_.restoring_beam);
}

ProductPicture ProductStage::picture_of(std::size_t stokes, ProductPicture picture) const {
  if (scene_.stokes.size() == 1) return picture;
  const std::string name = imager::stokes_name(scene_.stokes[stokes]);
  picture.name += "." + name;
  picture.title += ", " + name;
  return picture;
}

void ProductStage::draw_dirty(const imager::UvCoverage& coverage, const imager::DirtyImages& images,
                              const std::function<const imager::Image*(std::size_t)>& mask_of) {
  const imager::StageTimer timer(times_, "draw pictures");
  products_.draw(coverage);
  products_.draw({{.name = "psf", .title = "PSF", .image = &images.psf}});
  std::vector<ProductPicture> pictures;
  dirty_.resize(images.dirty.size());
  for (std::size_t s = images.dirty.size(); s-- > 0;) {
    const imager::Image& dirty = images.dirty[s];
    if (o_.usemask == "auto")
      dirty_[s] = sketch(dirty, Shades::brightness, picture_side);
    else
      pictures.push_back(picture_of(
          s, {.name = o_.niter == 0 ? "residual" : "dirty", .title = "Dirty image", .image = &dirty, .mask = mask_of(s)}));
  }
  products_.draw(pictures);
}

std::vector<std::string> ProductStage::write(imager::DirtyImages images) {
  const imager::StageTimer timer(times_, "write images");
  products_.add(named("psf"), "Jy/beam", alone(std::move(images.psf)));
  products_.add(named("residual"), "Jy/beam", std::move(images.dirty));
  if (taylor_ != nullptr) {
    add_further("psf", taylor_->images().psf);
    add_further("residual", taylor_->images().dirty);
  }
  auto removed = remove_old(
      {"model.fits", "model.png", "image.fits", "image.png", "dirty.png", "mask.fits", "components.csv", "clean.state"});
  remove_other_stokes(removed);
  remove_other_terms(false, removed);
  products_.write();
  return removed;
}

void ProductStage::draw(std::vector<imager::CleanResult>& cleaned, const std::vector<imager::Image>& restored_images) {
  const imager::StageTimer timer(times_, "draw pictures");
  std::vector<ProductPicture> pictures;
  for (std::size_t s = cleaned.size(); s-- > 0;) {  // what comes last is shown first
    const imager::CleanResult& result = cleaned[s];
    const imager::Image* const mask = result.mask.pixel.empty() ? nullptr : &result.mask;
    if (o_.usemask == "auto")
      pictures.push_back(picture_of(s, {.name = "dirty", .title = "Dirty image", .sketch = &dirty_[s], .mask = mask}));
    pictures.push_back(picture_of(s, {"model", "Model", "Jy/pixel", Shades::about_zero, &result.model, nullptr, mask}));
    pictures.push_back(picture_of(s, {"residual", "Residual", "Jy/beam", Shades::about_zero, &result.residual, nullptr, mask}));
    pictures.push_back(
        picture_of(s, {"image", "Restored image", "Jy/beam", Shades::brightness, &restored_images[s], nullptr, mask}));
    if (taylor_ != nullptr)
      pictures.push_back({"alpha", "Spectral index", "", Shades::about_zero, &restored_.spectra.alpha, nullptr, mask});
  }
  products_.draw(pictures);
}

std::vector<std::string> ProductStage::write(imager::Image psf, std::vector<imager::CleanResult>& cleaned) {
  std::vector<imager::Image> images, models, residuals, masks;
  for (const imager::CleanResult& result : cleaned) images.push_back(restored(result));
  draw(cleaned, images);
  const imager::StageTimer timer(times_, "write images");
  if (taylor_ == nullptr) write_components(cleaned);
  for (imager::CleanResult& result : cleaned) {
    models.push_back(o_.savemodel == "none" ? std::move(result.model) : result.model);
    residuals.push_back(std::move(result.residual));
    if (!result.mask.pixel.empty()) masks.push_back(std::move(result.mask));
  }
  const bool masked = !masks.empty();
  products_.add(named("psf"), "Jy/beam", alone(std::move(psf)));
  products_.add(named("model"), "Jy/pixel", std::move(models));
  products_.add(named("residual"), "Jy/beam", std::move(residuals));
  std::error_code absent;
  const bool kept =
      std::filesystem::equivalent(o_.mask, o_.imagename + ".mask.fits", absent);  // the user's file stays as it is
  if (masked && !kept) products_.add("mask", "", std::move(masks));
  products_.add(named("image"), "Jy/beam", std::move(images));
  if (taylor_ != nullptr) add_taylor(cleaned.front());
  auto removed = masked ? std::vector<std::string>() : remove_old({"mask.fits"});
  remove_other_stokes(removed);
  remove_other_terms(true, removed);
  products_.write();
  return removed;
}

std::string ProductStage::named(const std::string& kind, int term) const {
  return taylor_ == nullptr ? kind : kind + ".tt" + std::to_string(term);
}

void ProductStage::add_further(const std::string& kind, std::vector<imager::Image>& images) {
  for (std::size_t t = 0; t < images.size(); ++t)
    products_.add(named(kind, static_cast<int>(t) + 1), kind == "model" ? "Jy/pixel" : "Jy/beam", alone(std::move(images[t])));
}

void ProductStage::add_taylor(imager::CleanResult& cleaned) {
  add_further("psf", taylor_->images().psf);
  add_further("residual", cleaned.further_residuals);
  std::vector<imager::Image> models = o_.savemodel == "none" ? std::move(cleaned.further_models) : cleaned.further_models;
  add_further("model", models);
  add_further("image", restored_.further);
  imager::SpectralImages& spectra = restored_.spectra;
  std::vector<imager::HeaderCard> cards = scene_.cards;
  cards.push_back({"ALPHALIM", spectra.level_jy, "Jy/beam of .image.tt0, below which pixels are NaN"});
  products_.set_cards(std::move(cards));
  products_.add("alpha", "", alone(std::move(spectra.alpha)));
  products_.add("alpha.error", "", alone(std::move(spectra.alpha_error)));
  if (!spectra.beta.pixel.empty()) products_.add("beta", "", alone(std::move(spectra.beta)));
  products_.set_cards(scene_.cards);
}

void ProductStage::remove_other_terms(bool cleaned, std::vector<std::string>& removed) const {
  const std::vector<std::string> made = taylor_products(o_.nterms, cleaned);
  std::vector<std::string> kinds;
  for (const std::string& name : taylor_products(imager::most_taylor_terms, true))
    if (std::count(made.begin(), made.end(), name) == 0) kinds.push_back(name + ".fits");
  if (std::count(made.begin(), made.end(), "alpha") == 0) kinds.emplace_back("alpha.png");
  if (taylor_ != nullptr)
    kinds.insert(kinds.end(), {"psf.fits", "residual.fits", "model.fits", "image.fits", "components.csv"});
  const std::vector<std::string> others = remove_old(kinds);
  removed.insert(removed.end(), others.begin(), others.end());
}

void ProductStage::write_components(const std::vector<imager::CleanResult>& cleaned) const {
  std::vector<SourcesOf> found;
  for (std::size_t s = 0; s < cleaned.size(); ++s) found.push_back({scene_.stokes[s], sources(cleaned[s].components)});
  write_stokes_components(o_.imagename + ".components.csv", found, scene_.geometry.phase_centre);
}

std::string ProductStage::finish_pictures(std::vector<PagePicture>& drawn) {
  const imager::StageTimer timer(times_, "draw pictures");
  std::string failure = products_.finish_pictures();
  if (failure.empty())
    for (const auto& [title, path] : products_.pictures()) drawn.push_back({title, read_file(path)});
  return failure;
}

imager::Image ProductStage::restored(const imager::CleanResult& cleaned) {
  const imager::StageTimer timer(times_, "restore");
  if (taylor_ != nullptr) {
    restored_ = taylor_->restore(cleaned, *scene_.restoring_beam, scene_.geometry.cell_rad);
    return std::move(restored_.first);
  }
  imager::Image sum =
      imager::convolve_with_beam(cleaned.model, *scene_.restoring_beam, scene_.geometry.cell_rad, scene_.threads);
  for (std::size_t i = 0; i < sum.pixel.size(); ++i) sum.pixel[i] += cleaned.residual.pixel[i];
  return sum;
}

/// What CLEAN found, on the sky.
std::vector<imager::Source> ProductStage::sources(const imager::ComponentModel& model) const {
  std::vector<imager::Source> sources;
  for (const imager::Component& c : model.components())
    sources.push_back({scene_.geometry.at(c.row, c.column), c.flux_jy,
                       model.scale_pixels()[static_cast<std::size_t>(c.scale)] * scene_.geometry.cell_rad});
  return sources;
}

/// Pictures and states of CLEAN that an earlier run of other Stokes parameters left.
void ProductStage::remove_other_stokes(std::vector<std::string>& removed) const {
  std::vector<std::string> kinds;
  for (int code = 1; imager::is_stokes_code(code); ++code) {
    const auto stokes = static_cast<imager::Stokes>(code);
    const bool made = scene_.stokes.size() > 1 && std::count(scene_.stokes.begin(), scene_.stokes.end(), stokes) > 0;
    for (const char* kind : {"dirty.S.png", "model.S.png", "residual.S.png", "image.S.png", "clean.S.state"})
      if (!made) kinds.push_back(std::string(kind).replace(std::string_view(kind).find('S'), 1, stokes_name(stokes)));
  }
  if (scene_.stokes.size() > 1)
    for (const char* kind : {"dirty.png", "model.png", "residual.png", "image.png", "clean.state"}) kinds.emplace_back(kind);
  const std::vector<std::string> others = remove_old(kinds);
  removed.insert(removed.end(), others.begin(), others.end());
}

/// What an earlier run of this name left and this one does not make.
std::vector<std::string> ProductStage::remove_old(const std::vector<std::string>& kinds) const {
  std::vector<std::string> removed;
  for (const std::string& kind : kinds) {
    const std::string path = o_.imagename + "." + kind;
    std::error_code failed;  // a folder of that name stays
    if (std::filesystem::equivalent(path, o_.startmodel, failed)) continue;
    if (is_ours(path) && std::filesystem::remove(path, failed)) removed.push_back(path);
  }
  return removed;
}

}  // namespace misfit::tools
