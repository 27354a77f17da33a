// Which images a run leaves with --products tclean, and what is masked in them.
#include <cmath>
#include <numeric>

#include "ms_io/casa_image.h"
#include "tests/tools/program.h"

BOOST_AUTO_TEST_SUITE(products_command)

namespace {

using namespace misfit;
using namespace misfit::tools::testing;
namespace fs = std::filesystem;

/// A field as wide as the dishes' beam.
const std::string& wide_set() {
  static const TemporaryFolder folder;
  static const std::string path = [] {
    const std::string made = folder / "wide.ms";
    succeed({"simulate", "--output", made, "--array", "vla-d", "--cell", "20arcsec", "--frequency", "1.4GHz", "--channels", "2",
             "--channel-width", "50MHz", "--noise", "10mJy", "--quiet"});
    return made;
  }();
  return path;
}

Arguments all_products(const std::string& name, const Arguments& options) {
  return Arguments{"image",  "--vis",    wide_set(),   "--imagename", name,          "--imsize", "64",
                   "--cell", "30arcsec", "--products", "tclean",      "--outformat", "casa"} +
         options;
}

std::unique_ptr<imager::ImageReader> opened(const std::string& path, ms_io::Masks masks) {
  return ms_io::open_casa_image(path, imager::Grids::upright, masks);
}

/// Calls look(masked, pixels beneath, primary beam) for each plane of an image.
template <typename Look>
void look_at_planes(const std::string& image, const std::string& beam, const Look& look) {
  const auto masked = opened(image, ms_io::Masks::applied), whole = opened(image, ms_io::Masks::ignored),
             pb = opened(beam, ms_io::Masks::applied);
  const imager::ImageHeader& header = masked->header();
  for (int channel = 0; channel < header.spectral.channels; ++channel)
    for (int stokes = 0; stokes < static_cast<int>(header.stokes.size()); ++stokes)
      look(masked->read({channel, stokes}), whole->read({channel, stokes}), pb->read({channel, 0}));
}

std::size_t valueless(const imager::Image& image) {
  return static_cast<std::size_t>(
      std::count_if(image.pixel.begin(), image.pixel.end(), [](double pixel) { return std::isnan(pixel); }));
}

}  // namespace

/// As in tclean: masks say where the primary beam is below a positive limit, and the pixels stay.
BOOST_AUTO_TEST_CASE(a_limit_above_0_masks_casa_images_and_keeps_their_pixels) {
  const std::pair<Arguments, std::string> runs[] = {
      {{"--niter", "5"}, ""},
      {{"--niter", "5", "--nterms", "2"}, ".tt0"},
      {{"--specmode", "cube", "--niter", "5", "--stokes", "XXYY", "--restoringbeam", "common"}, ""},
      {{"--specmode", "cube"}, ""}};
  for (const auto& [options, end] : runs) {
    const TemporaryFolder folder;
    const std::string name = folder / "a", other = folder / "b", beam = name + ".pb" + end;
    succeed(all_products(name, options + Arguments{"--pblimit", "0.3"}));
    succeed(all_products(other, options + Arguments{"--pblimit", "-0.3"}));
    for (const std::string kind : {".residual", ".image"}) {
      BOOST_TEST_INFO(kind << end);
      look_at_planes(name + kind + end, beam,
                     [](const imager::Image& masked, const imager::Image& whole, const imager::Image& pb) {
                       BOOST_TEST(valueless(whole) == 0U);
                       const std::size_t beyond = valueless(pb);
                       BOOST_TEST((beyond > 0 && beyond < pb.pixel.size()));
                       bool same = true;
                       for (std::size_t i = 0; i < pb.pixel.size(); ++i)
                         same = same && std::isnan(pb.pixel[i]) == std::isnan(masked.pixel[i]) &&
                                (std::isnan(masked.pixel[i]) || masked.pixel[i] == whole.pixel[i]);
                       BOOST_TEST(same);
                     });
      const auto one = opened(name + kind + end, ms_io::Masks::ignored),
                 two = opened(other + kind + end, ms_io::Masks::applied);
      BOOST_TEST((one->read({0, 0}).pixel == two->read({0, 0}).pixel));
    }
    BOOST_TEST(valueless(opened(other + ".pb" + end, ms_io::Masks::applied)->read({0, 0})) > 0U);
  }
}

