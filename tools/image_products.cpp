#include "tools/image_products.h"

#include <algorithm>
#include <cmath>

namespace misfit::tools {

std::vector<imager::HeaderCard> error_cards(const RunReport& report) {
  std::vector<imager::HeaderCard> cards;
  if (report.accuracy != 0) cards.push_back({"ERRASKED", report.accuracy, "accuracy asked: RMS error over image RMS"});
  if (report.theory != nullptr) {
    cards.push_back({"ERREXPEC", report.theory->expected_rms, "expected RMS error over image RMS"});
    cards.push_back({"ERRBOUND", report.theory->bound_rms, "bound on it, whatever the data"});
    cards.push_back({"ERRBMAX", report.theory->bound_max, "bound on any pixel's error over image RMS"});
  }
  if (report.measured != nullptr) {
    cards.push_back({"ERRMEAS", report.measured->rms, "measured RMS error over image RMS"});
    cards.push_back({"ERRMMAX", report.measured->max, "largest measured error over image RMS"});
    cards.push_back({"ERRPRED", report.measured->predict_rms, "measured RMS error of prediction"});
  }
  // An image of zeros has no relative error, and a FITS header no number for that.
  std::erase_if(cards, [](const imager::HeaderCard& card) { return !std::isfinite(card.value); });
  return cards;
}

ImageProducts::ImageProducts(std::string imagename, const imager::ImageGeometry& geometry,
                             const imager::Observation& observation, double accuracy)
    : imagename_(std::move(imagename)),
      format_(accuracy != 0 && accuracy < 1e-7 ? imager::PixelFormat::float64 : imager::PixelFormat::float32) {
  common_.geometry = geometry;
  common_.observation = observation;
}

void ImageProducts::set_beam(const imager::Beam& beam) {
  common_.has_beam = true;
  common_.beam = beam;
}

void ImageProducts::add(const ProductKind& kind, imager::Image image) {
  products_.push_back({kind, common_, {}});
  products_.back().image.unit = kind.unit;
  products_.back().image.image = std::move(image);
}

void ImageProducts::add_picture(const ProductKind& kind, Sketch sketch) {
  add(kind, {});
  products_.back().sketch = std::move(sketch);
}

void ImageProducts::write() const {
  for (const Product& product : products_)
    if (!product.sketch) imager::write_fits(product.image, path(product, "fits"), format_);
}

std::vector<Picture> ImageProducts::pictures() const {
  const auto mask = std::find_if(products_.begin(), products_.end(), [](const Product& p) { return p.kind.name == "mask"; });
  std::vector<Picture> wanted;
  for (auto product = products_.rbegin(); product != products_.rend(); ++product) {
    if (product->kind.title.empty()) continue;
    wanted.push_back({.image = &product->image,
                      .title = product->kind.title,
                      .path = path(*product, "png"),
                      .shades = product->kind.shades,
                      .sketch = product->sketch ? &*product->sketch : nullptr,
                      .mask = mask != products_.end() && product->kind.name != "psf" ? &mask->image.image : nullptr});
  }
  return wanted;
}

}  // namespace misfit::tools
