#include "imager/clean/shared_model.h"

#include <utility>
#include <vector>

#include "imager/taylor/taylor_imaging.h"

namespace misfit::imager {
namespace {

/// What precedes the scales and components of a model.
struct Announcement {
  bool end = false;
  int width = 0;
  int height = 0;
};

/// The next model that rank 0 tells of. Returns false at the end.
bool receive(const Ranks& ranks, ComponentModel& model) {
  Announcement next;
  share_values(ranks, next);
  if (next.end) return false;
  std::vector<double> scale_pixels;
  std::vector<Component> components;
  share_list(ranks, scale_pixels);
  share_list(ranks, components);
  model = ComponentModel(next.width, next.height, std::move(scale_pixels));
  model.add(components);
  return true;
}

}  // namespace

void ModelSharer::share(const ComponentModel& model) const {
  if (ranks_.alone()) return;
  Announcement next{false, model.width(), model.height()};
  share_values(ranks_, next);
  std::vector<double> scale_pixels = model.scale_pixels();
  std::vector<Component> components = model.components();
  share_list(ranks_, scale_pixels);
  share_list(ranks_, components);
}

void ModelSharer::end() const {
  Announcement next{.end = true};
  share_values(ranks_, next);
}

void follow_clean(const ImagedData& imaged, const TaylorExpansion& expansion, const Context& context) {
  for (ComponentModel model; receive(imaged.samples.source.ranks(), model);) {
    std::vector<Image> terms;
    for (int term = 0; term < expansion.terms; ++term) terms.push_back(model.image(context.threads, term));
    make_taylor_residuals(imaged, std::move(terms), expansion, context);
  }
}

}  // namespace misfit::imager
