#include "imager/plan/memory_use.h"

#include <algorithm>
#include <vector>

#include "imager/clean/components.h"

namespace misfit::imager {
namespace {

/// 40 MB with the smallest images, 32 MiB that the allocator keeps, and some 20 MB of holes between images of a few MB.
constexpr double process_bytes = 96e6;
constexpr double pixel_bytes = sizeof(double);
constexpr double visibility_bytes = sizeof(std::complex<float>), weight_bytes = sizeof(float);
constexpr double row_bytes = 3 * sizeof(double);
/// For each sample of the block at hand: a run, twice while runs are sorted, as there may be one a sample; and room to grow.
constexpr double order_bytes = 2 * 12 + 8;
constexpr double residual_bytes = 2 * sizeof(double);
constexpr double component_bytes = sizeof(Component);

/// The memory of minor cycles, in bytes: images in single precision count half, and FFTs of real images have 3/2 the size
/// either way.
struct MinorMemory {
  double kept = 0;     ///< through major cycles
  double passing = 0;  ///< while one runs
};
MinorMemory minor_memory(double pixels, int scales, int terms) {
  constexpr double spectrum = 9. / 8, half_spectrum = 3. / 4;  // of a PSF; of rows alone
  constexpr double core_bytes = sizeof(float) * 1281. * 1281, image_bytes = pixel_bytes;
  const double psfs = 2 * terms - 1;
  MinorMemory memory;
  memory.kept = psfs * spectrum * image_bytes * pixels;
  memory.kept += psfs * (scales == 1 ? pixels * image_bytes / 2 : scales * (scales + 1) / 2 * core_bytes);
  const double model = scales == 1 ? 0 : 1;
  // Bright places, as they are found and in the order of tiles, with room to grow.
  const double places = std::min(pixels * scales, std::max(65536., pixels / 128)), place_bytes = 3 * (12 + 4 * terms);
  memory.passing = (terms * scales / 2. + (terms + 1) * half_spectrum + model) * image_bytes * pixels + places * place_bytes;
  // FFTs and planes that fill a huge page lie in whole ones.
  constexpr double huge_page = 2 << 20;
  const double page = image_bytes * pixels < huge_page ? 0 : huge_page;
  memory.kept += 2 * psfs * page;
  memory.passing += (terms * scales + terms + 1) * page;
  return memory;
}

/// Blocks while they stream by.
struct Streaming {
  double samples = 0;     ///< of a block
  double order = 0;       ///< bytes for sorting a block's samples
  double kept = 0;        ///< bytes of all blocks, where they stay
  double in_flight = 0;   ///< bytes of blocks read ahead and at hand, where they are not kept, and `order`
  double gathered = 0;    ///< bytes in flight while a prediction gathers blocks
  double prediction = 0;  ///< bytes of the visibilities that a prediction hands out
};

/// The memory of blocks. The block at hand is freed before the next is read.
Streaming streaming_of(const MemoryDemand& d, const StreamingOptions& options) {
  const auto bytes = [&](double samples) {
    const double rows = d.samples == 0 ? 0 : d.rows * samples / d.samples;
    return samples * (d.stokes * visibility_bytes + weight_bytes) + rows * row_bytes;
  };
  Streaming s;
  s.samples = std::min(d.block_samples, d.samples);
  s.order = s.samples * order_bytes;
  s.prediction = d.transform.gathered > 0 ? 0 : s.samples * residual_bytes;  // where it gathers, they count as its own
  if (options.keep) {
    s.kept = bytes(d.samples);
    s.in_flight = s.gathered = s.order;
    return s;
  }
  const double handed_out = static_cast<double>(options.ahead + 1) * s.samples;
  const double grown = std::max(0.0, d.read_at_once - s.samples) * (d.stokes * visibility_bytes + weight_bytes);
  s.in_flight = bytes(std::min(d.samples, handed_out)) + grown + s.order;
  s.gathered = bytes(std::min(d.samples, handed_out + d.transform.gathered)) + grown + s.order;
  return s;
}

/// Numbers of images of Taylor terms: residuals, or models, of each term; and the spectral PSFs.
struct Terms {
  int terms = 1;

