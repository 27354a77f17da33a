// Values of options that are parsed without data: quantities, Stokes parameters, frames, numbers, lists.
#include <cmath>

#include "imager/data/stokes.h"
#include "ms_io/spectral_frame.h"
#include "tests/fuzz/fuzzing.h"
#include "tools/base/quantity.h"
#include "tools/base/text.h"
#include "tools/formats/regions/spectral_range.h"
#include "tools/run/beam_choice.h"
#include "tools/run/clean_options.h"
#include "tools/run/cube_options.h"
#include "tools/run/gridding_options.h"
#include "tools/run/image_options.h"
#include "tools/run/weighting_options.h"

using namespace misfit;
using namespace misfit::fuzz;

namespace {

void require_quantities(const std::string& text) {
  for (const auto parse : {tools::parse_angle_rad, tools::parse_flux_jy, tools::parse_frequency_hz, tools::parse_velocity_m_s,
                           tools::parse_uv_distance_lambda})
    if (const auto value = read_or_refused(text, [&] { return parse(text); }))
      require(std::isfinite(*value), "a quantity is finite");
}

/// Options that have a value of their own kind.
void require_options(const std::string& text) {
  tools::ImageOptions options;
  if (const auto beam = read_or_refused(text, [&] { return tools::restoring_beam(text); }); beam && beam->given)
    require(beam->given->minor_rad > 0 && beam->given->major_rad >= beam->given->minor_rad &&
                std::isfinite(beam->given->position_angle_rad),
            "a beam is an ellipse");
  for (std::string tools::TypedWeighting::*option : {&tools::TypedWeighting::uvtaper, &tools::TypedWeighting::maxuv_l}) {
    options.weighting = {};
    options.weighting.*option = text;
    if (read_or_refused(text, [&] { return tools::check(options.weighting, options.cube), true; }))
      tools::weighting_options(options.weighting);
  }
  for (std::string tools::CubeOptions::*option : {&tools::CubeOptions::start, &tools::CubeOptions::chanwidth,
                                                  &tools::CubeOptions::restfreq, &tools::CubeOptions::outframe}) {
    tools::CubeOptions cube;
    cube.specmode = "cube";
    cube.*option = text;
    read_or_refused(text, [&] { return tools::check(cube), true; });
  }
}

void require_planes(const tools::regions::RegionKeywords& keywords) {
  const imager::SpectralAxis axis{1.42e9, 1e6, 5, "LSRK", 1.420405752e9};
  if (const auto planes = read_or_refused("", [&] { return tools::regions::planes_of_range(keywords, axis); }))
    require(planes->first >= 0 && planes->last < axis.channels, "planes are those of the image");
  const std::vector<imager::Stokes> stokes{imager::Stokes::I, imager::Stokes::Q};
  if (const auto named = read_or_refused("", [&] { return tools::regions::stokes_of_corr(keywords, stokes); }))
    require(named->size() == stokes.size(), "each Stokes parameter is of a region or not");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  for (const char c : text)
    if (static_cast<unsigned char>(c) < ' ' || c == '\x7f') return 0;  // a shell's word may have it, and is shown
  require_quantities(text);
  require_options(text);
  if (const auto stokes = read_or_refused(text, [&] { return imager::parse_stokes(text); }))
    require(imager::parse_stokes(imager::stokes_names(*stokes)) == *stokes, "names of Stokes parameters are read again");
  read_or_refused(text, [&] { return ms_io::parse_spectral_frame(text); });
  if (const auto number = tools::finite_number(text)) require(std::isfinite(*number), "a finite number is one");
  if (const auto keywords = read_or_refused("", [&] { return tools::regions::parse_region_keywords(text); }))
    require_planes(*keywords);
  return 0;
}
