#include "tools/run/model_stage.h"

#include <algorithm>
#include <deque>

#include "kernels/version.h"
#include "ms_io/fingerprint.h"
#include "ms_io/model_writer.h"
#include "tools/base/text.h"
#include "tools/formats/model_image.h"
#include "tools/run/gridding_options.h"
#include "tools/run/mosaic_stage.h"
#include "tools/run/shared_prediction.h"
#include "tools/run/written_column.h"

namespace misfit::tools {

namespace {

using imager::Image;
using imager::Stokes;

/// The model of a Stokes parameter or hand: one image for each Taylor term.
using Terms = std::vector<const Image*>;

bool is_hand(Stokes stokes) {
  return stokes == Stokes::RR || stokes == Stokes::LL || stokes == Stokes::XX || stokes == Stokes::YY;
}

bool is_circular(Stokes hand) {
  return hand == Stokes::RR || hand == Stokes::LL;
}

bool has(const std::vector<Stokes>& list, Stokes one) {
  return std::find(list.begin(), list.end(), one) != list.end();
}

/// "I, Q and V"
std::string names(const std::vector<Stokes>& list) {
  std::string text;
  for (std::size_t i = 0; i < list.size(); ++i)
    text += (i == 0 ? "" : i + 1 == list.size() ? " and " : ", ") + stokes_name(list[i]);
  return text;
}

bool is_first(Stokes hand) {
  return hand == Stokes::RR || hand == Stokes::XX;
}

/// The models as planes of I, Q, U and V.
class ModelPlanes {
 public:
  explicit ModelPlanes(const SavedModel& model) {
    taylor.expansion = model.expansion;
    if (!is_hand(model.stokes.front())) {
      for (std::size_t s = 0; s < model.stokes.size(); ++s) put(model.stokes[s], model.cleaned[s].models());
      return;
    }
    put(Stokes::I, half(model, 1));
    put(is_circular(model.stokes.front()) ? Stokes::V : Stokes::Q, half(model, -1));
  }
  ModelPlanes(const ModelPlanes&) = delete;
  ModelPlanes& operator=(const ModelPlanes&) = delete;

  StokesPlanes planes{};
  TaylorTerms taylor;

 private:
  void put(Stokes stokes, const Terms& terms) {
    const auto plane = static_cast<std::size_t>(stokes) - 1;
    planes.at(plane) = terms.front();
    taylor.further.at(plane).assign(terms.begin() + 1, terms.end());
  }

  /// (a + sign · b) / 2 of the first hand a and the second b, term by term.
  Terms half(const SavedModel& model, double sign) {
    Terms halves;
    for (std::size_t t = 0; t <= model.cleaned.front().further_models.size(); ++t) {
      const Image& like = model.cleaned.front().model;
      Image& sum = made_.emplace_back(like.width, like.height);
      for (std::size_t s = 0; s < model.stokes.size(); ++s) {
        const Image& hand = *model.cleaned[s].models()[t];
        const double factor = is_first(model.stokes[s]) ? 0.5 : 0.5 * sign;
        for (std::size_t i = 0; i < sum.pixel.size(); ++i) sum.pixel[i] += factor * hand.pixel[i];
      }
      halves.push_back(&sum);
    }
    return halves;
  }

  std::deque<Image> made_;
};

ms_io::Fingerprint fingerprint_of(const SavedModel& model) {
  ms_io::Fingerprint fingerprint;
  fingerprint.add(std::string(MISFIT_VERSION)).add(model.option_values);
  for (const imager::CleanResult& cleaned : model.cleaned)
    for (const Image* term : cleaned.models()) fingerprint.add(term->pixel);
  return fingerprint;
}

}  // namespace

bool saves_model(const std::vector<Stokes>& stokes) {
  const auto all = [&](const auto& holds) { return std::all_of(stokes.begin(), stokes.end(), holds); };
  return all([](Stokes s) { return s <= Stokes::V; }) ||
         (all(is_hand) && all([&](Stokes s) { return is_circular(s) == is_circular(stokes.front()); }));
}

std::string left_out_of_model_warning(const std::vector<Stokes>& stokes, const ms_io::MeasurementSet& set) {
  if (stokes == std::vector{Stokes::I}) return "";
  std::vector<Stokes> held;
  for (const Stokes part : is_hand(stokes.front()) ? set.correlations() : set.seen_stokes())
    if (!has(stokes, part) && !has(held, part)) held.push_back(part);
  if (held.empty()) return "";
  std::sort(held.begin(), held.end());
  return "--savemodel modelcolumn writes the model of " + names(stokes) + " alone: " + names(held) +
         (held.size() == 1 ? " is 0 in MODEL_DATA" : " are 0 in MODEL_DATA");
}

std::string save_model(const ImageOptions& o, const SavedModel& model, const imager::Ranks& ranks,
                       const imager::Progress& progress) {
  const ModelPlanes planes(model);
  ms_io::ModelColumn column{"MODEL_DATA"};
  column.origin = {"misfit image --savemodel modelcolumn --imagename " + shell_quoted(o.imagename),
                   fingerprint_of(model).value(), model.tell};
  ms_io::Selection selection = selection_of(o);
  selection.sights = false;  // the writer gives sights by ids of each set
  {
    const ms_io::MeasurementSet all(o.vis, selection, o.datacolumn, model.stokes);
    selection = all.selection();
  }
  std::string words;
  // Antennas and fields of a mosaic have ids of their own in each set.
  const std::size_t sets = o.vis.size(), at_once = o.makes_mosaic() ? 1 : sets;
  for (std::size_t first = 0; first < sets; first += at_once) {
    const bool one = at_once < sets;
    ModelVisibilities visibilities;
    ms_io::PredictionPace pace{.at_once = ranks.size()};
    {
      const auto set = (one ? ms_io::MeasurementSet(o.vis[first], selection.of_set(first), "", model.stokes)
                            : ms_io::MeasurementSet(o.vis, selection, "", model.stokes))
                           .share(ranks);
      imager::GriddingRequest request = gridding_request(o.gridding, model.threads);
      if (o.makes_mosaic()) {
        request.mosaic = seen_request(o, *set, model.geometry);
        pace.sights_from = set->observation().phase_centre;
      }
      visibilities = image_visibilities(planes.planes, model.geometry, request, *set, planes.taylor);
      pace.block_samples = visibilities.samples_at_once;
    }
    ranks.meet();  // before sets change
    SharedPrediction shared(ranks, visibilities.predict);
    if (!ranks.first()) {
      shared.follow();
      continue;
    }
    const auto predict = [&](const imager::SampleCoordinates& at) { return shared.predict(at); };
    for (std::size_t i = first; i < first + at_once; ++i)
      words +=
          written_words(o.vis[i], column, ms_io::write_model(o.vis[i], selection.of_set(i), column, predict, progress, pace));
    shared.end();
  }
  return words;
}

}  // namespace misfit::tools
