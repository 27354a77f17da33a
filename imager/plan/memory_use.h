#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "imager/coplanar/coplanar_transform.h"
#include "imager/streaming/streamed_visibilities.h"

namespace misfit::imager {

/// An image of a wider field that is made besides, see search_wide_field.
struct WiderDemand {
  TransformMemory transform;
  double pixels = 0;
};

/// The numbers that decide how much memory a run of imaging takes.
struct MemoryDemand {
  TransformMemory transform;
  double pixels = 0;
  double rows = 0;           ///< of the visibilities
  double samples = 0;        ///< a row's channels, over all rows
  double block_samples = 0;  ///< in a block at most
  double read_at_once = 0;   ///< samples of the blocks that are read at once; 0: one block
  int stokes = 1;            ///< Stokes parameters; each has its visibilities and its dirty image
  bool verify = false;
  int terms = 1;              ///< Taylor terms; more than one of one Stokes parameter alone
  int clean_scales = 0;       ///< that minor cycles look at; 0 = no CLEAN
  bool mask = false;          ///< where components may lie
  bool start_model = false;   ///< that CLEAN begins with
  bool density = false;       ///< whether weights follow from a density
  std::size_t pointings = 1;  ///< each of which has a density of its own
  int beam_images = 0;        ///< primary beams, and images that are divided by them
  std::optional<WiderDemand> wider{};
};

/// The memory held at one time, in bytes, by what it is for.
struct MemoryUse {
  std::string when;         ///< the work at that time: "the PSF is made"
  double process = 0;       ///< the program, its libraries, and small things
  double visibilities = 0;  ///< kept for later passes
  double blocks = 0;        ///< read ahead, and put in order
  double grids = 0;
  double fft = 0;  ///< buffers of the threads
  double images = 0;

  double total() const { return process + visibilities + blocks + grids + fft + images; }
};

/// The memory held when it is most. A second pass that make_accurate_images finds necessary may take larger grids.
MemoryUse peak_memory(const MemoryDemand& demand, const StreamingOptions& streaming);

}  // namespace misfit::imager
