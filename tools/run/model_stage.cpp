#include "tools/run/model_stage.h"

#include "kernels/version.h"
#include "ms_io/fingerprint.h"
#include "ms_io/model_writer.h"
#include "tools/base/text.h"
#include "tools/formats/model_image.h"
#include "tools/run/shared_prediction.h"

namespace misfit::tools {

void save_model(const ImageOptions& o, const SavedModel& model, const imager::Ranks& ranks, const imager::Progress& progress) {
  StokesPlanes planes{};
  TaylorTerms taylor{model.expansion, {}};
  ms_io::Fingerprint fingerprint;
  fingerprint.add(std::string(MISFIT_VERSION)).add(model.option_values);
  for (std::size_t s = 0; s < model.stokes.size(); ++s) {
    planes.at(static_cast<std::size_t>(model.stokes[s]) - 1) = &model.cleaned[s].model;
    fingerprint.add(model.cleaned[s].model.pixel);
    for (const imager::Image& further : model.cleaned[s].further_models) {
      fingerprint.add(further.pixel);
      taylor.further.push_back(&further);
    }
  }
  const ms_io::Selection selection = selection_of(o);
  ModelVisibilities visibilities;
  {
    const auto set = ms_io::MeasurementSet(o.vis, selection, o.datacolumn, model.stokes).share(ranks);
    visibilities = image_visibilities(planes, model.geometry, gridding_request(o, model.threads), *set, taylor);
  }
  ranks.meet();  // before sets change
  SharedPrediction shared(ranks, visibilities.predict);
  if (!ranks.first()) return shared.follow();
  ms_io::ModelColumn column{"MODEL_DATA"};
  column.origin = {"misfit image --savemodel modelcolumn --imagename " + shell_quoted(o.imagename), fingerprint.value(),
                   model.tell};
  const auto predict = [&](const imager::SampleCoordinates& at) { return shared.predict(at); };
  for (const std::string& set : o.vis)
    ms_io::write_model(set, selection, column, predict, progress, {visibilities.samples_at_once, ranks.size()});
  shared.end();
}

}  // namespace misfit::tools
