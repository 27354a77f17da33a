#pragma once

#include <string>
#include <vector>

#include "tools/run/image_options.h"

namespace misfit::tools {

/// The middles of the names of all images that a run may write.
std::vector<std::string> image_kinds();

/// Whether the user named it as a mask or a start model: such a file stays as it is.
bool is_input(const ImageOptions& options, const std::string& path);

/// Removes the images that an earlier run of this name left, of kinds or in a format that this one, which makes the files
/// `made`, does not make; and adds them to `removed`.
void remove_other_images(const ImageOptions& options, const std::vector<std::string>& made, std::vector<std::string>& removed);

/// Removes files that a run of this name was writing when it was killed.
void remove_half_written(const ImageOptions& options);

/// Removes files <imagename>.<kind>; folders stay. Returns those that were there.
std::vector<std::string> remove_kinds(const ImageOptions& options, const std::vector<std::string>& kinds);

/// Removes the states that CLEAN of a cube left of `first` and later planes.
void remove_cube_states(const ImageOptions& options, int first, std::vector<std::string>& removed);

/// Removes pictures, lists and states of runs that made no cube, and those of a cube that this one, of so many planes, does not
/// make.
void remove_left_over_of_cube(const ImageOptions& options, int planes, std::vector<std::string>& removed);

}  // namespace misfit::tools
