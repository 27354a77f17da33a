#include "tools/mosaic/mosaic_options.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <numbers>

#include "ms_io/phase_centre.h"
#include "tools/base/option_checks.h"
#include "tools/base/quantity.h"
#include "tools/base/text.h"
#include "tools/run/dish_beams.h"
#include "tools/run/image_files.h"

namespace misfit::tools {

std::optional<imager::SkyDirection> MosaicOptions::centre() const {
  return phasecenter.empty() ? std::nullopt : ms_io::parse_direction(phasecenter);
}

std::optional<double> MosaicOptions::cell_rad() const {
  return cell.empty() ? std::nullopt : std::optional(parse_angle_rad(cell));
}

std::vector<double> MosaicOptions::noises_jy() const {
  std::vector<double> noises;
  if (rms.empty()) return noises;
  for (const std::string_view part : split_at_commas(rms)) noises.push_back(parse_flux_jy(std::string(part)));
  if (noises.size() == 1 && !images.empty()) noises.resize(images.size(), noises.front());
  return noises;
}

void declare(CLI::App& command, MosaicOptions& o) {
  command
      .add_option("images,--images", o.images,
                  "Images of two or more pointings, FITS or CASA, in Jy/beam and not divided by the primary beam. The option's "
                  "name may be left out")
      ->required()
      ->type_name(file_type);
  command
      .add_option("--output", o.output, "The names of the output images begin with this: NAME.image, .weight, .noise and .pb")
      ->required()
      ->type_name(path_type)
      ->check(not_empty());
  command
      .add_option("--beam", o.beam,
                  "Primary beam of all images: a telescope's name; airy:D, a uniformly lit dish of D metres; airy:D:B, with a "
                  "dark middle of B metres; a FITS image or cube of a power pattern; or voltage:FILE, a voltage pattern. Files "
                  "are averaged over position angles. When empty: the image X.pb beside X.image; or, without it, the beam of "
                  "the telescope that the header names, about the header's reference direction, at the header's frequencies")
      ->type_name(name_or_file_type);
  command.add_option("--pblimit", o.pblimit,
                     "The mosaic has no values where the joint beam is lower than this; the joint beam is the square root of "
                     "weight over largest weight");
  command.add_option("--rms", o.rms,
                     "Noise of each image, such as 20uJy,31uJy, or one value for all. When empty: it is measured in X.residual "
                     "beside X.image, or else in the image itself");
  command.add_option(
      "--phasecenter", o.phasecenter,
      "Direction of the middle of the mosaic, such as 'J2000 12h30m49.4s +12d23m28s'. When empty: the middle of the "
      "pointings");
  command
      .add_option("--imsize", o.imsize,
                  "Width, or width and height, in pixels. When empty: large enough for all that the beams reach")
      ->expected(1, 2);
  command.add_option("--cell", o.cell, "Pixel size. When empty: the smallest pixel size of the images")
      ->check(quantity(parse_angle_rad));
  command.add_option("--outformat", o.outformat, "FITS files, CASA images, or both")->check(CLI::IsMember(image_formats()));
  command.add_option("--threads", o.threads, "Threads; 0 means all cores");
  command.add_flag("--quiet", o.quiet, "Print nothing but errors");
}

namespace {

void check_noises(const MosaicOptions& o) {
  constexpr const char* expected = "flux densities from 1e-15Jy to 1e15Jy, as 20uJy, for all images or for each";
  std::vector<double> noises;
  try {
    noises = o.noises_jy();
  } catch (const std::invalid_argument&) {
    refuse_option("rms", o.rms, expected);
  }
  for (const double noise : noises)
    if (!(noise >= 1e-15 && noise <= 1e15)) refuse_option("rms", o.rms, expected);  // weights are in single precision
  if (o.images.empty() || noises.empty() || noises.size() == o.images.size()) return;
  refuse_option("rms", o.rms,
                "one value, or one for each of " + std::to_string(o.images.size()) + " images; there are " +
                    std::to_string(noises.size()));
}

}  // namespace

void check(const MosaicOptions& o) {
  constexpr int largest_side = 65536;
  if (o.output.ends_with('/') || o.output.ends_with("/..") || o.output == "." || o.output == "..")
    refuse_option("output", o.output, "a name");
  check_beam(o.beam);
  if (o.beam == "airy") refuse_option("beam", o.beam, "airy:D, since images do not say how large the dishes are");
  if (!(o.pblimit > 0 && o.pblimit < 1)) refuse_option("pblimit", typed(o.pblimit), "a number between 0 and 1, such as 0.2");
  check_noises(o);
  if (!o.phasecenter.empty() && !o.centre())
    refuse_option("phasecenter", "'" + o.phasecenter + "'",
                  "a direction: J2000, ICRS or B1950 with angles such as 12h30m49.4s +12d23m28s or 187.7deg 12.39deg");
  for (const int size : o.imsize)
    if (size < 1 || size > largest_side) refuse_option("imsize", std::to_string(size), "1 to 65536 pixels");
  if (const auto cell = o.cell_rad(); cell && !(*cell > 0 && *cell < std::numbers::pi / 180 * 60))
    refuse_option("cell", o.cell, "more than 0 and less than 60deg");
  if (o.threads < 0) refuse_option("threads", std::to_string(o.threads), "0 (all cores) or more");
  if (o.images.size() == 1) refuse_option("images", o.images.front(), "two or more");
}

}  // namespace misfit::tools
