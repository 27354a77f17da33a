#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

#include "imager/direct_transform.h"
#include "imager/extent.h"
#include "imager/fits_image.h"
#include "imager/parallel.h"
#include "imager/planned_transform.h"
#include "ms_io/measurement_set.h"
#include "ms_io/model_writer.h"
#include "tools/command.h"
#include "tools/kernel_choice.h"
#include "tools/numbers.h"
#include "tools/progress.h"
#include "tools/sky.h"

namespace misfit::tools {
namespace {

struct PredictOptions {
  std::string vis;
  std::string model;
  std::string components;
  std::string column = "MODEL_DATA";
  ms_io::Selection selection;
  double accuracy = 1e-6;
  bool accuracy_is_typed = false;
  std::string kernel = "least-misfit";
  int threads = 0;
  bool quiet = false;
};

/// How far apart two centres may lie, as a part of a pixel: less than what a transform to 1e-7 notices.
constexpr double same_centre_pixels = 1e-3;

void check_centre(const imager::SkyImage& model, const imager::SkyDirection& centre, const std::string& path) {
  const imager::SkyDirection& has = model.geometry.phase_centre;
  const imager::DirectionCosines offset = imager::direction_cosines(has, centre);
  if (has.frame != centre.frame || std::hypot(offset.l, offset.m) > same_centre_pixels * model.geometry.cell_rad)
    throw std::runtime_error(path + " is centred on " + sexagesimal(has) + " (" + has.frame +
                             "), expected the phase centre of the visibilities, " + sexagesimal(centre) + " (" + centre.frame +
                             ")");
}

void check_finite(const imager::SkyImage& model, const std::string& path) {
  for (int row = 0; row < model.image.height; ++row)
    for (int column = 0; column < model.image.width; ++column)
      if (!std::isfinite(model.image.at(row, column)) && !imager::beyond_horizon(model.geometry.at(row, column)))
        throw std::runtime_error(path + " has pixels that are not finite; a model needs a number in each above the horizon");
}

/// The model as an operator from coordinates to visibilities.
struct Model {
  std::unique_ptr<imager::Transform> transform;  // outlives the prediction
  std::unique_ptr<imager::Prediction> prediction;
  ms_io::Predict predict;
  std::uint64_t samples_at_once = ms_io::MeasurementSet::usual_block_samples;
};

Model image_model(const PredictOptions& o, const ms_io::MeasurementSet& set, int threads) {
  imager::GriddingRequest request;
  request.kernel = choose_kernel(o.kernel);
  const imager::SkyImage image = imager::read_fits(o.model);
  if (image.unit != "Jy/pixel")
    throw std::runtime_error(o.model + " has the unit " + (image.unit.empty() ? "none" : image.unit) + ", expected Jy/pixel");
  check_centre(image, set.observation().phase_centre, o.model);
  check_finite(image, o.model);
  request.geometry = image.geometry;
  request.accuracy = is_kernel_file(o.kernel) && !o.accuracy_is_typed ? 0 : o.accuracy;
  request.samples = set.samples();
  request.images = 1;
  request.max_abs_w = set.reach(ms_io::ReachOf::all).max_abs_w;
  request.threads = threads;
  Model model;
  model.transform = std::make_unique<imager::PlannedTransform>(imager::plan_gridding(request));
  model.prediction = model.transform->predict(image.image);
  model.samples_at_once = std::max<std::uint64_t>(model.samples_at_once, model.prediction->samples_at_once());
  model.predict = [prediction = model.prediction.get()](const imager::SampleCoordinates& at) { return prediction->at(at); };
  return model;
}

Model component_model(const PredictOptions& o, const ms_io::MeasurementSet& set, int threads) {
  Model model;
  model.predict = [sources = read_component_list(o.components, set.observation().phase_centre),
                   threads](const imager::SampleCoordinates& at) { return imager::predict_sources(sources, at, threads); };
  return model;
}

void predict(const PredictOptions& o) {
  if (!(o.accuracy > 0 && o.accuracy < 1))
    throw std::invalid_argument("--accuracy " + significant(o.accuracy, 3) + ": expected a number above 0 and below 1");
  if (o.threads < 0) throw std::invalid_argument("--threads " + std::to_string(o.threads) + ": expected 0 (all cores) or more");
  if (o.model.empty() == o.components.empty()) throw std::invalid_argument("expected either --model or --components");
  ProgressLine progress(o.quiet);
  const int threads = o.threads == 0 ? imager::available_threads() : o.threads;
  Model model;
  {
    const ms_io::MeasurementSet set(o.vis, o.selection, "DATA");
    model = o.model.empty() ? component_model(o, set, threads) : image_model(o, set, threads);
  }
  progress.begin("predict");
  const ms_io::ModelWriteReport report = ms_io::write_model(
      o.vis, o.selection, o.column, model.predict,
      [&](std::uint64_t done, std::uint64_t total) { progress.update(done, total); }, model.samples_at_once);
  progress.end();
  if (o.quiet) return;
  std::printf("%s: %s visibilities in %s rows written to %s\n", o.vis.c_str(),
              grouped(static_cast<long long>(report.samples)).c_str(), grouped(static_cast<long long>(report.rows)).c_str(),
              o.column.c_str());
  if (report.nonfinite_uvw_rows > 0)
    std::printf("%s rows have UVW that are not finite and got 0\n",
                grouped(static_cast<long long>(report.nonfinite_uvw_rows)).c_str());
}

}  // namespace

void add_predict_command(CLI::App& program) {
  CLI::App* command = program.add_subcommand("predict", "Write the visibilities of a model into a column of a MeasurementSet");
  const auto o = std::make_shared<PredictOptions>();
  command->add_option("--vis", o->vis, "MeasurementSet; only the column is written")->required();
  command->add_option("--model", o->model, "FITS image in Jy/pixel whose reference position is the phase centre");
  command->add_option("--components", o->components,
                      "CSV file with ra_deg,dec_deg,flux_jy or l_arcsec,m_arcsec,flux_jy, summed directly with w");
  command->add_option("--column", o->column, "Column to write; made when it does not exist");
  command->add_option("--field", o->selection.field, "Fields, in CASA's selection syntax");
  command->add_option("--spw", o->selection.spectral_window, "Spectral windows and channels, in CASA's selection syntax");
  command->add_option("--accuracy", o->accuracy, "Relative accuracy of the visibilities");
  command->add_option("--kernel", o->kernel, "Gridding function: a name or a kernel-table file");
  command->add_option("--threads", o->threads, "Threads; 0 means all cores");
  command->add_flag("--quiet", o->quiet, "Print nothing");
  command->callback([command, o] {
    o->accuracy_is_typed = command->get_option("--accuracy")->count() > 0;
    predict(*o);
  });
}

}  // namespace misfit::tools
