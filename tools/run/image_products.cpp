#include "tools/run/image_products.h"

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
    cards.push_back({"ERRMEAS", report.measured->image.front().rms, "measured RMS error over image RMS"});
    cards.push_back({"ERRMMAX", report.measured->image.front().max, "largest measured error over image RMS"});
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

void ImageProducts::add(const std::string& name, const std::string& unit, imager::Image image) {
  files_.push_back({imagename_ + "." + name + ".fits", common_});
  files_.back().image.unit = unit;
  files_.back().image.image = std::move(image);
}

void ImageProducts::write() const {
  for (const File& file : files_) imager::write_fits(file.image, file.path, format_);
}

void ImageProducts::draw(const std::vector<ProductPicture>& pictures) {
  std::vector<imager::SkyImage> about(pictures.size(), common_);
  std::vector<Picture> wanted;
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    const ProductPicture& picture = pictures[i];
    const std::string path = imagename_ + "." + picture.name + ".png";
    about[i].unit = picture.unit;
    titles_and_paths_.emplace_back(picture.title, path);
    wanted.push_back({&about[i], picture.title, path, picture.shades, picture.image, picture.sketch, picture.mask});
  }
  drawing_.add(wanted);
}

void ImageProducts::draw(const imager::UvCoverage& coverage) {
  const std::string path = imagename_ + ".uv.png";
  titles_and_paths_.emplace_back("uv coverage", path);
  drawing_.add(coverage, path);
}

std::vector<std::pair<std::string, std::string>> ImageProducts::pictures() const {
  return {titles_and_paths_.rbegin(), titles_and_paths_.rend()};
}

}  // namespace misfit::tools
