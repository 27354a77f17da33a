#include "tools/run/left_over.h"

#include <algorithm>
#include <charconv>
#include <filesystem>

#include "imager/data/stokes.h"
#include "kernels/whole_file.h"
#include "tools/run/image_files.h"
#include "tools/run/taylor_options.h"

namespace misfit::tools {

namespace fs = std::filesystem;

std::vector<std::string> image_kinds() {
  std::vector<std::string> kinds = taylor_products(imager::most_taylor_terms, true);
  for (const std::string& kind : taylor_beam_products(imager::most_taylor_terms, true, true)) kinds.push_back(kind);
  for (const char* kind : {"psf", "residual", "model", "image", "mask", "pb", "image.pbcor"}) kinds.emplace_back(kind);
  return kinds;
}

bool is_input(const ImageOptions& o, const std::string& path) {
  std::error_code absent;
  return fs::equivalent(path, o.mask, absent) || fs::equivalent(path, o.startmodel, absent);
}

void remove_other_images(const ImageOptions& o, const std::vector<std::string>& made, std::vector<std::string>& removed) {
  for (const std::string& kind : image_kinds())
    for (const std::string& path : image_paths(o.imagename + "." + kind, "both")) {
      std::error_code failed;
      if (std::count(made.begin(), made.end(), path) > 0 || is_input(o, path) || !is_own_image(path)) continue;
      if (fs::remove_all(path, failed) > 0 && !failed) removed.push_back(path);
    }
}

void remove_half_written(const ImageOptions& o) {
  const fs::path name = o.imagename;
  const std::string begin = name.filename().string() + ".";
  std::error_code failed;
  std::vector<fs::path> halves;
  for (const fs::directory_entry& entry : fs::directory_iterator(name.has_parent_path() ? name.parent_path() : ".", failed))
    if (entry.path().filename().string().rfind(begin, 0) == 0 && kernels::is_temporary(entry.path()))
      halves.push_back(entry.path());
  for (const fs::path& half : halves) fs::remove(half, failed);
}

std::vector<std::string> remove_kinds(const ImageOptions& o, const std::vector<std::string>& kinds) {
  std::vector<std::string> removed;
  for (const std::string& kind : kinds) {
    const std::string path = o.imagename + "." + kind;
    std::error_code failed;  // a folder of that name stays
    if (fs::remove(path, failed)) removed.push_back(path);
  }
  return removed;
}

void remove_cube_states(const ImageOptions& o, int first, std::vector<std::string>& removed) {
  std::error_code failed;
  const fs::path folder = o.imagename + ".clean";
  std::vector<fs::path> states;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, failed)) states.push_back(entry.path());
  for (const fs::path& state : states) {
    const std::string name = state.filename();
    int plane = -1;
    std::from_chars(name.data(), name.data() + name.size(), plane);
    if (state.extension() == ".state" && plane >= first && fs::remove(state, failed)) removed.push_back(state);
  }
  fs::remove(folder, failed);  // where nothing is left in it
}

void remove_left_over_of_cube(const ImageOptions& o, int planes, std::vector<std::string>& removed) {
  std::vector<std::string> kinds{"dirty.png", "model.png", "uv.png", "alpha.png", "components.csv", "clean.state"};
  kinds.emplace_back(o.niter > 0 ? "residual.png" : "image.png");
  for (int code = 1; imager::is_stokes_code(code); ++code) {
    const std::string stokes = imager::stokes_name(static_cast<imager::Stokes>(code));
    for (const char* kind : {"dirty.", "model.", "residual.", "image."}) kinds.push_back(kind + stokes + ".png");
    kinds.push_back("clean." + stokes + ".state");
  }
  for (const std::string& path : remove_kinds(o, kinds)) removed.push_back(path);
  remove_cube_states(o, o.niter > 0 ? planes : 0, removed);
}

}  // namespace misfit::tools
