#include "tools/run/image_products.h"

#include <algorithm>
#include <cmath>

namespace misfit::tools {

std::vector<imager::HeaderCard> error_cards(const RunReport& report) {
  std::vector<imager::HeaderCard> cards;
  if (report.accuracy != 0) cards.push_back({"ERRASKED", report.accuracy, "accuracy asked: RMS error over image RMS"});
  const auto add_largest = [&](const char* keyword, const auto& of, const char* comment) {
    double largest = 0;
    for (const PlaneReport& plane : report.planes)
      for (const StokesReport& stokes : plane.stokes) largest = std::max(largest, of(stokes));
    cards.push_back({keyword, largest, comment});
  };
  const PlaneReport& first = report.planes.front();
  if (first.stokes.front().theory) {
    add_largest(
        "ERREXPEC", [](const auto& s) { return s.theory->expected_rms; }, "expected RMS error over image RMS");
    add_largest(
        "ERRBOUND", [](const auto& s) { return s.theory->bound_rms; }, "bound on it, whatever the data");
    add_largest(
        "ERRBMAX", [](const auto& s) { return s.theory->bound_max; }, "bound on any pixel's error over image RMS");
  }
  if (first.stokes.front().measured) {
    add_largest(
        "ERRMEAS", [](const auto& s) { return s.measured->rms; }, "measured RMS error over image RMS");
    add_largest(
        "ERRMMAX", [](const auto& s) { return s.measured->max; }, "largest measured error over image RMS");
  }
  if (first.measured_predict_rms) cards.push_back({"ERRPRED", *first.measured_predict_rms, "measured RMS error of prediction"});
  if (first.predicted_noise_jy != 0)
    cards.push_back({"NOISPRED", first.predicted_noise_jy, "Jy/beam, noise predicted from the weights"});
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

void ImageProducts::add(const std::string& name, const std::string& unit, std::vector<imager::Image> images) {
  files_.push_back({imagename_ + "." + name + ".fits", {}});
  for (std::size_t i = 0; i < images.size(); ++i) {
    imager::SkyImage& plane = files_.back().planes.emplace_back(common_);
    plane.stokes = stokes_[i];
    plane.unit = unit;
    plane.image = std::move(images[i]);
  }
}

void ImageProducts::write() const {
  for (const File& file : files_) imager::write_fits(file.planes, file.path, format_);
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
