#include "tools/run/model_stage.h"

#include "kernels/version.h"
#include "ms_io/fingerprint.h"
#include "ms_io/model_writer.h"
#include "tools/base/text.h"
#include "tools/formats/model_image.h"

namespace misfit::tools {

void save_model(const ImageOptions& o, const SavedModel& model, int threads, const imager::Progress& progress) {
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
    const ms_io::MeasurementSet set(o.vis, selection, o.datacolumn, model.stokes);
    visibilities = image_visibilities(planes, model.geometry, gridding_request(o, threads), set, taylor);
  }
  ms_io::ModelColumn column{"MODEL_DATA"};
  column.origin = {"misfit image --savemodel modelcolumn --imagename " + shell_quoted(o.imagename), fingerprint.value(),
                   model.tell};
  for (const std::string& set : o.vis)
    ms_io::write_model(set, selection, column, visibilities.predict, progress, visibilities.samples_at_once);
}

}  // namespace misfit::tools
