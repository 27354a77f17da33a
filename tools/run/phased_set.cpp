#include "tools/run/phased_set.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "ms_io/celestial_frames.h"
#include "ms_io/phase_centre.h"
#include "tools/base/numbers.h"
#include "tools/formats/component_list.h"
#include "tools/formats/image_file.h"
#include "tools/run/field_beams.h"

namespace misfit::tools {
namespace {

/// Part of the accuracy that the distance of a model from a phase centre may take.
constexpr double same_centre_part = 1e-2;

PhasedSet opened(const PhasedSetRequest& request, const ms_io::Selection& selection, const imager::Ranks& ranks) {
  PhasedSet phased{ms_io::MeasurementSet(request.vis, selection, "").share(ranks), {}};
  phased.remarks = phased.set->remarks();
  return phased;
}

/// Where a list of directions states another frame than the phase centre's, opens the set about a direction in the list's
/// frame, to which visibilities are shifted as the frames lie at their time.
PhasedSet in_frame_of_list(const PhasedSetRequest& request, PhasedSet phased, const std::string& list,
                           const imager::Ranks& ranks) {
  const imager::Observation& observation = phased.set->observation();
  const std::string frame = lists_directions(list) ? listed_frame(list) : "";
  if (frame.empty() || frame == observation.phase_centre.frame || !observation.moving_at.empty()) return phased;
  ms_io::Selection selection = phased.set->selection();
  selection.phase_centre = ms_io::in_frame(observation.phase_centre, frame);
  return {opened(request, selection, ranks).set, std::move(phased.remarks)};
}

/// The selection without a model's phase centre. A model that moves along has the field's own.
ms_io::Selection usual_selection(const PhasedSetRequest& request, bool moves_along) {
  if (!request.phasecenter.empty()) return ms_io::phased_to(request.selection, request.phasecenter, {request.vis});
  ms_io::Selection selection = request.selection;
  if (!moves_along) selection.moving = ms_io::Selection::Moving::shifted_to_middle;
  return selection;
}

std::string place_text(const imager::SkyDirection& direction) {
  return sexagesimal(direction) + " (" + direction.frame + ")";
}

}  // namespace

void require_same_target(const std::string& path, const imager::ImageReader& file, const ms_io::MeasurementSet& set,
                         const std::string& sets) {
  const std::string& moving_at = file.header().observation.moving_at;
  const auto followed = set.followed_at(moving_at);
  if (!followed || !file.grid()) return;
  const double apart_rad = angle_between(ms_io::in_frame(file.grid()->reference, followed->frame), *followed);
  if (apart_rad > file.grid()->column_step_rad())
    throw std::runtime_error(path + " moves along with another target: at its TRACKFLD, " + moving_at + ", it was " +
                             angle_text(apart_rad, 3) + " away from what is selected of " + sets +
                             "; expected an image of the same target");
}

PhasedSet set_for_components(const PhasedSetRequest& request, const std::string& list, const imager::Ranks& ranks) {
  return in_frame_of_list(request, opened(request, usual_selection(request, !lists_directions(list)), ranks), list, ranks);
}

PhasedSet set_for_image(const PhasedSetRequest& request, const std::string& model, const imager::Ranks& ranks) {
  const auto file = open_image_file(model);
  const imager::ImageHeader& image = file->header();
  const std::string& moving_at = image.observation.moving_at;
  ms_io::Selection selection = usual_selection(request, !moving_at.empty());
  PhasedSet phased = opened(request, selection, ranks);
  const bool set_moves = !phased.set->observation().moving_at.empty();
  if (!moving_at.empty() && !set_moves)
    throw std::runtime_error(
        model + " moves along with its target (TRACKFLD is " + moving_at + "), and what is selected of " + request.vis +
        " is phased to a direction; expected a field that moves, --phasecenter with the planet or ephemeris that the "
        "image moves with, or an image that stands still");
  if (set_moves) {
    if (!moving_at.empty()) require_same_target(model, *file, *phased.set, request.vis);
    return phased;
  }
  const imager::SkyDirection &own = image.geometry.phase_centre, &centre = phased.set->observation().phase_centre;
  const double cell_rad = image.geometry.cell_rad;
  const double away = cosine_distance(ms_io::in_frame(own, centre.frame), centre);
  // The phase of the longest baselines that pixels represent turns by π√2 for each pixel that the centre is away.
  if (own.frame == centre.frame && M_PI * std::sqrt(2) * away / cell_rad < same_centre_part * request.accuracy) return phased;
  if (away > cell_rad) {
    if (!request.phasecenter.empty())
      throw std::runtime_error(model + " is centred on " + place_text(own) + ", expected the --phasecenter given, " +
                               place_text(centre) + ", or none: the model is predicted where it lies on the sky");
    phased.remarks.push_back("the model " + model + " is centred on " + place_text(own) + ", " +
                             (std::isfinite(away) ? angle_text(std::asin(std::min(1.0, away)), 3) : "90 deg or more") +
                             " from the phase centre of " + request.vis + ", " + place_text(centre) +
                             ": it is predicted where it lies on the sky");
  }
  selection.phase_centre = own;
  return {opened(request, selection, ranks).set, phased.remarks};
}

}  // namespace misfit::tools
