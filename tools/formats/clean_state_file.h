#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "imager/clean/clean.h"

namespace misfit::tools {

/// The run that a state of CLEAN belongs to.
struct CleanStateOwner {
  std::string version;          ///< of the program
  nlohmann::json options;       ///< {name: value} of options that must be the same, as typed or by default
  std::uint64_t checksum = 0;   ///< of the dirty image, the PSF, and what CLEAN is given besides
  int ranks = 1;                ///< that summed the images, whose last bits depend on the number of ranks
  imager::ComponentModel like;  ///< a model of the image's pixels and of the scales that CLEAN looks for
  nlohmann::json ways =
      nlohmann::json::object();     ///< {name: value} of the options that may be others, by which CLEAN then goes on
  std::uint64_t ways_checksum = 0;  ///< of files that these options name, such as a mask
};

/// A state that was read.
struct ReadCleanState {
  imager::CleanState state;
  std::vector<std::string> changed;  ///< names of `ways` that are others now; where there are any, the state has a model alone
};

/// A number that differs when a bit of any image does; null stands for none. Over the dirty image and the PSF it tells the data
/// selected, and how they are gridded.
std::uint64_t checksum(const std::vector<const imager::Image*>& images);

/// Writes a state; the file, in CBOR (RFC 8949), appears under its name only when complete. Throws std::runtime_error that
/// names the path.
void write_clean_state(const std::string& path, const imager::CleanState& state, const CleanStateOwner& owner);

/// Reads a state for a run of these options and data. Throws std::runtime_error that names the file, and the option or what
/// else is different, or that the file is damaged; also where its model has scales that CLEAN does not look for any more.
ReadCleanState read_clean_state(const std::string& path, const CleanStateOwner& owner);

}  // namespace misfit::tools