BOOST_AUTO_TEST_CASE(a_dirty_image_is_its_residual_with_a_beam) {
  const TemporaryFolder folder;
  succeed(all_products(folder / "a", {}));
  const auto image = opened(folder / "a.image", ms_io::Masks::applied),
             residual = opened(folder / "a.residual", ms_io::Masks::applied);
  BOOST_TEST((image->read({0, 0}).pixel == residual->read({0, 0}).pixel));
  BOOST_TEST(image->beam({0, 0}).has_value());
  BOOST_TEST(!std::filesystem::exists(folder / "a.model"));
}

BOOST_AUTO_TEST_CASE(a_mask_of_ones_says_that_clean_may_go_everywhere_and_changes_nothing) {
  const TemporaryFolder folder;
  succeed(all_products(folder / "a", {"--niter", "20"}));
  for (const double pixel : opened(folder / "a.mask", ms_io::Masks::applied)->read({0, 0}).pixel)
    BOOST_TEST_REQUIRE(pixel == 1);
  succeed(all_products(folder / "b", {"--niter", "20", "--mask", folder / "a.mask"}));
  const auto image = [&](const char* name) { return opened(folder / name, ms_io::Masks::applied)->read({0, 0}).pixel; };
  BOOST_TEST((image("a.image") == image("b.image")));
}

BOOST_AUTO_TEST_CASE(several_masks_allow_what_any_of_them_does) {
  const TemporaryFolder folder;
  const auto mask = [&](const Arguments& masks) {
    succeed(all_products(folder / "a", Arguments{"--niter", "5", "--mask"} + masks));
    const imager::Image made = opened(folder / "a.mask", ms_io::Masks::applied)->read({0, 0});
    fs::copy(folder / "a.mask", folder / std::to_string(masks.size()) + ".mask", fs::copy_options::recursive);
    return made;
  };
  const std::string circle = "circle [[20pix, 20pix], 6pix]", box = "box [[30pix, 10pix], [50pix, 30pix]]";
  const imager::Image one = mask({circle}), both = mask({circle, box}), three = mask({folder / "1.mask", box, circle});
  const auto allowed = [](const imager::Image& image) { return std::accumulate(image.pixel.begin(), image.pixel.end(), 0.0); };
  BOOST_TEST(allowed(both) == allowed(one) + 21 * 21);
  BOOST_TEST((three.pixel == both.pixel));
  // The file of options says so again.
  fs::rename(folder / "a.last.ini", folder / "a.ini");
  succeed({"image", "--config", folder / "a.ini", "--imagename", folder / "again"});
  BOOST_TEST((opened(folder / "again.mask", ms_io::Masks::applied)->read({0, 0}).pixel == both.pixel));
}

/// --pbmask limits every mask, of each plane by its own beam.
BOOST_AUTO_TEST_CASE(clean_keeps_to_where_the_primary_beam_is) {
  const TemporaryFolder folder;
  const auto plane = [&](const std::string& kind, int channel) {
    return opened(folder / ("a." + kind), ms_io::Masks::ignored)->read({channel, 0});
  };
  for (const Arguments& mask :
       {Arguments{"--usemask", "pb"},
        Arguments{"--usemask", "auto", "--sidelobethreshold", "0.5", "--noisethreshold", "3", "--minbeamfrac", "0"},
        Arguments{"--mask", "box [[0pix, 0pix], [40pix, 63pix]]"}}) {
    succeed(all_products(folder / "a",
                         mask + Arguments{"--pbmask", "0.5", "--pblimit", "0.3", "--niter", "30", "--specmode", "cube"}));
    std::vector<double> allowed;
    for (const int channel : {0, 1}) {
      const imager::Image made = plane("mask", channel), model = plane("model", channel), beam = plane("pb", channel);
      bool within = true, all = true;
      for (std::size_t i = 0; i < made.pixel.size(); ++i) {
        const bool is = made.pixel[i] != 0, may = beam.pixel[i] >= 0.5;
        const bool asked = mask.front() != "--mask" || static_cast<int>(i) % made.width <= 40;
        within = within && (!is || may) && (model.pixel[i] == 0 || is);
        all = all && is == (may && asked);
      }
      BOOST_TEST(within);
      BOOST_TEST((all || mask[1] == "auto"));
      allowed.push_back(std::accumulate(made.pixel.begin(), made.pixel.end(), 0.0));
    }
    BOOST_TEST(allowed[0] > 0);
    if (mask[1] == "pb") BOOST_TEST(allowed[0] > allowed[1]);  // beams narrow with frequency
  }
}

BOOST_AUTO_TEST_SUITE_END()
