#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>

#include "imager/direct/source_sums.h"
#include "imager/numerics/page_pool.h"
#include "imager/numerics/parallel.h"
#include "kernels/version.h"
#include "ms_io/fingerprint.h"
#include "ms_io/measurement_set.h"
#include "ms_io/model_writer.h"
#include "ms_io/phase_centre.h"
#include "tools/base/numbers.h"
#include "tools/base/option_checks.h"
#include "tools/base/progress.h"
#include "tools/base/text.h"
#include "tools/base/value_checks.h"
#include "tools/command.h"
#include "tools/formats/component_list.h"
#include "tools/formats/image_file.h"
#include "tools/formats/model_image.h"
#include "tools/kernel_choice/kernel_choice.h"
#include "tools/run/data_columns.h"
#include "tools/run/dish_beams.h"
#include "tools/run/phased_set.h"
#include "tools/run/seen_model.h"
#include "tools/run/selection_options.h"
#include "tools/run/shared_prediction.h"
#include "tools/run/written_column.h"

namespace misfit::tools {
namespace {

struct PredictOptions {
  std::string vis;
  std::string model;
  std::string components;
  bool subtract = false;
  std::string datacolumn;   ///< empty: DATA
  std::string column;       ///< empty: see column_of()
  std::string phasecenter;  ///< as ms_io::phased_to() takes it; empty: see set_for_image()
  ms_io::Selection selection;
  double accuracy = 1e-6;
  bool accuracy_is_typed = false;
  KernelSource kernel;
  bool kernel_is_typed = false;
  bool apply_beam = false;
  std::string beam;  ///< see DishBeams
  int threads = 0;
  bool quiet = false;
};

/// A model as visibilities, with the identity that its column has while it is written.
struct NamedModel {
  ModelVisibilities visibilities;
  ms_io::Fingerprint fingerprint;
  std::uint64_t model = 0;     ///< a fingerprint that depends neither on accuracy and kernel nor on the order of sources
  bool empty = false;          ///< a list without sources, or an image of zeros
  ms_io::Selection selection;  ///< with the phase centre that it is about
  std::vector<std::string> remarks;
  std::optional<imager::SkyDirection> sights_from;  ///< where dishes' beams are applied, see PredictionPace
};

/// A sentence for each part of a model to which no correlation responds.
std::vector<std::string> unseen(const PredictOptions& o, const ms_io::MeasurementSet& set,
                                const std::vector<imager::Stokes>& parts) {
  const std::vector<imager::Stokes> seen = set.seen_stokes();
  std::vector<std::string> sentences;
  for (const imager::Stokes part : parts)
    if (std::find(seen.begin(), seen.end(), part) == seen.end())
      sentences.push_back("no correlation that is selected of " + o.vis + " responds to " + stokes_name(part) +
                          ": that of the model " + (o.model.empty() ? o.components : o.model) + " is left out");
  return sentences;
}

/// The beams of --apply-beam for a model that shines at these places; notes them in the model's identity.
imager::RowBeams beams_of(const PredictOptions& o, const ms_io::MeasurementSet& set,
                          const std::vector<imager::DirectionCosines>& places, NamedModel& named) {
  SetBeams beams = set_beams(set, DishBeams(o.beam));
  named.remarks.insert(named.remarks.end(), beams.doubts.begin(), beams.doubts.end());
  if (!places.empty() && !sees_any(beams, places, set.observation()))
    named.remarks.push_back("the beams of no field selected of " + o.vis + " reach the model " +
                            (o.model.empty() ? o.components : o.model) + ": its visibilities are 0");
  named.sights_from = set.observation().phase_centre;
  const std::uint64_t of_beams = ms_io::Fingerprint().add(told_apart_by(beams, set.observation())).value();
  named.fingerprint.add(of_beams);
  named.model += of_beams;
  return std::move(beams.rows);
}

/// Places of pixels that are not 0; if they are many, some of them all over the image.
std::vector<imager::DirectionCosines> bright_places(const std::vector<imager::SkyImage>& planes) {
  constexpr std::ptrdiff_t enough = 100000;
  const auto is_bright = [](double value) { return std::abs(value) > 0; };
  std::vector<imager::DirectionCosines> places;
  for (const imager::SkyImage& plane : planes) {
    const std::vector<double>& pixel = plane.image.pixel;
    const std::ptrdiff_t step = 1 + std::count_if(pixel.begin(), pixel.end(), is_bright) / enough;
    std::ptrdiff_t bright = 0;
    for (int row = 0; row < plane.image.height; ++row)
      for (int column = 0; column < plane.image.width; ++column)
        if (is_bright(plane.image.at(row, column)) && bright++ % step == 0) places.push_back(plane.geometry.at(row, column));
  }
  return places;
}

std::vector<imager::DirectionCosines> bright_places(const std::array<std::vector<imager::Source>, 4>& sources) {
  std::vector<imager::DirectionCosines> places;
  for (const std::vector<imager::Source>& plane : sources)
    for (const imager::Source& source : plane)
      if (source.flux_jy != 0) places.push_back(source.position);
  return places;
}

/// True if an image is 0, except for pixels beyond the horizon, which may be NaN.
bool is_zero(const imager::Image& image) {
  return std::none_of(image.pixel.begin(), image.pixel.end(), [](double value) { return std::abs(value) > 0; });
}

NamedModel image_model(const PredictOptions& o, const ms_io::MeasurementSet& set, int threads) {
  imager::GriddingRequest request;
  request.kernel = choose_kernel(o.kernel);
  request.accuracy = is_kernel_file(o.kernel) && !o.accuracy_is_typed ? 0 : o.accuracy;
  request.threads = threads;
  const auto file = open_image_file(o.model);
  const std::vector<imager::SkyImage> planes = read_stokes_model(*file, o.model);
  StokesPlanes model{};
  NamedModel named;
  std::vector<imager::Stokes> parts;
  named.fingerprint.add(o.kernel.name).add(std::vector<double>{request.accuracy});
  for (const imager::SkyImage& plane : planes) {
    if (plane.stokes > imager::Stokes::V)
      throw std::runtime_error(o.model + " has a plane of " + stokes_name(plane.stokes) + "; expected I, Q, U and V alone");
    model[static_cast<std::size_t>(plane.stokes) - 1] = &plane.image;
    if (!is_zero(plane.image)) parts.push_back(plane.stokes);
    const auto add_to = [&](ms_io::Fingerprint& fingerprint) {
      return fingerprint.add(stokes_name(plane.stokes))
          .add(plane.image.pixel)
          .add(std::vector<double>{plane.geometry.cell_rad, plane.geometry.pixel_aspect, plane.geometry.centre.l,
                                   plane.geometry.centre.m})
          .value();
    };
    add_to(named.fingerprint);
    ms_io::Fingerprint alone;
    named.model += add_to(alone);
  }
  if (file->header().flat_noise && !o.apply_beam)
    named.remarks.push_back(o.model +
                            " is a mosaic's: visibilities are those of its sky, which no beam dims; --apply-beam shows "
                            "it as antennas saw it");
  const imager::ImageGeometry& geometry = planes.front().geometry;
  named.visibilities = o.apply_beam ? seen_image(model, geometry, request, set, beams_of(o, set, bright_places(planes), named))
                                    : image_visibilities(model, geometry, request, set);
  named.empty = parts.empty();
  for (std::string& sentence : unseen(o, set, parts)) named.remarks.push_back(std::move(sentence));
  for (std::string& warning : std::array{band_warning(planes.front().observation, set.observation(), o.model),
                                         misplacement_warning(*file, o.model, set, o.accuracy)})
    if (!warning.empty()) named.remarks.push_back(std::move(warning));
  return named;
}

NamedModel component_model(const PredictOptions& o, const ms_io::MeasurementSet& set, int threads) {
  NamedModel named;
  auto sources = read_stokes_components(o.components, set.observation().phase_centre);
  for (const std::vector<imager::Source>& plane : sources) {
    named.fingerprint.add(plane.size());
    for (const imager::Source& s : plane) {
      const std::vector<double> values{s.position.l, s.position.m, s.flux_jy, s.fwhm_rad};
      named.fingerprint.add(values);
      named.model += ms_io::Fingerprint().add(static_cast<std::uint64_t>(&plane - sources.data())).add(values).value();
    }
  }
  named.empty = std::all_of(sources.begin(), sources.end(), [](const auto& plane) { return plane.empty(); });
  std::vector<imager::Stokes> parts;
  for (std::size_t k = 0; k < sources.size(); ++k)
    if (std::any_of(sources[k].begin(), sources[k].end(), [](const imager::Source& s) { return s.flux_jy != 0; }))
      parts.push_back(static_cast<imager::Stokes>(k + 1));
  for (std::string& sentence : unseen(o, set, parts)) named.remarks.push_back(std::move(sentence));
  if (set.observation().phase_centre.frame == "FK4" && lists_directions(o.components) && listed_frame(o.components).empty())
    named.remarks.push_back(
        "ra_deg and dec_deg of " + o.components +
        " are taken as B1950, as the phase centre is; a column frame with J2000 or B1950 states what they are");
  if (o.apply_beam) {
    named.visibilities.predict =
        seen_sources({sources.begin(), sources.end()}, beams_of(o, set, bright_places(sources), named), threads);
    return named;
  }
  named.visibilities.predict = [sources = std::move(sources), threads](const imager::SampleCoordinates& at) {
    ms_io::StokesVisibilities visibilities(imager::predict_sources(sources[0], at, threads));
    for (std::size_t k = 1; k < sources.size(); ++k)
      if (!sources[k].empty()) visibilities.plane[k] = imager::predict_sources(sources[k], at, threads);
    return visibilities;
  };
  return named;
}

/// The column that the model goes into. Calibrated data are overwritten only if the user names both the column read and the
/// column written.
ms_io::ModelColumn column_of(const PredictOptions& o) {
  if (!o.subtract) return {o.column.empty() ? "MODEL_DATA" : o.column};
  return {o.column.empty() ? "CORRECTED_DATA" : o.column, o.datacolumn.empty() ? "DATA" : o.datacolumn,
          !o.column.empty() && !o.datacolumn.empty()};
}

/// Checks the values that are given; missing ones are looked for afterwards.
void check_values(const PredictOptions& o) {
  if (!(o.accuracy > 0 && o.accuracy < 1))
    throw std::invalid_argument("--accuracy " + significant(o.accuracy, 3) + ": expected a number above 0 and below 1");
  check_beam(o.beam);
  if (o.threads < 0) throw std::invalid_argument("--threads " + std::to_string(o.threads) + ": expected 0 (all cores) or more");
}

/// A warning that data are subtracted from, by default, other than those which misfit image takes by default; else empty.
std::string uncalibrated_warning(const PredictOptions& o) {
  const std::string calibrated = "CORRECTED_DATA";
  if (!o.subtract || !o.datacolumn.empty() || ms_io::spelt_out(column_of(o)).name == calibrated) return "";
  if (ms_io::named_columns({o.vis}, "auto") != calibrated) return "";
  return o.vis +
         " has CORRECTED_DATA, which misfit image takes, but the model is subtracted from DATA; --datacolumn corrected "
         "takes CORRECTED_DATA";
}

Outcome outcome_of(const PredictOptions& o, const ms_io::ModelWriteReport& report) {
  const ms_io::ModelColumn column = ms_io::spelt_out(column_of(o));
  return {true,
          {{"column", column.name},
           {"visibilities", report.samples},
           {"rows", report.rows},
           {"rows_written_before", report.rows_before},
           {"rows_of_nonfinite_uvw", report.nonfinite_uvw_rows}},
          written_words(o.vis, column, report)};
}

/// The command, for people who find its column incomplete.
std::string command_of(const PredictOptions& o) {
  return "misfit predict " + std::string(o.subtract ? "--subtract " : "") +
         (o.model.empty() ? "--components " + shell_quoted(o.components) : "--model " + shell_quoted(o.model)) +
         (o.apply_beam ? " --apply-beam" : "") + (o.beam.empty() ? "" : " --beam " + shell_quoted(o.beam));
}

/// Reads this rank's model.
NamedModel read_model(const PredictOptions& o, const imager::Ranks& ranks) {
  const int threads = o.threads == 0 ? imager::available_threads(ranks.on_these_cores()) : o.threads;
  imager::PagePool::fill_by(threads);
  const PhasedSetRequest request{o.vis, o.phasecenter, o.selection, o.accuracy};
  const PhasedSet phased =
      o.model.empty() ? set_for_components(request, o.components, ranks) : set_for_image(request, o.model, ranks);
  NamedModel model = o.model.empty() ? component_model(o, *phased.set, threads) : image_model(o, *phased.set, threads);
  model.selection = phased.set->selection();
  model.remarks.insert(model.remarks.begin(), phased.remarks.begin(), phased.remarks.end());
  return model;
}

void predict(const PredictOptions& o, const CommandCall& call) {
  const imager::Ranks& ranks = call.ranks;
  check_values(o);
  if (o.model.empty() && o.components.empty())
    throw std::invalid_argument("no model is given: expected either --model or --components");
  if (!o.model.empty() && !o.components.empty())
    throw std::invalid_argument("--model " + o.model + " beside --components " + o.components +
                                ": expected either --model or --components");
  if (o.model.empty() && o.kernel_is_typed)
    refuse_option("kernel", o.kernel.name, "no gridding function beside --components, which are summed directly");
  ms_io::ModelColumn column = column_of(o);
  if (ranks.first()) ms_io::require_writable(o.vis, column);
  ProgressLine progress(o.quiet || !ranks.first());
  if (o.subtract && !column.in_place()) {
    if (const std::string sentence = ms_io::incomplete_column(o.vis, column.subtracted_from); !sentence.empty())
      progress.say("warning: " + sentence);
  }
  if (const std::string sentence = uncalibrated_warning(o); !sentence.empty()) progress.say("warning: " + sentence);
  NamedModel model = read_model(o, ranks);
  for (const std::string& sentence : model.remarks) progress.say("warning: " + sentence);
  ranks.meet();  // before the set changes
  SharedPrediction shared(ranks, model.visibilities.predict);
  if (!ranks.first()) return shared.follow();
  if (const std::string sentence = unselected_warning(o.vis, model.selection, column); !sentence.empty())
    progress.say("warning: " + sentence);
  if (model.empty)
    progress.say("warning: " + (o.model.empty() ? o.components + " lists no source: " : o.model + " is 0 in every pixel: ") +
                 (o.subtract ? "the data are written as they are" : "all visibilities written are 0"));
  column.origin = {command_of(o), model.fingerprint.add(MISFIT_VERSION).value(),
                   [&](const std::string& sentence) { progress.say(sentence); }, model.model};
  progress.begin(o.subtract ? "subtract" : "predict");
  const auto show = [&](std::uint64_t done, std::uint64_t total) { progress.update(done, total); };
  const ms_io::ModelWriteReport report = ms_io::write_model(
      o.vis, model.selection, column, [&](const imager::SampleCoordinates& at) { return shared.predict(at); }, show,
      {model.visibilities.samples_at_once, ranks.size(), model.sights_from});
  shared.end();
  progress.end();
  if (!report.zeros.zeros.none()) progress.say("warning: " + zeros_warning(report.zeros));
  conclude(outcome_of(o, report), o.quiet, call.outcome);
}

}  // namespace

void add_predict_command(CLI::App& program, const CommandCall& call) {
  CLI::App* command =
      program.add_subcommand("predict", "Write a model's visibilities, or data without them, into a MeasurementSet");
  const auto o = std::make_shared<PredictOptions>();
  command->add_option("--vis", o->vis, "MeasurementSet, of which only the column --column is written")
      ->required()
      ->type_name(folder_type);
  command
      ->add_option(
          "--model", o->model,
          "FITS or CASA image in Jy/pixel, at the place on the sky that its header states; its STOKES axis may hold I, Q, U "
          "and V. An image of one Taylor term is refused: a name with .tt0, .tt1, …, or a header with NTERMS above 1")
      ->type_name(file_type);
  command
      ->add_option("--components", o->components,
                   "CSV file of sources, which are summed directly with w: ra_deg,dec_deg,flux_jy or "
                   "l_arcsec,m_arcsec,flux_jy; scale_arcsec is the full width at half maximum of a circular Gaussian (0: a "
                   "point); polarised sources also have flux_q_jy, flux_u_jy, flux_v_jy")
      ->type_name(file_type);
  CLI::Option* apply_beam =
      command->add_flag("--apply-beam", o->apply_beam,
                        "Multiply the model by the primary beam: the model is the sky as in .image.pbcor, and each row sees it "
                        "through its dishes' beams about its field's pointing, at each channel's frequency. Gaussians of "
                        "--components are multiplied by the beam at their middle");
  command
      ->add_option("--beam", o->beam,
                   "Primary beam that --apply-beam uses instead of the antennas' own; values as for --beam of misfit image")
      ->type_name(name_or_file_type)
      ->needs(apply_beam);
  CLI::Option* subtract = command->add_flag(
      "--subtract", o->subtract,
      "Write data − model instead of the model; each correlation loses the model's value for it, such as I + Q for XX");
  command
      ->add_option("--datacolumn", o->datacolumn,
                   "Column from which --subtract subtracts: data (the default), corrected, model, or a column's name")
      ->needs(subtract)
      ->check(values_are({"data", "corrected", "model"}, Others::possible));
  command->add_option("--column", o->column,
                      "Column to write. The default is MODEL_DATA, or with --subtract CORRECTED_DATA, which must then be new "
                      "unless --column and --datacolumn are both given. The column that is read may be overwritten, unless it "
                      "is DATA. Outside the selection a new column holds 0, or with --subtract the data");
  declare_selection(*command, o->selection);
  command->add_option(
      "--phasecenter", o->phasecenter,
      "Phase centre of the model: a direction, a field or TRACKFIELD, as for misfit image; several phase centres may then be "
      "selected. When empty: the data's own phase centre; if that moves, the model stays fixed on the sky");
  command->add_option("--accuracy", o->accuracy,
                      "Largest error of the visibilities of --model: RMS of their difference from direct sums, over their RMS");
  list_kernels(*command->add_option("--kernel", o->kernel.name, "Gridding function of --model: a name or a kernel-table file"));
  declare_kernel_folder(*command, o->kernel.folder);
  command->add_option("--threads", o->threads, "Threads; 0 means all cores");
  command->add_flag("--quiet", o->quiet, "Print nothing but errors");
  check_before_missing(*command, [o] { check_values(*o); });
  command->callback([command, o, call] {
    o->accuracy_is_typed = command->get_option("--accuracy")->count() > 0;
    o->kernel_is_typed = command->get_option("--kernel")->count() > 0;
    predict(*o, call);
  });
}

}  // namespace misfit::tools
