#include "tools/run/cube_turns.h"

#include <utility>

#include "tools/base/in_order.h"
#include "tools/base/interrupt.h"

namespace misfit::tools {

/// What it takes to make planes.
struct CubeTurns::Work {
  CubeVisibilities& visibilities;
  CubePlanes& planes;
  ProgressLine& progress;
  imager::StageTimes& times;
};

std::unique_ptr<imager::ImageWriter> CubeTurns::open(const std::function<std::unique_ptr<imager::ImageWriter>()>& write) {
  return ranks_.first() ? write() : first_rank_.open();
}

std::vector<imager::PlaneRange> CubeTurns::own_batches() const {
  std::vector<imager::PlaneRange> own;
  const auto size = static_cast<std::size_t>(ranks_.size());
  for (auto b = static_cast<std::size_t>(ranks_.rank()); b < batches_.size(); b += size) own.push_back(batches_[b]);
  return own;
}

bool CubeTurns::make(CubeVisibilities& visibilities, CubePlanes& planes, const std::function<void(CubePlane&&)>& take,
                     ProgressLine& progress, imager::StageTimes& times) {
  const Work work{visibilities, planes, progress, times};
  ranks_.first() ? make_for_all(work, take) : make_for_first(work);
  return stopped_;
}

void CubeTurns::make_for_all(const Work& work, const std::function<void(CubePlane&&)>& take) {
  InOrder<CubePlane> in_order([&](int, CubePlane&& plane) { take(std::move(plane)); });
  const auto put = [&](CubePlane&& plane) {
    if (plane.stopped()) stopped_ = true;
    const int channel = plane.report.channel;
    in_order.put(channel, std::move(plane));
  };
  const auto write = [&](int file, const imager::PlaneIndex& at, const imager::Image& image,
                         const std::optional<imager::Beam>& beam) {
    work.planes.products().files().write_sent(file, at, image, beam);
  };
  PlaneDealer dealer(
      ranks_, batches_,
      {write, put, [this] { stopped_ = true; }, [this] { return stopped_.load(); }, [&] { work.planes.give_up(); }});
  visit(
      work, [&] { return dealer.next(); }, put);
  dealer.finish();
  in_order.flush();
}

void CubeTurns::make_for_first(const Work& work) {
  const auto put = [this](CubePlane&& plane) {
    if (plane.stopped()) stopped_ = true;
    first_rank_.put(std::move(plane));
    if (first_rank_.stopped()) stopped_ = true;
  };
  visit(
      work, [this] { return first_rank_.next(); }, put);
  if (stopped_) first_rank_.stop();
  first_rank_.end();
}

void CubeTurns::visit(const Work& work, const std::function<std::optional<imager::PlaneRange>()>& next,
                      const std::function<void(CubePlane&&)>& put) {
  const auto make = [&](int channel, imager::StreamedVisibilities& samples) { put(work.planes.make(channel, samples)); };
  const auto leave_empty = [&](int channel) { put(work.planes.empty(channel)); };
  try {
    work.visibilities.visit_planes(
        {next, make, leave_empty, [this] { return stopped_.load(); }, [&] { work.planes.give_up(); }}, work.progress,
        work.times);
  } catch (const Interrupted&) {
    stopped_ = true;
  }
}

}  // namespace misfit::tools
