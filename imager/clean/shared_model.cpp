#include "imager/clean/shared_model.h"

#include <utility>
#include <vector>

#include "imager/taylor/taylor_imaging.h"

namespace misfit::imager {
namespace {

/// The message before the scales and components of a model.
struct Announcement {
  bool end = false;
  int width = 0;
  int height = 0;
  int coarser = -1;
};

/// The next model that rank 0 tells of. Returns false at the end.
bool receive(const Ranks& ranks, ComponentModel& model, int& coarser) {
  Announcement next;
  share_values(ranks, next);
  if (next.end) return false;
  coarser = next.coarser;
  std::vector<double> scale_pixels;
  std::vector<Component> components;
  share_list(ranks, scale_pixels);
  share_list(ranks, components);
  model = ComponentModel(next.width, next.height, std::move(scale_pixels));
  model.add(components);
  return true;
}

}  // namespace

void ModelSharer::share(const ComponentModel& model, int coarser) const {
  if (ranks_.alone()) return;
  Announcement next{false, model.width(), model.height(), coarser};
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

ImagedData by_coarser(const ImagedData& imaged, const std::vector<CoarserTransform>& coarser, int which) {
  if (which < 0) return imaged;
  return {imaged.samples, *coarser.at(static_cast<std::size_t>(which)).transform, imaged.normalisation};
}

void follow_clean(const ImagedData& imaged, const std::vector<CoarserTransform>& coarser, const TaylorExpansion& expansion,
                  const Context& context) {
  int which = -1;
  for (ComponentModel model; receive(imaged.samples.source.ranks(), model, which);) {
    std::vector<Image> terms;
    for (int term = 0; term < expansion.terms; ++term) terms.push_back(model.image(context.threads, term));
    make_taylor_residuals(by_coarser(imaged, coarser, which), std::move(terms), expansion, context);
  }
}

}  // namespace misfit::imager
