// Regions of CASA and DS9, as --mask reads them, for an image of one plane and for one of several.
#include <cmath>

#include "tests/fuzz/fuzzing.h"
#include "tools/formats/regions/region_text.h"

using namespace misfit;
using namespace misfit::fuzz;

namespace {

imager::ImageHeader image(int channels) {
  constexpr double degree = M_PI / 180;
  imager::ImageHeader header;
  header.geometry = {16, 12, degree / 3600, {187.7 * degree, 12.39 * degree, "FK5"}};
  if (channels > 1) header.stokes = {imager::Stokes::I, imager::Stokes::Q};
  header.spectral = {1.42e9, -1e6, channels, "LSRK", channels > 1 ? 1.420405752e9 : 0};
  return header;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string name = "regions.crtf";
  for (const int channels : {1, 5}) {
    const imager::ImageHeader of = image(channels);
    const auto regions = read_or_refused(name, [&] {
      return tools::RegionText(name, {reinterpret_cast<const char*>(data), size}, of);
    });
    for (int channel = 0; regions && channel < channels; ++channel) {
      const imager::Image mask = regions->mask({channel, 0});
      require(mask.pixel.size() == of.geometry.pixels(), "a mask has the image's pixels");
      if (regions->one_for_all_channels())
        require(mask.pixel == regions->mask({0, 0}).pixel, "a mask for all channels is the same in each");
      if (regions->one_for_all_stokes() && channels > 1)
        require(mask.pixel == regions->mask({channel, 1}).pixel, "a mask for all Stokes parameters is the same in each");
    }
  }
  return 0;
}
