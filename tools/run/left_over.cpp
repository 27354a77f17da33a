#include "tools/run/left_over.h"

#include <algorithm>
#include <charconv>
#include <filesystem>

#include "imager/data/stokes.h"
#include "kernels/whole_file.h"
#include "tools/run/image_files.h"
#include "tools/run/product_kinds.h"

namespace misfit::tools {

namespace fs = std::filesystem;

namespace {

/// A name for each Stokes parameter: "dirty.Q.png" of "dirty" and ".png".
void add_stokes(const std::string& begin, const std::string& end, const std::vector<imager::Stokes>& stokes,
                std::vector<std::string>& names) {
  for (const imager::Stokes one : stokes) names.push_back(begin + "." + imager::stokes_name(one) + end);
}

/// Pictures, lists and states, as they follow <imagename>.
std::vector<std::string> all_names() {
  std::vector<imager::Stokes> stokes;
  for (int code = 1; imager::is_stokes_code(code); ++code) stokes.push_back(static_cast<imager::Stokes>(code));
  std::vector<std::string> names{"psf.png", "uv.png", "alpha.png", "components.csv", "clean.state"};
  for (const char* picture : {"dirty", "model", "residual", "image"}) {
    names.push_back(std::string(picture) + ".png");
    add_stokes(picture, ".png", stokes, names);
  }
  add_stokes("clean", ".state", stokes, names);
  return names;
}

/// The names of this run's files.
std::vector<std::string> own_names(const ImageOptions& o) {
  const bool cleaned = o.clean.runs();
  if (o.cube.is_cube()) return {"psf.png", cleaned ? "image.png" : "residual.png"};
  std::vector<std::string> names{"psf.png", "uv.png"};
  const std::vector<imager::Stokes> stokes = imager::parse_stokes(o.stokes);
  const auto add = [&](const std::string& begin, const std::string& end) {
    if (stokes.size() == 1)
      names.push_back(begin + end);
    else
      add_stokes(begin, end, stokes, names);
  };
  if (!cleaned) {
    add("residual", ".png");
    return names;
  }
  for (const char* picture : {"dirty", "model", "residual", "image"}) add(picture, ".png");
  add("clean", ".state");
  names.emplace_back(o.taylor.nterms > 1 ? "alpha.png" : "components.csv");
  return names;
}

/// The images of other kinds, or in another format; but nothing beside an input of the same name.
void remove_other_images(const ImageOptions& o, const std::vector<std::string>& made, std::vector<std::string>& removed) {
  std::vector<std::string> kinds = all_product_names();
  for (const char* of_mosaics : {"weight", "noise"}) kinds.emplace_back(of_mosaics);
  for (const std::string& kind : kinds) {
    const std::vector<std::string> paths = image_paths(o.imagename + "." + kind, "both");
    if (std::any_of(paths.begin(), paths.end(), [&](const std::string& path) { return is_input(o, path); })) continue;
    for (const std::string& path : paths) {
      std::error_code failed;
      if (std::count(made.begin(), made.end(), path) > 0 || !is_own_image(path)) continue;
      if (fs::remove_all(path, failed) > 0 && !failed) removed.push_back(path);
    }
  }
}

/// The states that CLEAN of a cube left of `first` and later channels.
void remove_cube_states(const ImageOptions& o, int first, std::vector<std::string>& removed) {
  std::error_code failed;
  const fs::path folder = o.imagename + ".clean";
  std::vector<fs::path> states;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, failed)) states.push_back(entry.path());
  for (const fs::path& state : states) {
    const std::string name = state.filename();
    int channel = -1;
    std::from_chars(name.data(), name.data() + name.size(), channel);
    if (state.extension() == ".state" && channel >= first && fs::remove(state, failed)) removed.push_back(state);
  }
  if (fs::is_directory(fs::symlink_status(folder, failed))) fs::remove(folder, failed);  // if it is empty
}

}  // namespace

bool is_input(const ImageOptions& o, const std::string& path) {
  std::error_code absent;
  const auto leads_to = [&](const std::string& input) { return fs::equivalent(path, input, absent); };
  return std::any_of(o.clean.mask.begin(), o.clean.mask.end(), leads_to) ||
         std::any_of(o.clean.startmodel.begin(), o.clean.startmodel.end(), leads_to);
}

void remove_half_written(const std::string& imagename) {
  const fs::path name = imagename;
  const std::string begin = name.filename().string() + ".";
  std::error_code failed;
  std::vector<fs::path> halves;
  for (const fs::directory_entry& entry : fs::directory_iterator(name.has_parent_path() ? name.parent_path() : ".", failed))
    if (entry.path().filename().string().rfind(begin, 0) == 0 && kernels::is_temporary(entry.path()))
      halves.push_back(entry.path());
  for (const fs::path& half : halves) fs::remove(half, failed);
}

void remove_states(const ImageOptions& o) {
  std::vector<std::string> removed;
  for (const std::string& name : all_names())
    if (std::error_code failed; name.ends_with(".state")) fs::remove(o.imagename + "." + name, failed);
  remove_cube_states(o, 0, removed);
}

void remove_left_over(const ImageOptions& o, const OwnFiles& own, std::vector<std::string>& removed) {
  remove_other_images(o, own.images, removed);
  const std::vector<std::string> made = own_names(o);
  for (const std::string& name : all_names()) {
    const std::string path = o.imagename + "." + name;
    std::error_code failed;  // a folder of that name stays
    if (std::count(made.begin(), made.end(), name) == 0 && fs::remove(path, failed)) removed.push_back(path);
  }
  remove_cube_states(o, o.clean.runs() ? own.cube_channels : 0, removed);
}

}  // namespace misfit::tools
