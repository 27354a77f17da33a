#pragma once

#include <string>
#include <vector>

#include "tools/run/image_options.h"

namespace misfit::tools {

/// True if the user named the file as a mask or a start model: such a file stays as it is.
bool is_input(const ImageOptions& options, const std::string& path);

/// Removes files that a run of this name was writing when it was killed.
void remove_half_written(const std::string& imagename);

/// Removes the states that CLEAN of earlier runs of this name left, so that nothing goes on from them.
void remove_states(const ImageOptions& options);

/// The files that a run makes.
struct OwnFiles {
  std::vector<std::string> images;  ///< paths
  int cube_channels = 0;            ///< 0: it makes no cube
};

/// Removes images, pictures, lists and states that an earlier run of this name left and this one does not make, and adds them
/// to `removed`. Folders stay, and images that were not written here.
void remove_left_over(const ImageOptions& options, const OwnFiles& own, std::vector<std::string>& removed);

}  // namespace misfit::tools