  double further() const { return terms - 1; }
  double psfs() const { return 2 * terms - 1; }
  double lasting() const { return further() + psfs() - 1; }  ///< dirty images and PSFs besides the first
  /// Images that are drawn and written, besides those of one term: lasting PSFs and dirty images, models, residuals and
  /// restored images, the principal solution, and images of the spectrum.
  double drawn() const { return terms == 1 ? 0 : lasting() + 3 * further() + terms + 4; }
};

/// The pass for images of further Taylor terms; every image has a grid as large as the first one's.
void add_taylor_stages(const MemoryDemand& d, const Streaming& s, std::vector<MemoryUse>& stages) {
  const Terms n{d.terms};
  if (n.terms == 1) return;
  const TransformMemory& t = d.transform;
  const double image = d.pixels * pixel_bytes;
  stages.push_back({"the Taylor terms are gridded", process_bytes, s.kept,
                    s.in_flight + s.samples * residual_bytes * (n.lasting() + 1), n.lasting() * t.visibilities, 0, 2 * image});
  stages.push_back({"the images of Taylor terms are made", process_bytes, s.kept, 0, n.lasting() * t.visibilities, t.fft,
                    (2 + n.lasting()) * image});
}

/// While a wider field is searched: visibilities, and `lasting` bytes of the run's own images, stay.
void add_wider_stages(const WiderDemand& d, const Streaming& s, double lasting, std::vector<MemoryUse>& stages) {
  const TransformMemory& t = d.transform;
  const double image = d.pixels * pixel_bytes, kept = s.kept;
  const double tapered = s.in_flight + s.samples * (visibility_bytes + weight_bytes);  // a copy with other weights
  constexpr double placed_bytes = 32, growing = 2;  // a sample's, sorted by cells of the uv plane
  const double placed = s.in_flight + s.samples * (residual_bytes + growing * placed_bytes);
  stages.push_back({"the wider field is gridded", process_bytes, kept, tapered, t.visibilities + t.psf, 0, lasting});
  stages.push_back(
      {"the wider field's images are made", process_bytes, kept, 0, t.visibilities + t.psf, t.fft, lasting + 2 * image});
  const MinorMemory of_minor = minor_memory(d.pixels, 1, 1);
  const double minor = of_minor.kept;
  stages.push_back({"the wider field is cleaned", process_bytes, kept, 0, minor + of_minor.passing, 0, lasting + 3 * image});
  // Dirty image, PSF, model and residual.
  stages.push_back({"the wider field's residual is made", process_bytes, kept, tapered + s.samples * residual_bytes,
                    2 * t.visibilities + minor, t.fft, lasting + 4 * image});
  stages.push_back(
      {"the wider field's noise is measured", process_bytes, kept, placed, t.visibilities, t.fft, lasting + 2 * image});
}

/// The cells of densities that are held: half the plane where all samples share one density; where pointings have their own,
/// the tiles that their samples touch.
double density_cells(const MemoryDemand& d) {
  const double half_plane = d.pixels / 2;
  if (d.pointings <= 1) return half_plane;
  constexpr double of_a_sample = 3;  // measured: 2.2 to 2.7 for each cell with samples, in snapshots of 64 channels
  return std::min(static_cast<double>(d.pointings) * half_plane, of_a_sample * d.samples);
}

}  // namespace

MemoryUse peak_memory(const MemoryDemand& d, const StreamingOptions& streaming) {
  const TransformMemory& t = d.transform;
  const double image = d.pixels * pixel_bytes;
  const Streaming s = streaming_of(d, streaming);
  const double kept = s.kept;
  const Terms n{d.terms};
  const double others = (d.stokes - 1) * image;  // dirty images of the other Stokes parameters

  // The PSF, one image to find the median of each, one that the allocator keeps after several CLEANs, and the images of every
  // Stokes parameter.
  const double drawn_images = 2 + d.beam_images + (d.stokes > 1 && d.clean_scales > 0 ? 1 : 0) +
                              d.stokes * ((d.clean_scales > 0 ? 3 : 1) + (d.mask ? 1 : 0));
  // Stokes parameters that are cleaned hold a model, a residual and perhaps a mask each.
  const double finished = (d.stokes - 1) * (2 + (d.mask ? 1 : 0)) * image;

  std::vector<MemoryUse> stages;
  stages.push_back(
      {"the samples are gridded", process_bytes, kept, s.in_flight, t.visibilities + t.other_stokes + t.psf, 0, 0});
  stages.push_back({"the dirty image is made", process_bytes, kept, 0, t.visibilities + t.other_stokes + t.psf, t.fft, image});
  if (d.stokes > 1)
    stages.push_back({"the last dirty image is made", process_bytes, kept, 0, t.visibilities + t.psf, t.fft, others + image});
  stages.push_back({"the PSF is made", process_bytes, kept, 0, t.psf, t.fft, others + 2 * image});
  // A model image is predicted beside dirty image and PSF, and the less exact dirty image that CLEAN may begin with.
  const double verified = d.clean_scales > 0 ? 4 : 3;
  if (d.verify)
    stages.push_back({"prediction is verified", process_bytes, kept, 0, t.visibilities, t.fft, others + verified * image});
  add_taylor_stages(d, s, stages);
  if (d.clean_scales > 0) {
    // The dirty image is made anew where the PSF's transform did not make it exactly enough.
    stages.push_back({"the dirty image is made anew", process_bytes, kept, s.in_flight, t.visibilities, t.fft, 2 * image});
    const double masks = d.mask ? 2 : 0;  // the mask, and the residual within If every pixel is a component of the start model:
                                          // the components of two models, and of the list in which they are sorted.
    const double components = d.start_model ? 3 * component_bytes / pixel_bytes : 0;
    const double lasting = masks + components + 2 + n.lasting();  // dirty image and PSF
    const MinorMemory of_minor = minor_memory(d.pixels, d.clean_scales, n.terms);
    const double minor = of_minor.kept;
    stages.push_back({"the minor cycles run", process_bytes, kept, 0, minor + of_minor.passing, 0,
                      finished + (lasting + n.further() + n.terms) * image});
    // Visibilities of the terms' model images.
    const double sets = n.terms == 1 ? 0 : n.terms * s.samples * residual_bytes;
    stages.push_back({"the residual is gridded", process_bytes, kept, s.gathered + s.prediction + sets,
                      2 * n.terms * t.visibilities + minor, 0, finished + (lasting + n.terms) * image});
    stages.push_back({"the residual image is made", process_bytes, kept, 0, n.terms * t.visibilities + minor, t.fft,
                      finished + (lasting + 2 * n.terms) * image});
  }
  if (d.wider) {
    // After CLEAN the PSF, the model with its components, the residual and the mask; else the dirty image and the PSF.
    const double components = d.start_model ? 3 * component_bytes / pixel_bytes : 0;
    const double lasting = d.clean_scales > 0 ? 3 + components + (d.mask ? 1 : 0) : 2;
    add_wider_stages(*d.wider, s, (d.clean_scales > 0 ? finished : others) + lasting * image, stages);
  }
  if (d.density) {
    const double cells = density_cells(d);
    // The factors, in single precision, by which blocks are weighed as they are read.
    if (!streaming.keep)
      for (MemoryUse& stage : stages) stage.grids += 4 * cells;
    // The density, and the factors before and after a rank filter; a block's runs, sorted too. Weights are put into the blocks.
    stages.push_back({"the weights are made", process_bytes, kept, s.in_flight + s.samples * 2 * 16, 2 * 8 * cells, 0, 0});
  }
  stages.push_back({"the pictures are drawn", process_bytes, 0, 0, 0, 0, (drawn_images + n.drawn()) * image});
  return *std::max_element(stages.begin(), stages.end(),
                           [](const MemoryUse& a, const MemoryUse& b) { return a.total() < b.total(); });
}

}  // namespace misfit::imager
