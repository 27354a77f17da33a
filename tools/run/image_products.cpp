#include "tools/run/image_products.h"

#include <algorithm>
#include <cmath>

#include "tools/run/image_files.h"

namespace misfit::tools {

std::vector<imager::HeaderCard> error_cards(const RunReport& report) {
  std::vector<imager::HeaderCard> cards;
  if (report.accuracy != 0) cards.push_back({"ERRASKED", report.accuracy, "accuracy asked: RMS error over image RMS"});
  // Of all planes and Stokes parameters; planes without samples have none.
  const auto add_largest = [&](const char* keyword, const auto& part, const auto& number, const char* comment) {
    double largest = -1;
    for (const PlaneReport& plane : report.planes)
      for (const StokesReport& stokes : plane.stokes)
        if (const auto& has = stokes.*part) largest = std::max(largest, (*has).*number);
    if (largest >= 0) cards.push_back({keyword, largest, comment});
  };
  using Theory = imager::TheoreticalError;
  using Measured = imager::PixelError;
  add_largest("ERREXPEC", &StokesReport::theory, &Theory::expected_rms, "expected RMS error over image RMS");
  add_largest("ERRBOUND", &StokesReport::theory, &Theory::bound_rms, "bound on it, whatever the data");
  add_largest("ERRBMAX", &StokesReport::theory, &Theory::bound_max, "bound on any pixel's error over image RMS");
  add_largest("ERRMEAS", &StokesReport::measured, &Measured::rms, "measured RMS error over image RMS");
  add_largest("ERRMMAX", &StokesReport::measured, &Measured::max, "largest measured error over image RMS");
  double predicted = -1;
  for (const PlaneReport& plane : report.planes) predicted = std::max(predicted, plane.measured_predict_rms.value_or(-1));
  if (predicted >= 0) cards.push_back({"ERRPRED", predicted, "measured RMS error of prediction"});
  if (!report.cube && report.planes.front().predicted_noise_jy != 0)
    cards.push_back({"NOISPRED", report.planes.front().predicted_noise_jy, "Jy/beam, noise predicted from the weights"});
  // An image of zeros has no relative error, and a FITS header no number for that.
  std::erase_if(cards, [](const imager::HeaderCard& card) { return !std::isfinite(card.value); });
  return cards;
}

ImageProducts::ImageProducts(const ImageOptions& options, const imager::ImageGeometry& geometry,
                             const imager::Observation& observation)
    : imagename_(options.imagename), outformat_(options.outformat), format_(pixel_format(options.accuracy)) {
  header_.geometry = geometry;
  header_.observation = observation;
  header_.spectral = imager::whole_band(observation);
}

void ImageProducts::add(const std::string& name, const std::string& unit, std::vector<imager::Image> images) {
  imager::ImageHeader header = header_;
  header.unit = unit;
  header.stokes.resize(images.size());
  files_.push_back({imagename_ + "." + name, std::move(header), std::move(images)});
}

void ImageProducts::write() const {
  for (const File& file : files_) {
    const auto writer = open_image_files(file.name, file.header, format_, outformat_);
    for (std::size_t s = 0; s < file.planes.size(); ++s) writer->write({0, static_cast<int>(s)}, file.planes[s], beam_);
    writer->finish();
  }
}

std::vector<std::string> ImageProducts::paths() const {
  std::vector<std::string> paths;
  for (const File& file : files_)
    for (const std::string& path : image_paths(file.name, outformat_)) paths.push_back(path);
  return paths;
}

void ImageProducts::draw(const std::vector<ProductPicture>& pictures) {
  imager::SkyImage about;
  about.geometry = header_.geometry;
  about.observation = header_.observation;
  about.has_beam = beam_.has_value();
  about.beam = beam_.value_or(imager::Beam{});
  std::vector<imager::SkyImage> each(pictures.size(), about);
  std::vector<Picture> wanted;
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    const ProductPicture& picture = pictures[i];
    const std::string path = imagename_ + "." + picture.name + ".png";
    each[i].unit = picture.unit;
    titles_and_paths_.emplace_back(picture.title, path);
    wanted.push_back({&each[i], picture.title, path, picture.shades, picture.image, picture.sketch, picture.mask});
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
