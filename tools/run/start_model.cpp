#include "tools/run/start_model.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "imager/data/stokes.h"
#include "tools/base/numbers.h"
#include "tools/formats/grid_offset.h"
#include "tools/formats/image_file.h"
#include "tools/formats/model_image.h"
#include "tools/run/taylor_options.h"

namespace misfit::tools {
namespace {

[[noreturn]] void refuse(const std::string& name, const std::string& has, const std::string& expected) {
  throw std::runtime_error(name + " " + has + ", expected " + expected);
}

}  // namespace

StartModel::StartModel(const ImageOptions& options, const imager::ImageHeader& image) : o_(options), image_(image) {
  for (const std::string& path : o_.clean.startmodel) files_.push_back({path, "start model " + path, open_image_file(path)});
  for (const File& file : files_)
    if (file.reader->header().flat_noise && !o_.makes_mosaic())
      refuse(file.name, std::string("is the sky times a mosaic's primary beam, as its ") + imager::flat_noise_key + " says",
             "a model of what is imaged, or --gridder mosaic");
  if (files_.size() == 1) refuse_taylor_term(*files_.front().reader, files_.front().path);
  for (std::size_t term = 0; files_.size() > 1 && term < files_.size(); ++term)
    require_taylor_term(*files_[term].reader, files_[term].name, static_cast<int>(term),
                        taylor_expansion(o_.taylor, image_.observation));
}

std::vector<std::string> StartModel::remarks() const {
  std::vector<std::string> remarks;
  for (const File& file : files_) {
    remarks.push_back(band_warning(file.reader->header().observation, image_.observation, file.path));
    remarks.push_back(GridBeside(*file.reader, file.name, image_).remark());
  }
  return remarks;
}

std::vector<imager::Image> StartModel::planes_of(const File& file, int channel) const {
  require_same_pixels(*file.reader, file.name, image_);  // about which its residual is exact
  const int of_file = channel_for(*file.reader, file.name, image_.spectral, channel);
  std::vector<imager::SkyImage> planes = read_model_channel(*file.reader, {file.path, of_file});
  if (file.reader->header().flat_noise) divide_by_sensitivity(planes, {file.path, of_file});
  std::vector<imager::Image> images;
  for (const imager::Stokes wanted : image_.stokes) {
    const auto found = std::find_if(planes.begin(), planes.end(), [&](const auto& plane) { return plane.stokes == wanted; });
    if (found == planes.end())
      refuse(file.name, "has no plane of " + stokes_name(wanted), "one of each in --stokes " + o_.stokes);
    images.push_back(std::move(found->image));
  }
  return images;
}

void StartModel::read(int channel) {
  images_.clear();
  for (const File& file : files_) images_.push_back(planes_of(file, channel));
}

std::vector<const imager::Image*> StartModel::images(std::size_t stokes) const {
  std::vector<const imager::Image*> images;
  for (const auto& term : images_) images.push_back(&term[stokes]);
  return images;
}

void StartModel::see_through(const imager::MosaicView& view, std::size_t stokes) {
  for (auto& term : images_) {
    imager::Image& image = term[stokes];
    for (std::size_t i = 0; i < image.pixel.size(); ++i) {
      const double beam = view.primary_beam->pixel[i];
      if (std::isnan(beam)) image.pixel[i] = 0;
      if (view.flat_noise && image.pixel[i] != 0) image.pixel[i] *= beam;
    }
  }
}

std::vector<imager::Component> StartModel::take(std::size_t stokes) {
  std::vector<imager::Component> components = imager::components_of(images(stokes));
  for (auto& term : images_) term[stokes] = {};
  return components;
}

}  // namespace misfit::tools
