#include "tools/run/image_options.h"

#include <CLI/CLI.hpp>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "imager/data/stokes.h"
#include "ms_io/phase_centre.h"
#include "tools/base/option_checks.h"
#include "tools/base/quantity.h"
#include "tools/formats/config_file.h"
#include "tools/run/image_files.h"
#include "tools/run/selection_options.h"

namespace misfit::tools {
namespace {

constexpr int largest_side = 65536;  ///< of an image, in pixels

void check_sets(const ImageOptions& o) {
  std::set<std::filesystem::path> met;
  for (const std::string& name : o.vis) {
    const std::filesystem::path path = std::filesystem::weakly_canonical(name);
    if (!met.insert(path.has_filename() ? path : path.parent_path()).second) refuse_option("vis", name, "each set once");
  }
}

/// The first of sizes that must be the same.
std::string one_cell(const std::vector<std::string>& sides) {
  constexpr double rounding = 1e-12;  // of 0.2arcsec beside 200mas
  const double first = parse_angle_rad(sides.front()), last = parse_angle_rad(sides.back());
  if (std::abs(last - first) > rounding * std::abs(first))
    refuse_option("cell", sides.front() + " " + sides.back(), "one size, or two that are equal: pixels are square");
  return sides.front();
}

void check_image(const ImageOptions& o) {
  check_sets(o);
  if (!o.vis.empty()) ms_io::require_one_or_each(o.selection, o.vis.size());
  const std::string name = std::filesystem::path(o.imagename).filename();
  if ((name.empty() && !o.imagename.empty()) || name == "." || name == "..")
    refuse_option("imagename", "'" + o.imagename + "'", "a name for files to begin with, not a folder");
  for (const int size : o.imsize)
    if (size < 1 || size > largest_side) refuse_option("imsize", std::to_string(size), "1 to 65536 pixels");
  for (const imager::Stokes stokes : imager::parse_stokes(o.stokes))
    if (stokes == imager::Stokes::XY || stokes == imager::Stokes::YX || stokes == imager::Stokes::RL ||
        stokes == imager::Stokes::LR)
      refuse_option("stokes", o.stokes, "no crossed hands, which are complex on the sky: Q, U and V show their parts");
  if (o.cell.empty()) return;
  if (!(parse_angle_rad(o.cell) > 0)) refuse_option("cell", o.cell, "an angle above 0");
  if (parse_angle_rad(o.cell) > 0.5) refuse_option("cell", o.cell, "less than 0.5 rad");
}

}  // namespace

void declare_scene(CLI::App& command, ImageOptions& o) {
  command
      .add_option("--vis", o.vis,
                  "MeasurementSet, or several for one image; --field to --observation may then have one value for each set. "
                  "Sets are opened read-only, unless misfit image --savemodel writes into them")
      ->required()
      ->type_name(folder_type);
  command.add_option("--phasecenter", o.phasecenter,
                     "Shift the visibilities to a direction, such as 'J2000 12h30m49.4s +12d23m28s', or to the phase centre of "
                     "a field, by id or name; several fields may then be selected. The image follows a moving target: a "
                     "planet, SUN or MOON by name, the ephemeris at a path, or with TRACKFIELD each field's own ephemeris");
  command.add_option("--imsize", o.imsize, "Width, or width and height, in pixels")->required()->expected(1, 2);
  command
      .add_option_function<std::vector<std::string>>(
          "--cell", [&o](const std::vector<std::string>& sides) { o.cell = one_cell(sides); },
          "Size of a pixel, such as 0.2arcsec or 3mas; arcsec without a unit. Two sizes must be equal: pixels are square")
      ->required()
      ->expected(1, 2)
      ->check(quantity(parse_angle_rad));
  declare_selection_of_each(command, o.selection);
  command
      .add_option("--datacolumn", o.datacolumn,
                  "auto (CORRECTED_DATA if a set has it, else DATA), data, corrected, model, or a column's name; or one value "
                  "for each set, such as corrected,data")
      ->check(values_are({"auto", "data", "corrected", "model"}, Others::possible));
  mark(command.add_flag(
           "--force-average", o.force_average,
           "Average fields of different pointings even if the image's centre lies beyond the first null of some field's beam, "
           "which dims the sources that the other fields see. Without this option such fields are refused by name"),
       OptionMark::free_of_state);
  declare(command, o.weighting);
  declare_gridder(command, o.gridding);
  mark(command.add_option("--threads", o.threads, "Threads; 0 means all cores"), OptionMark::free_of_state);
  mark(command.add_flag("--quiet", o.quiet, "Print nothing but errors"), OptionMark::free_of_state);
}

std::string names_of(const std::vector<std::string>& paths) {
  std::string names;
  for (const std::string& name : paths) names += (names.empty() ? "" : ", ") + name;
  return names;
}

ms_io::Selection selection_of(const ImageOptions& o) {
  ms_io::Selection selection = o.selection;
  selection.spectral_frame = spectral_frame(o.cube);
  selection.either_hand = imager::is_pseudo_i(o.stokes);
  selection.sights = o.makes_mosaic();
  return o.phasecenter.empty() ? selection : ms_io::phased_to(selection, o.phasecenter, o.vis);
}

void declare(CLI::App& command, ImageOptions& o) {
  declare_scene(command, o);
  mark(command.add_option("--imagename", o.imagename, "The names of the output files begin with this")
           ->required()
           ->type_name(path_type)
           ->check(not_empty()),
       OptionMark::free_of_state);
  command.add_option("--stokes", o.stokes,
                     "Stokes parameters, or parallel-hand correlations, which share one PSF: I, IQUV, IV, XXYY, RR, …; or "
                     "pseudoI: I, also from samples of which one parallel hand is flagged");
  declare(command, o.cube);
  declare(command, o.gridding);
  declare(command, o.mosaic);
  declare(command, o.taylor);
  declare(command, o.clean);
  declare(command, o.primary_beam);
  declare(command, o.taken);
  mark(command
           .add_option("--products", o.products,
                       "tclean: also write .sumwt, the sum of each plane's weights in one pixel, which is 1/noise² for natural "
                       "weights; .pb if the antennas' beam is known; .mask, filled with ones if CLEAN may go everywhere; and "
                       ".image of a dirty image")
           ->check(CLI::IsMember({"needed", "tclean"})),
       OptionMark::free_of_state);
  mark(command.add_option(
           "--verify", o.verify,
           "Compare this many random pixels (all of a smaller image) and this many visibilities with the direct transform"),
       OptionMark::free_of_state);
  mark(command.add_flag("--check-outside", o.check_outside,
                        "Search four times the image's field for sources outside the image whose aliases may exceed its noise"),
       OptionMark::free_of_state);
  mark(command.add_option("--memory", o.memory_gib,
                          "Memory that the run may take, in GiB; 0 means half of the machine's memory"),
       OptionMark::free_of_state);
  mark(command.add_option("--outformat", o.outformat, "Format of the images: FITS files (fits), CASA images (casa), or both")
           ->check(CLI::IsMember(image_formats())),
       OptionMark::free_of_state);
  mark(command.add_flag("--dry-run", o.dry_run,
                        "Print the plan and the memory it takes; read no visibilities and write nothing"),
       OptionMark::free_of_state);
  declare(command, o.scale);
}

void check(const ImageOptions& o) {
  check_image(o);
  check(o.cube);
  check(o.weighting, o.cube);
  check_clean(o);
  check_taylor(o);
  check(o.gridding);
  check(o.mosaic);
  if (o.gridding.gridder == "standard" || o.gridding.gridder == "wide") refuse_beside_other_gridders(o.mosaic);
  refuse_outside_of_mosaic(o);
  check(o.primary_beam);
  check_taken(o);
  check(o.scale, o.dry_run);
  if (o.check_outside && o.cube.is_cube()) refuse_option("check-outside", "true", "--specmode mfs beside it");
  if (o.verify < 0) refuse_option("verify", std::to_string(o.verify), "0 or more");
  if (o.threads < 0) refuse_option("threads", std::to_string(o.threads), "0 (all cores) or more");
  if (!(o.memory_gib >= 0 && std::isfinite(o.memory_gib)))
    refuse_option("memory", typed(o.memory_gib), "0 (half of the machine's memory) or more, in GiB");
}

void refuse_outside_of_mosaic(const ImageOptions& o) {
  if (o.makes_mosaic() && o.check_outside) refuse_option("check-outside", "true", "another --gridder than mosaic beside it");
}

imager::ImageGeometry geometry_of(const ImageOptions& o, const imager::SkyDirection& phase_centre) {
  return {o.imsize.front(), o.imsize.back(), parse_angle_rad(o.cell), phase_centre};
}

nlohmann::json option_values(const CLI::App& command) {
  nlohmann::json values = nlohmann::json::object();
  for (const auto& [name, value] : options_in_force(command)) values[name] = value;
  return values;
}

StateOptionValues state_option_values(const CLI::App& command) {
  StateOptionValues values{option_values(command), nlohmann::json::object()};
  for (const CLI::Option* option : command.get_options()) {
    if (option->get_lnames().empty()) continue;
    const std::string& name = option->get_lnames().front();
    const bool way = has(*option, OptionMark::way_of_clean);
    if (way) values.ways[name] = values.owners.at(name);
    if (way || has(*option, OptionMark::free_of_state)) values.owners.erase(name);
  }
  return values;
}

}  // namespace misfit::tools
