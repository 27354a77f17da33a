// CASA region text, as --mask reads it, for an image of one plane and for one of several.
#include <cmath>

#include "tests/fuzz/fuzzing.h"
#include "tools/formats/region_text.h"

using namespace misfit;
using namespace misfit::fuzz;

namespace {

imager::ImageHeader image(int channels) {
  constexpr double degree = M_PI / 180;
  imager::ImageHeader header;
  header.geometry = {16, 12, degree / 3600, {187.7 * degree, 12.39 * degree, "FK5"}};
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
      const imager::Image mask = regions->mask(channel);
      require(mask.pixel.size() == of.geometry.pixels(), "a mask has the image's pixels");
      if (regions->one_for_all_channels())
        require(mask.pixel == regions->mask(0).pixel, "a mask for all planes is the same in each");
    }
  }
  return 0;
}
