#include "tools/run/product_stage.h"

#include <filesystem>

#include "tools/base/files.h"
#include "tools/formats/component_list.h"

namespace misfit::tools {

ProductStage::ProductStage(const ImageOptions& options, ProductScene scene, imager::StageTimes& times)
    : o_(options),
      scene_(std::move(scene)),
      times_(times),
      products_(o_.imagename, scene_.geometry, scene_.observation, o_.accuracy) {
  products_.set_history(scene_.history);
  products_.set_cards(scene_.cards);
  if (scene_.restoring_beam) products_.set_beam(*scene_.restoring_beam);
}

ProductPicture ProductStage::dirty_picture(const imager::Image* dirty, const imager::Image* mask) const {
  return {
      .name = "dirty", .title = "Dirty image", .image = dirty, .sketch = dirty == nullptr ? &dirty_ : nullptr, .mask = mask};
}

void ProductStage::draw_dirty(const imager::UvCoverage& coverage, const imager::DirtyImages& images,
                              const imager::Image* mask) {
  const imager::StageTimer timer(times_, "draw pictures");
  products_.draw(coverage);
  products_.draw({{.name = "psf", .title = "PSF", .image = &images.psf}});
  if (o_.niter == 0)
    products_.draw({{.name = "residual", .title = "Dirty image", .image = &images.dirty.front()}});
  else if (o_.usemask == "auto")
    dirty_ = sketch(images.dirty.front(), Shades::brightness, picture_side);
  else
    products_.draw({dirty_picture(&images.dirty.front(), mask)});
}

std::vector<std::string> ProductStage::write(imager::DirtyImages images) {
  const imager::StageTimer timer(times_, "write images");
  products_.add("psf", "Jy/beam", std::move(images.psf));
  products_.add("residual", "Jy/beam", std::move(images.dirty.front()));
  auto removed = remove_old(
      {"model.fits", "model.png", "image.fits", "image.png", "dirty.png", "mask.fits", "components.csv", "clean.state"});
  products_.write();
  return removed;
}

std::vector<std::string> ProductStage::write(imager::Image psf, imager::CleanResult& cleaned) {
  imager::Image image = restored(cleaned);
  const bool masked = !cleaned.mask.pixel.empty();
  {
    const imager::StageTimer timer(times_, "draw pictures");
    const imager::Image* const mask = masked ? &cleaned.mask : nullptr;
    std::vector<ProductPicture> pictures;
    if (o_.usemask == "auto") pictures.push_back(dirty_picture(nullptr, mask));
    pictures.push_back({"model", "Model", "Jy/pixel", Shades::about_zero, &cleaned.model, nullptr, mask});
    pictures.push_back({"residual", "Residual", "Jy/beam", Shades::about_zero, &cleaned.residual, nullptr, mask});
    pictures.push_back({"image", "Restored image", "Jy/beam", Shades::brightness, &image, nullptr, mask});
    products_.draw(pictures);
  }
  const imager::StageTimer timer(times_, "write images");
  products_.add("psf", "Jy/beam", std::move(psf));
  products_.add("model", "Jy/pixel", o_.savemodel == "none" ? std::move(cleaned.model) : cleaned.model);
  products_.add("residual", "Jy/beam", std::move(cleaned.residual));
  if (masked) products_.add("mask", "", std::move(cleaned.mask));
  products_.add("image", "Jy/beam", std::move(image));
  auto removed = masked ? std::vector<std::string>() : remove_old({"mask.fits"});
  products_.write();
  write_component_list(o_.imagename + ".components.csv", sources(cleaned.components), scene_.geometry.phase_centre);
  return removed;
}

std::string ProductStage::finish_pictures(std::vector<PagePicture>& drawn) {
  const imager::StageTimer timer(times_, "draw pictures");
  std::string failure = products_.finish_pictures();
  if (failure.empty())
    for (const auto& [title, path] : products_.pictures()) drawn.push_back({title, read_file(path)});
  return failure;
}

imager::Image ProductStage::restored(const imager::CleanResult& cleaned) const {
  const imager::StageTimer timer(times_, "restore");
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

/// What an earlier run of this name left and this one does not make.
std::vector<std::string> ProductStage::remove_old(const std::vector<std::string>& kinds) const {
  std::vector<std::string> removed;
  for (const std::string& kind : kinds) {
    const std::string path = o_.imagename + "." + kind;
    std::error_code failed;  // a folder of that name stays
    if (std::filesystem::remove(path, failed)) removed.push_back(path);
  }
  return removed;
}

}  // namespace misfit::tools
