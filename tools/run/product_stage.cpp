#include "tools/run/product_stage.h"

#include <algorithm>
#include <string_view>

#include "imager/beams/primary_beam.h"
#include "tools/base/files.h"
#include "tools/formats/component_list.h"
#include "tools/run/image_files.h"
#include "tools/run/left_over.h"

namespace misfit::tools {
namespace {

/// A list of one, which an initializer cannot be moved into.
std::vector<imager::Image> alone(imager::Image image) {
  std::vector<imager::Image> list;
  list.push_back(std::move(image));
  return list;
}

std::vector<const imager::Image*> pointers_to(const std::vector<imager::Image>& images) {
  std::vector<const imager::Image*> pointers;
  for (const imager::Image& image : images) pointers.push_back(&image);
  return pointers;
}

}  // namespace

std::unique_ptr<NameLock> claim_product_paths(const ImageOptions& o) {
  check_writable_folder(o.imagename);
  for (const std::string& kind : image_kinds()) check_image_paths(o.imagename + "." + kind, o.outformat);
  auto lock = std::make_unique<NameLock>(o.imagename);
  remove_half_written(o);
  return lock;
}

ProductStage::ProductStage(const ImageOptions& options, ProductScene scene, imager::StageTimes& times)
    : o_(options), scene_(std::move(scene)), times_(times), products_(o_, scene_.geometry, scene_.observation) {
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
  std::vector<std::string> removed =
      remove_kinds(o_, {"model.png", "image.png", "dirty.png", "alpha.png", "components.csv", "clean.state"});
  if (o_.pbcor && taylor_ != nullptr)
    add_corrected_terms(pointers_to(taylor_->principal_solution(images.dirty.front())), nullptr);
  if (o_.pbcor && taylor_ == nullptr) add_corrected(images.dirty);
  add_primary_beam();
  add("psf", "Jy/beam", alone(std::move(images.psf)));
  add("residual", "Jy/beam", std::move(images.dirty));
  if (taylor_ != nullptr) {
    add_further("psf", taylor_->images().psf);
    add_further("residual", taylor_->images().dirty);
  }
  remove_other_images(o_, products_.paths(), removed);
  remove_cube_states(o_, 0, removed);
  remove_other_stokes(removed);
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
      pictures.push_back({"alpha", "Spectral index as seen", "", Shades::about_zero, &restored_.spectra.alpha, nullptr, mask});
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
  add("psf", "Jy/beam", alone(std::move(psf)));
  add("model", "Jy/pixel", std::move(models));
  add("residual", "Jy/beam", std::move(residuals));
  const std::vector<std::string> paths = image_paths(o_.imagename + ".mask", o_.outformat);
  const bool kept = std::any_of(paths.begin(), paths.end(), [&](const std::string& path) { return is_input(o_, path); });
  if (masked && !kept) products_.add("mask", "", std::move(masks));
  if (o_.pbcor && taylor_ != nullptr) {
    std::vector<const imager::Image*> terms = pointers_to(restored_.further);
    terms.insert(terms.begin(), &images.front());
    add_corrected_terms(terms, &restored_.spectra);
  }
  if (o_.pbcor && taylor_ == nullptr) add_corrected(images);
  add_primary_beam();
  add("image", "Jy/beam", std::move(images));
  if (taylor_ != nullptr) add_taylor(cleaned.front());
  std::vector<std::string> removed = remove_kinds(o_, {taylor_ != nullptr ? "components.csv" : "alpha.png"});
  remove_other_images(o_, products_.paths(), removed);
  remove_cube_states(o_, 0, removed);
  remove_other_stokes(removed);
  products_.write();
  return removed;
}

void ProductStage::add_primary_beam() {
  for (std::size_t t = 0; t < primary_beam_.size(); ++t) add("pb", "", alone(std::move(primary_beam_[t])), static_cast<int>(t));
}

void ProductStage::add_corrected(const std::vector<imager::Image>& images) {
  std::vector<imager::Image> quotients;
  for (const imager::Image& image : images) quotients.push_back(imager::corrected(image, primary_beam_.front()));
  products_.add("image.pbcor", "Jy/beam", std::move(quotients));
}

void ProductStage::add_corrected_terms(const std::vector<const imager::Image*>& apparent,
                                       const imager::SpectralImages* spectra) {
  std::vector<imager::Image> sky = taylor_beam_->corrected(apparent);
  if (spectra != nullptr) {
    imager::SpectralImages of_sky = imager::spectral_images_of_sky(sky, *spectra, scene_.threads);
    add_spectra(of_sky, ".pbcor", true);
  }
  for (std::size_t t = 0; t < sky.size(); ++t) add("image", "Jy/beam", alone(std::move(sky[t])), static_cast<int>(t), ".pbcor");
}

void ProductStage::add(const std::string& kind, const std::string& unit, std::vector<imager::Image> images, int term,
                       const std::string& end) {
  if (taylor_ == nullptr) return products_.add(kind + end, unit, std::move(images));
  products_.set_taylor_term({term, o_.nterms});
  products_.add(kind + ".tt" + std::to_string(term) + end, unit, std::move(images));
  products_.set_taylor_term({});
}

void ProductStage::add_further(const std::string& kind, std::vector<imager::Image>& images) {
  for (std::size_t t = 0; t < images.size(); ++t)
    add(kind, kind == "model" ? "Jy/pixel" : "Jy/beam", alone(std::move(images[t])), static_cast<int>(t) + 1);
}

void ProductStage::add_taylor(imager::CleanResult& cleaned) {
  add_further("psf", taylor_->images().psf);
  add_further("residual", cleaned.further_residuals);
  std::vector<imager::Image> models = o_.savemodel == "none" ? std::move(cleaned.further_models) : cleaned.further_models;
  add_further("model", models);
  add_further("image", restored_.further);
  add_spectra(restored_.spectra, "", false);
}

void ProductStage::add_spectra(imager::SpectralImages& spectra, const std::string& end, bool corrected) {
  std::vector<imager::HeaderCard> cards = scene_.cards;
  cards.push_back({"ALPHALIM", spectra.level_jy, "Jy/beam of .image.tt0, below which pixels are NaN"});
  cards.push_back(corrected ? imager::HeaderCard{"PBCOR", 1, "the primary beam's spectrum is divided out"}
                            : imager::HeaderCard{"PBCOR", 0, "the primary beam's spectrum is still in it"});
  products_.set_cards(std::move(cards));
  products_.set_quantity("Spectral Index");  // of curvature, too, for which casacore has no name of its own
  products_.add("alpha" + end, "", alone(std::move(spectra.alpha)));
  if (!spectra.alpha_error.pixel.empty()) products_.add("alpha.error" + end, "", alone(std::move(spectra.alpha_error)));
  if (!spectra.beta.pixel.empty()) products_.add("beta" + end, "", alone(std::move(spectra.beta)));
  products_.set_quantity(imager::ImageHeader().quantity);
  products_.set_cards(scene_.cards);
}

void ProductStage::write_components(const std::vector<imager::CleanResult>& cleaned) const {
  std::vector<SourcesOf> found;
  for (std::size_t s = 0; s < cleaned.size(); ++s) found.push_back({scene_.stokes[s], sources(cleaned[s].components)});
  const bool stands = scene_.observation.moving_at.empty();
  write_stokes_components(o_.imagename + ".components.csv", found,
                          stands ? std::optional(scene_.geometry.phase_centre) : std::nullopt);
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
  return imager::restored({cleaned.model, cleaned.residual}, *scene_.restoring_beam, scene_.geometry.cell_rad, scene_.threads);
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
  const std::vector<std::string> others = remove_kinds(o_, kinds);
  removed.insert(removed.end(), others.begin(), others.end());
}

}  // namespace misfit::tools
