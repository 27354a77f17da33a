#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "imager/clean/clean.h"
#include "tools/run/clean_options.h"

namespace misfit::tools {

/// The image that was cleaned: a channel in one Stokes parameter.
struct CleanedImage {
  std::size_t components = 0;      ///< of the model, each at a place and scale of its own
  std::uint64_t visibilities = 0;  ///< of which the image is made
  bool limited = false;            ///< true if components may lie in a part of it alone, with or without an automatic mask
  bool one_of_many = false;        ///< true if sentences leave figures out, so that other planes have them in the same words
};

/// Sentences that warn of a CLEAN that ended: it diverged, or cycles of it were taken back; it has more components than
/// visibilities, so that it fits noise; its automatic mask kept it from a source that is there for certain.
std::vector<std::string> clean_doubts(const imager::CleanReport& report, const TypedClean& options, const CleanedImage& image);

}  // namespace misfit::tools
