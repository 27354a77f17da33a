#include "imager/arrays/array_clean.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "imager/arrays/array_source.h"
#include "imager/data/stored_visibilities.h"
#include "imager/numerics/constants.h"
#include "imager/numerics/parallel.h"
#include "imager/plan/accurate_imaging.h"

namespace misfit::imager {
namespace {

/// The beam of the main lobe, or where none fits the round one.
Beam beam_of(const Image& psf, double cell_rad) {
  try {
    return fit_beam(psf, cell_rad);
  } catch (const std::runtime_error& elliptical) {
    try {
      return fit_circular_beam(psf, cell_rad);
    } catch (const std::runtime_error&) {
      throw std::runtime_error(elliptical.what());
    }
  }
}

CleanState state_of(const ArrayCleanOptions& options, const std::vector<double>& scale_pixels) {
  const auto& [pixels_x, pixels_y, pixel_x_rad, pixel_y_rad, centre_x, centre_y] = options.transform.image;
  ComponentModel model(pixels_y, pixels_x, scale_pixels);
  const Strided<const double>& start = options.start_model;
  if (!start) return first_state(model);
  if (start.rows != static_cast<std::size_t>(pixels_x) || start.columns != static_cast<std::size_t>(pixels_y))
    throw std::invalid_argument("startmodel has " + std::to_string(start.rows) + " x " + std::to_string(start.columns) +
                                " pixels, expected " + std::to_string(pixels_x) + " x " + std::to_string(pixels_y));
  Image image(pixels_y, pixels_x);
  for (int row = 0; row < pixels_x; ++row)
    for (int column = 0; column < pixels_y; ++column)
      image.at(row, column) = start.at(static_cast<std::size_t>(row), static_cast<std::size_t>(column));
  if (!std::all_of(image.pixel.begin(), image.pixel.end(), [](double pixel) { return std::isfinite(pixel); }))
    throw std::invalid_argument("startmodel is not finite somewhere; expected Jy/pixel, 0 where there is nothing");
  model.add(components_of(image));
  return first_state(model);
}

/// The images that CLEAN begins with.
struct Dirty {
  AccurateImages made;
  Beam beam;
  double expected_error = 0;  ///< of the dirty image
};

Dirty dirty_images(const VisibilitySource& source, GriddingPlan plan, double cell_rad) {
  Dirty dirty{make_accurate_images(source, std::move(plan), {}), {}, 0};
  dirty.beam = beam_of(dirty.made.images.psf, cell_rad);
  const DirtyImages& images = dirty.made.images;
  const double rms = images.dirty_statistics.front().root_mean_square();
  dirty.expected_error = theoretical_error(dirty.made.plan, images.sums.front(), rms, {}).expected_rms;
  return dirty;
}

/// All blocks, kept for the major cycles.
template <typename Real>
StoredVisibilities stored(const ArrayCoordinates& at, const ArrayValues<Real>& values, const ArrayBlockOptions& blocks_of) {
  const ArraySource<Real> source(at, values, blocks_of);
  StoredVisibilities blocks;
  const auto stream = source.open();
  while (auto block = stream->next()) blocks.append(std::move(block));
  return blocks;
}

/// The position angle of the same axis in (−π/2, π/2].
double in_half_turn(double position_angle_rad) {
  return position_angle_rad <= -pi / 2 ? position_angle_rad + pi : position_angle_rad;
}

}  // namespace

template <typename Real>
ArrayClean clean_arrays(const ArrayCleanOptions& options, const ArrayCoordinates& at, const ArrayValues<Real>& values) {
  const ArrayTransformOptions& t = options.transform;
  if (t.image.pixel_x_rad != t.image.pixel_y_rad)
    throw std::invalid_argument("pixels of " + std::to_string(t.image.pixel_x_rad) + " x " +
                                std::to_string(t.image.pixel_y_rad) + " rad, expected square ones: CLEAN's beams need them");
  check(options.clean);
  const int smallest = std::min(t.image.pixels_x, t.image.pixels_y);
  for (const double scale : options.deconvolver.scale_pixels)
    if (!(scale >= 0 && scale <= tclean_scale_width * smallest))
      throw std::invalid_argument("a scale of " + std::to_string(scale / tclean_scale_width) + " pixels, expected 0 to " +
                                  std::to_string(smallest) + ", the image's size");
  if (options.deconvolver.name != "multiscale" &&
      (options.deconvolver.scale_pixels != std::vector<double>{0} || options.deconvolver.small_scale_bias != 0))
    throw std::invalid_argument("scales or smallscalebias with the deconvolver " + options.deconvolver.name +
                                ": expected multiscale beside them");
  GriddingPlan plan = plan_of(t, at, true);
  const double cell_rad = t.image.pixel_x_rad;
  const int threads = plan.options.threads;
  const StoredVisibilities source = stored(at, values, {cell_rad / plan.options.geometry.cell_rad, threads});
  auto [made, beam, expected_error] = dirty_images(source, std::move(plan), cell_rad);
  const Image& psf = made.images.psf;
  DeconvolverChoice deconvolver = options.deconvolver;
  deconvolver.threads = threads;
  CleanOptions clean_options = options.clean;
  clean_options.threads = threads;
  clean_options.stop_requested = [&asked = options.clean.stop_requested] {
    StopCheck::now_and_then();
    return asked && asked();
  };
  const auto minor = make_deconvolver(deconvolver, {&psf});
  ArrayClean result;
  result.sums = made.images.sums.front();
  result.expected_error = expected_error;
  CleanInput input{.imaged = {source, *made.transform, made.images.normalisation},
                   .dirty = std::move(made.images.dirty),
                   .psf = {&psf},
                   .max_sidelobe = largest_sidelobe(psf, beam, cell_rad, threads),
                   .same_sidelobes = made.plan.leaves_w_out(),
                   .coarser = made.transform->coarser(),
                   .data_jy = made.images.sums.front().data_jy(),
                   .accuracy = std::max(t.accuracy, expected_error),
                   .beam = beam,
                   .cell_rad = cell_rad};
  CleanResult cleaned =
      clean(std::move(input), *minor, clean_options, state_of(options, minor->scale_pixels()), [](const CleanState&) {}, {});
  result.restored = restored({cleaned.model, cleaned.residual}, beam, cell_rad, threads);
  result.residual = std::move(cleaned.residual);
  result.model = std::move(cleaned.model);
  result.mask = std::move(cleaned.mask);
  result.report = std::move(cleaned.report);
  result.psf = std::move(made.images.psf);
  result.beam = {beam.major_rad, beam.minor_rad, in_half_turn(-beam.position_angle_rad)};  // east is towards −y
  return result;
}

template ArrayClean clean_arrays(const ArrayCleanOptions&, const ArrayCoordinates&, const ArrayValues<float>&);
template ArrayClean clean_arrays(const ArrayCleanOptions&, const ArrayCoordinates&, const ArrayValues<double>&);

}  // namespace misfit::imager
