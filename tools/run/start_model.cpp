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
  if (files_.size() == 1) refuse_taylor_term(*files_.front().reader, files_.front().path);
  for (std::size_t term = 0; files_.size() > 1 && term < files_.size(); ++term)
    require_term(files_[term], static_cast<int>(term));
}

/// Of as many as the run has, about the same frequency.
void StartModel::require_term(const File& file, int term) const {
  require_taylor_term(*file.reader, file.path, {term, o_.taylor.nterms});
  constexpr double rounding = 1e-9;
  const double own_hz = taylor_expansion(o_.taylor, image_.observation).reference_hz;
  const double hz = file.reader->header().observation.frequency_hz;
  if (!(std::abs(hz / own_hz - 1) < rounding))
    refuse(file.name, "has spectra about " + frequency_text(hz, 10),
           "spectra about " + frequency_text(own_hz, 10) + ", or --reffreq " + significant(hz / 1e9, 12) + "GHz");
}

std::vector<std::string> StartModel::remarks() const {
  std::vector<std::string> remarks;
  for (const File& file : files_) {
    remarks.push_back(band_warning(file.reader->header().observation, image_.observation, file.path));
    remarks.push_back(GridBeside(*file.reader, file.name, image_).remark());
  }
  return remarks;
}

void StartModel::require_same_pixels(const File& file) const {
  const imager::ImageGeometry &own = image_.geometry, &g = file.reader->header().geometry;
  const auto size = [](int width, int height) { return std::to_string(width) + " × " + std::to_string(height) + " pixels"; };
  if (g.width != own.width || g.height != own.height)
    refuse(file.name, "has " + size(g.width, g.height), size(own.width, own.height));
  const GridBeside beside(*file.reader, file.name, image_);
  const GridOffset offset = offset_between(beside.map(), own);
  // A start is put on the image's own pixels, about which its residual is then exact.
  if (!offset.any || offset.right != 0 || offset.up != 0 || !(offset.most < imager::same_place_pixels))
    refuse(file.name, "has other pixels, " + described(beside.grid()),
           "the image's, " + described(imager::grid_of(own)) + "; regrid it first, as with CASA's imregrid");
}

std::vector<imager::Image> StartModel::planes_of(const File& file, int channel) const {
  require_same_pixels(file);
  const int of_file = channel_for(*file.reader, file.name, image_.spectral, channel);
  std::vector<imager::SkyImage> planes = read_model_channel(*file.reader, {file.path, of_file});
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

std::vector<imager::Component> StartModel::take(std::size_t stokes) {
  std::vector<imager::Component> components = imager::components_of(images(stokes));
  for (auto& term : images_) term[stokes] = {};
  return components;
}

}  // namespace misfit::tools
