#include "tools/formats/regions/region_text.h"

#include <algorithm>
#include <array>
#include <memory>
#include <stdexcept>

#include "tools/base/numbers.h"
#include "tools/base/text.h"
#include "tools/formats/regions/crtf.h"
#include "tools/formats/regions/ds9.h"
#include "tools/formats/regions/ds9_properties.h"
#include "tools/formats/regions/words.h"

namespace misfit::tools {
namespace {

/// Takes a line off the beginning of `text`, ended as on any system.
std::string_view take_line(std::string_view& text) {
  const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
  const std::string_view line = trimmed(text.substr(0, end));
  text.remove_prefix(std::min(end + (text.substr(end).starts_with("\r\n") ? 2 : 1), text.size()));
  return line;
}

bool is_ds9(std::string_view text) {
  while (!text.empty()) {
    const std::string_view line = take_line(text);
    if (line.starts_with("#CRTF")) return false;
    if (line.starts_with("# Region file format: DS9")) return true;
    if (line.empty() || line.starts_with('#')) continue;
    const bool alone = regions::ds9_statements(line).size() == 1;  // semicolons part statements of DS9's alone
    if (alone && regions::small_letters(line).starts_with("global")) continue;
    return line.substr(0, line.find('#')).find('[') == std::string_view::npos;
  }
  return false;
}

std::string lines_of(const std::string& path, const std::vector<int>& lines) {
  return path + (lines.front() == lines.back() ? ", line " : ", lines ") + in_runs(lines) + ": ";
}

}  // namespace

RegionText::RegionText(const std::string& path, std::string_view text, const imager::ImageHeader& image)
    : width_(image.geometry.width), height_(image.geometry.height), channels_(image.spectral.channels) {
  if (text.find('\0') != std::string_view::npos)
    throw std::runtime_error(path + " is neither a FITS image, a CASA image nor region text");
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);  // the mark that some editors begin UTF-8 with
  const bool ds9 = is_ds9(text);
  std::unique_ptr<regions::RegionReader> reader;
  if (ds9)
    reader = std::make_unique<regions::Ds9Reader>(image);
  else
    reader = std::make_unique<regions::CrtfReader>(image);
  read_lines(path, text, *reader);
  if (regions_.empty())
    throw std::runtime_error(
        path + " holds no region with an area; expected CASA region text such as circle [[100pix, 80pix], 20pix], or " +
        "regions of DS9 such as image; circle(101, 81, 20)");
  if (ds9) std::stable_partition(regions_.begin(), regions_.end(), [](const regions::Region& r) { return r.added; });
  look_for_pixels(path, image.stokes);
  for (const auto& [shape, lines] : passed_over_)
    doubts_.push_back(lines_of(path, lines) + "a " + shape + " holds no pixel and is passed over");
}

void RegionText::read_lines(const std::string& path, std::string_view text, regions::RegionReader& reader) {
  for (int line = 1; !text.empty(); ++line) {
    try {
      const std::string_view content = take_line(text);
      if (const std::string control = control_character_of(content); !control.empty())
        throw std::runtime_error("it has " + control + ", expected text");
      regions::RegionLine found = reader.read(content);
      for (regions::Region& region : found.regions) {
        region.line = line;
        regions_.push_back(std::move(region));
      }
      for (const std::string& shape : found.passed_over) passed_over_[shape].push_back(line);
    } catch (const std::exception& error) {
      throw std::runtime_error(lines_of(path, {line}) + error.what());
    }
  }
}

void RegionText::look_for_pixels(const std::string& path, const std::vector<imager::Stokes>& stokes) {
  if (std::none_of(regions_.begin(), regions_.end(), [](const regions::Region& r) { return r.of_planes(); }))
    throw std::runtime_error(lines_of(path, {regions_.front().line}) + "found '" + regions_.front().planes +
                             "', expected planes of the image, corr of " + stokes_names(stokes) + " and range within its " +
                             std::to_string(channels_) + (channels_ == 1 ? " channel" : " channels") +
                             ": no region of the file is of any");
  for (const regions::Region& region : regions_) {
    bool pixels = false;
    regions::for_each_pixel(region.shape, width_, height_, [&](int, int) { pixels = true; });
    if (!region.of_planes())
      doubts_.push_back(lines_of(path, {region.line}) + "the region of " + region.planes + " is of no plane of the image");
    if (region.of_planes() && region.channels.beyond)
      doubts_.push_back(lines_of(path, {region.line}) + "the region of " + region.planes +
                        " names channels beyond the image's last, " + std::to_string(channels_ - 1) + "chan");
    if (pixels) continue;
    const regions::Point centre = regions::centre_of(region.shape);
    doubts_.push_back(lines_of(path, {region.line}) + "the region holds the centre of no pixel of the image, " +
                      std::to_string(width_) + " × " + std::to_string(height_) + " pixels: its own is at column " +
                      significant(centre.column, 6) + ", row " + significant(centre.row, 6));
  }
}

bool RegionText::one_for_all_channels() const {
  return std::all_of(regions_.begin(), regions_.end(),
                     [&](const regions::Region& r) { return r.channels.first == 0 && r.channels.last == channels_ - 1; });
}

bool RegionText::one_for_all_stokes() const {
  return std::all_of(regions_.begin(), regions_.end(), [](const regions::Region& r) {
    return std::find(r.stokes.begin(), r.stokes.end(), false) == r.stokes.end();
  });
}

imager::Image RegionText::mask(const imager::PlaneIndex& at) const {
  imager::Image mask(width_, height_);
  if (!regions_.front().added) std::fill(mask.pixel.begin(), mask.pixel.end(), 1);
  for (const regions::Region& region : regions_) {
    if (!region.holds(at.channel, static_cast<std::size_t>(at.stokes))) continue;
    regions::for_each_pixel(region.shape, width_, height_,
                            [&](int row, int column) { mask.at(row, column) = region.added ? 1 : 0; });
  }
  return mask;
}

bool begins_regions(std::string_view text) {
  constexpr std::array<std::string_view, 18> shapes{
      "box",     "rectangularbox", "centerbox", "rotbox", "rotatedbox", "poly",   "polygon", "circle", "annulus",
      "ellipse", "panda",          "cpanda",    "epanda", "bpanda",     "symbol", "point",   "line",   "vector"};
  text = trimmed(text);
  if (text.starts_with("#CRTF") || text.starts_with("# Region file format")) return true;
  if (text.starts_with('-') || text.starts_with('+')) text.remove_prefix(1);
  const std::string word = regions::small_letters(regions::take_word(text));
  if (text.starts_with('[') || text.starts_with('(')) return std::find(shapes.begin(), shapes.end(), word) != shapes.end();
  if (word == "global") return text.find(';') != std::string_view::npos;
  return text.starts_with(';') && regions::is_ds9_frame(word);
}

}  // namespace misfit::tools
