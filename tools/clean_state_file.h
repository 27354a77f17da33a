#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>

#include "imager/clean/clean.h"

namespace misfit::tools {

/// What a state of CLEAN belongs to.
struct CleanStateOwner {
  std::string version;         ///< of the program
  nlohmann::json options;      ///< {name: value}, as typed or by default
  std::uint64_t checksum = 0;  ///< of the images that were made of the data, see checksum()
};

/// A number that differs when a bit of the dirty image or the PSF does, and with them of the data selected and of how they are
/// gridded; or of the mask, where one is given.
std::uint64_t checksum(const imager::DirtyImages& images, const imager::Image* mask);

/// Writes a state; the file, in CBOR (RFC 8949), appears under its name only when complete. Throws std::runtime_error that
/// names the path.
void write_clean_state(const std::string& path, const imager::CleanState& state, const CleanStateOwner& owner);

/// Reads a state for a run of these options and data. Options that only end CLEAN or do not reach it (niter, threshold, nsigma,
/// nmajor, savemodel, restoringbeam, verify, threads, memory, quiet, restart), and the name of the images, may differ. Throws
/// std::runtime_error that names the file, and the option or what else is different, or that the file is damaged.
imager::CleanState read_clean_state(const std::string& path, const CleanStateOwner& owner);

}  // namespace misfit::tools
