#include "tools/formats/clean_state_file.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "imager/clean/deconvolver.h"
#include "tools/base/files.h"
#include "tools/base/json_text.h"
#include "tools/base/option_checks.h"
#include "tools/base/text.h"

namespace misfit::tools {
namespace {

using nlohmann::json;

constexpr const char* format = "misfit CLEAN state 3";

/// The text in one line.
std::string escaped(const std::string& text) {
  const std::string quoted = json_text(json(text));
  return quoted.substr(1, quoted.size() - 2);
}

std::string shown(const json& value) {
  return value.is_null() ? "nothing" : value.is_string() ? "'" + escaped(value) + "'" : json_text(value);
}

/// The bytes of values as they lie in memory, little-endian where this runs.
template <typename T>
json packed(const std::vector<T>& values) {
  static_assert(std::is_trivially_copyable_v<T> && std::endian::native == std::endian::little);
  std::vector<std::uint8_t> bytes(values.size() * sizeof(T));
  if (!values.empty()) std::memcpy(bytes.data(), values.data(), bytes.size());
  return json::binary(std::move(bytes));
}

template <typename T>
std::vector<T> unpacked(const json& value) {
  const auto& bytes = value.get_binary();
  if (bytes.size() % sizeof(T) != 0) throw std::invalid_argument("an array is cut short");
  std::vector<T> values(bytes.size() / sizeof(T));
  if (!values.empty()) std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

/// A member that is a whole number of `least` or more.
template <typename T>
T whole(const json& object, const char* name, T least = 0) {
  const json& value = object.at(name);
  if (!value.is_number_integer() || value < least || value > std::numeric_limits<T>::max())
    throw std::invalid_argument(std::string(name) + " is " + shown(value) + ", expected a whole number from " +
                                std::to_string(least) + " on");
  return value;
}

/// Throws unless a part of a file has as many pixels as the image.
void check_pixels(const json& value, const imager::ComponentModel& like) {
  const auto size = [](int width, int height) { return std::to_string(width) + " × " + std::to_string(height) + " pixels"; };
  const int width = whole<int>(value, "width"), height = whole<int>(value, "height");
  if (width != like.width() || height != like.height())
    throw std::invalid_argument("it is of " + size(width, height) + ", expected " + size(like.width(), like.height()));
}

json packed_model(const imager::ComponentModel& model) {
  std::vector<std::int32_t> place;
  std::vector<double> flux_jy, further_jy;
  for (const imager::Component& c : model.components()) {
    place.insert(place.end(), {c.scale, c.row, c.column});
    flux_jy.push_back(c.flux_jy);
    further_jy.insert(further_jy.end(), c.further_jy.begin(), c.further_jy.end());
  }
  json packed_model = {{"width", model.width()},
                       {"height", model.height()},
                       {"scale_pixels", model.scale_pixels()},
                       {"place", packed(place)},
                       {"flux_jy", packed(flux_jy)}};
  if (std::any_of(further_jy.begin(), further_jy.end(), [](double x) { return x != 0; }))
    packed_model["further_jy"] = packed(further_jy);
  return packed_model;
}

imager::ComponentModel unpacked_model(const json& value, const imager::ComponentModel& like) {
  check_pixels(value, like);
  if (value.at("scale_pixels") != json(like.scale_pixels())) throw std::invalid_argument("its model has other scales");
  const auto place = unpacked<std::int32_t>(value.at("place"));
  const auto flux_jy = unpacked<double>(value.at("flux_jy"));
  const auto further_jy = value.contains("further_jy") ? unpacked<double>(value.at("further_jy")) : std::vector<double>();
  constexpr std::size_t further = imager::most_taylor_terms - 1;
  if (place.size() != 3 * flux_jy.size() || (!further_jy.empty() && further_jy.size() != further * flux_jy.size()))
    throw std::invalid_argument("its components are incomplete");
  std::vector<imager::Component> components;
  for (std::size_t i = 0; i < flux_jy.size(); ++i) {
    components.push_back({place[3 * i], place[3 * i + 1], place[3 * i + 2], flux_jy[i]});
    for (std::size_t t = 0; !further_jy.empty() && t < further; ++t)
      components.back().further_jy[t] = further_jy[further * i + t];
  }
  imager::ComponentModel model(like.width(), like.height(), like.scale_pixels());
  model.add(components);
  return model;
}

/// The lengths of runs of 0 and 1 in turn, beginning with 0.
json packed_mask(const imager::Image& mask) {
  std::vector<std::uint64_t> runs;
  for (std::size_t i = 0; i < mask.pixel.size();) {
    const bool in = runs.size() % 2 == 1;
    const std::size_t first = i;
    while (i < mask.pixel.size() && (mask.pixel[i] != 0) == in) ++i;
    runs.push_back(i - first);
  }
  return {{"width", mask.width}, {"height", mask.height}, {"runs", packed(runs)}};
}

/// The mask; without pixels where none was made.
imager::Image unpacked_mask(const json& value, const imager::ComponentModel& like) {
  if (value.at("width") == 0 && value.at("height") == 0) return {};
  check_pixels(value, like);
  imager::Image mask(like.width(), like.height());
  std::size_t first = 0;
  double in = 0;
  for (const std::uint64_t run : unpacked<std::uint64_t>(value.at("runs"))) {
    if (run > mask.pixel.size() - first) throw std::invalid_argument("its mask is larger than the image");
    std::fill_n(mask.pixel.begin() + static_cast<std::ptrdiff_t>(first), run, in);
    first += run;
    in = 1 - in;
  }
  return mask;
}

json packed_extension(const imager::MaskExtension& m) {
  return {{"threshold_jy", m.threshold_jy},   {"by_sidelobes", m.by_sidelobes}, {"regions", m.regions},   {"pruned", m.pruned},
          {"grown_regions", m.grown_regions}, {"grown_pruned", m.grown_pruned}, {"negative", m.negative}, {"added", m.added}};
}

imager::MaskExtension unpacked_extension(const json& m) {
  imager::MaskExtension masked;
  masked.threshold_jy = m.at("threshold_jy");
  masked.by_sidelobes = m.at("by_sidelobes");
  masked.regions = whole<int>(m, "regions");
  masked.pruned = whole<int>(m, "pruned");
  masked.grown_regions = whole<int>(m, "grown_regions");
  masked.grown_pruned = whole<int>(m, "grown_pruned");
  masked.negative = whole<std::size_t>(m, "negative");
  masked.added = whole<std::size_t>(m, "added");
  return masked;
}

json packed_cycle(const imager::MajorCycle& c) {
  return {{"iterations", c.iterations},
          {"peak_residual_jy", c.peak_residual_jy},
          {"rms_jy", c.rms_jy},
          {"model_flux_jy", c.model_flux_jy},
          {"depth_jy", c.cycle_threshold_jy},
          {"ended", c.ended},
          {"mean_square_jy2", c.mean_square_jy2},
          {"accuracy", c.accuracy},
          {"from", c.from},
          {"peak_anywhere_jy", c.peak_anywhere_jy},
          {"mask_pixels", c.mask_pixels},
          {"masked", packed_extension(c.masked)}};
}

imager::MajorCycle unpacked_cycle(const json& c) {
  imager::MajorCycle cycle;
  cycle.iterations = whole<int>(c, "iterations");
  cycle.peak_residual_jy = c.at("peak_residual_jy");
  cycle.rms_jy = c.at("rms_jy");
  cycle.model_flux_jy = c.at("model_flux_jy");
  cycle.cycle_threshold_jy = c.at("depth_jy");
  cycle.ended = c.at("ended");
  cycle.mean_square_jy2 = c.at("mean_square_jy2");
  cycle.accuracy = c.value("accuracy", 0.0);
  cycle.from = whole<std::size_t>(c, "from");
  cycle.peak_anywhere_jy = c.at("peak_anywhere_jy");
  cycle.mask_pixels = whole<std::size_t>(c, "mask_pixels");
  cycle.masked = unpacked_extension(c.at("masked"));
  return cycle;
}

/// True if two values are equal, or the same numbers written differently.
bool means_the_same(const json& a, const json& b) {
  if (a == b) return true;
  if (!a.is_string() || !b.is_string()) return false;
  const auto one = finite_number(a.get<std::string>()), other = finite_number(b.get<std::string>());
  return one && other && *one == *other;
}

/// The components of `model` among the scales of `like`.
imager::ComponentModel with_scales_of(const imager::ComponentModel& like, const imager::ComponentModel& model,
                                      const std::string& path) {
  std::vector<imager::Component> components = model.components();
  for (imager::Component& component : components) {
    const double scale = model.scale_pixels()[static_cast<std::size_t>(component.scale)];
    const auto found = std::find(like.scale_pixels().begin(), like.scale_pixels().end(), scale);
    if (found == like.scale_pixels().end())
      throw std::runtime_error(path + " has components of scale " + typed(scale / imager::tclean_scale_width) +
                               ": expected this scale among --scales; without --restart CLEAN begins anew");
    component.scale = static_cast<int>(found - like.scale_pixels().begin());
  }
  imager::ComponentModel same(like.width(), like.height(), like.scale_pixels());
  same.add(components);
  return same;
}

/// Names of options whose values differ, or that only one of the two has.
std::vector<std::string> unlike(const json& then, const json& now) {
  std::vector<std::string> changed;
  json names = now;
  names.update(then);
  for (const auto& [name, value] : names.items())
    if (!means_the_same(then.value(name, json()), now.value(name, json()))) changed.push_back(name);
  return changed;
}

imager::CleanState unpacked_state(const json& file, const imager::ComponentModel& like) {
  imager::CleanState state;
  state.model = unpacked_model(file.at("model"), like);
  state.best_model = unpacked_model(file.at("best_model"), like);
  state.mask = {unpacked_mask(file.at("mask"), like), unpacked_mask(file.at("negative_mask"), like), file.at("final_mask")};
  for (const json& cycle : file.at("cycles")) state.cycles.push_back(unpacked_cycle(cycle));
  state.now = whole<std::size_t>(file, "now");
  state.best = whole<std::size_t>(file, "best");
  state.tightened = whole<int>(file, "tightened");
  state.found_nothing = file.at("found_nothing");
  state.exact_from = file.contains("exact_from") ? whole<std::size_t>(file, "exact_from") : 0;
  const auto is_beyond = [&](std::size_t cycle) { return cycle >= state.cycles.size(); };
  if (is_beyond(state.now) || is_beyond(state.best) || state.exact_from > state.cycles.size() ||
      std::any_of(state.cycles.begin(), state.cycles.end(), [&](const imager::MajorCycle& c) { return is_beyond(c.from); }))
    throw std::invalid_argument("it names major cycles that are not in it");
  return state;
}

/// Reads a file without keeping it, and ends where it is nested more deeply than a state is, since each level takes stack, or a
/// part has more elements than the file has bytes.
class Shape : public nlohmann::json_sax<json> {
 public:
  explicit Shape(std::size_t bytes) : bytes_(bytes) {}
  bool null() override { return true; }
  bool boolean(bool) override { return true; }
  bool number_integer(number_integer_t) override { return true; }
  bool number_unsigned(number_unsigned_t) override { return true; }
  bool number_float(number_float_t, const string_t&) override { return true; }
  bool string(string_t&) override { return true; }
  bool binary(binary_t&) override { return true; }
  bool key(string_t&) override { return true; }
  bool start_object(std::size_t elements) override { return begin(elements); }
  bool end_object() override { return --depth_ >= 0; }
  bool start_array(std::size_t elements) override { return begin(elements); }
  bool end_array() override { return --depth_ >= 0; }
  bool parse_error(std::size_t, const std::string&, const nlohmann::detail::exception&) override { return false; }

 private:
  bool begin(std::size_t elements) {
    constexpr int deepest = 8;
    constexpr auto unknown = static_cast<std::size_t>(-1);
    return ++depth_ <= deepest && (elements <= bytes_ || elements == unknown);
  }

  std::size_t bytes_;
  int depth_ = 0;
};

std::uint64_t fnv1a(std::string_view bytes) {
  std::uint64_t sum = 0xcbf29ce484222325;
  for (const char byte : bytes) sum = (sum ^ static_cast<unsigned char>(byte)) * 0x100000001b3;
  return sum;
}

/// The content of a file; nothing unless the checksum at its end is right.
json intact_content(std::string_view file) {
  std::uint64_t sum = 0;
  if (file.size() <= sizeof sum) return nullptr;
  const std::string_view content = file.substr(0, file.size() - sizeof sum);
  std::memcpy(&sum, file.data() + content.size(), sizeof sum);
  if (sum != fnv1a(content)) return nullptr;
  Shape shape(content.size());
  if (!json::sax_parse(content.begin(), content.end(), &shape, json::input_format_t::cbor)) return nullptr;
  return json::from_cbor(content.begin(), content.end(), true, false);
}

void require_same(const std::string& path, const json& file, const CleanStateOwner& owner) {
  const auto refuse = [&path](const std::string& what, const json& has, const json& own) {
    throw std::runtime_error(path + " was saved with " + what + " " + shown(has) + ", but this run has " + shown(own) +
                             "; expected " + what + " " + shown(has) + ", or no --restart to begin anew");
  };
  if (file.at("version") != owner.version) refuse("version", file.at("version"), owner.version);
  const json& has = file.at("options");
  for (const std::string& name : unlike(has, owner.options))
    refuse("--" + escaped(name), has.value(name, json()), owner.options.value(name, json()));
  const int ranks = file.contains("ranks") ? whole<int>(file, "ranks") : 1;
  if (ranks != owner.ranks) refuse("mpirun -n", ranks, owner.ranks);
  if (file.at("checksum") != owner.checksum)
    throw std::runtime_error(path + " was saved with other data: the dirty image, the PSF or the start model differ; " +
                             "expected the same visibilities, flags and weights, and the same files");
}

}  // namespace

std::uint64_t checksum(const std::vector<const imager::Image*>& images) {
  std::uint64_t sum = 0xcbf29ce484222325;  // FNV-1a, eight bytes at a time
  for (const imager::Image* image : images) {
    if (image == nullptr) continue;
    for (const double pixel : image->pixel) {
      sum ^= std::bit_cast<std::uint64_t>(pixel);
      sum *= 0x100000001b3;
      sum ^= sum >> 32;
    }
  }
  return sum;
}

void write_clean_state(const std::string& path, const imager::CleanState& state, const CleanStateOwner& owner) {
  json file = {{"format", format},
               {"version", owner.version},
               {"options", owner.options},
               {"checksum", owner.checksum},
               {"ways", owner.ways},
               {"ways_checksum", owner.ways_checksum},
               {"ranks", owner.ranks},
               {"model", packed_model(state.model)},
               {"best_model", packed_model(state.best_model)},
               {"mask", packed_mask(state.mask.allowed)},
               {"negative_mask", packed_mask(state.mask.negative)},
               {"final_mask", state.mask.final},
               {"cycles", json::array()},
               {"now", state.now},
               {"exact_from", state.exact_from},
               {"best", state.best},
               {"tightened", state.tightened},
               {"found_nothing", state.found_nothing}};
  for (const imager::MajorCycle& cycle : state.cycles) file["cycles"].push_back(packed_cycle(cycle));
  const std::vector<std::uint8_t> bytes = json::to_cbor(file);
  std::string content(bytes.begin(), bytes.end());
  const std::uint64_t sum = fnv1a(content);
  content.append(reinterpret_cast<const char*>(&sum), sizeof sum);
  write_file(path, content);
}

ReadCleanState read_clean_state(const std::string& path, const CleanStateOwner& owner) {
  const json file = intact_content(read_file(path));
  if (!file.is_object() || file.value("format", json()) != format)
    throw std::runtime_error(path + " is damaged or no state of CLEAN; expected what an earlier run of misfit image saved");
  const auto damaged = [&path](const std::exception& error) {
    throw std::runtime_error(path + " is damaged: " + error.what() + "; without --restart CLEAN begins anew");
  };
  try {
    require_same(path, file, owner);
    ReadCleanState read;
    read.changed = unlike(file.at("ways"), owner.ways);
    if (read.changed.empty() && file.at("ways_checksum") != owner.ways_checksum) read.changed = {"mask"};
    const auto scales = file.at("model").at("scale_pixels").get<std::vector<double>>();
    read.state = unpacked_state(file, imager::ComponentModel(owner.like.width(), owner.like.height(), scales));
    if (read.changed.empty() && scales != owner.like.scale_pixels()) throw std::invalid_argument("its model has other scales");
    if (read.changed.empty()) return read;
    const int iterations = read.state.cycles[read.state.now].iterations;
    read.state = imager::first_state(with_scales_of(owner.like, read.state.model, path));
    read.state.iterations = iterations;
    return read;
  } catch (const json::exception& error) {
    damaged(error);
  } catch (const std::invalid_argument& error) {
    damaged(error);
  }
  return {};
}

}  // namespace misfit::tools
