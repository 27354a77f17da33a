#include "tools/run/cube_visibilities.h"

#include <algorithm>
#include <atomic>
#include <numeric>
#include <string>

#include "imager/data/handed_over.h"
#include "imager/numerics/parallel.h"
#include "tools/base/interrupt.h"

namespace misfit::tools {

CubeVisibilities::CubeVisibilities(const ms_io::MeasurementSet& set, const imager::CubeSampling& sampling,
                                   const CubeBatches& batches, int threads, bool stops_itself)
    : set_(set), sampling_(sampling), batches_(batches), threads_(threads), stops_itself_(stops_itself) {}

ms_io::FrequencyRange CubeVisibilities::frequencies_of(const imager::PlaneRange& range) const {
  const double first = sampling_.axis.frequency_hz(range.first);
  const double last = sampling_.axis.frequency_hz(range.first + range.count - 1), half = 0.5 * sampling_.axis.width_hz();
  return {std::min(first, last) - half, std::max(first, last) + half};
}

/// What of the set such planes need; null where it has nothing for them. What planes before them need too is counted for those.
std::unique_ptr<ms_io::MeasurementSet> CubeVisibilities::part_of(const imager::PlaneRange& range) const {
  std::optional<ms_io::FrequencyRange> counted;
  if (range.first > 0) counted = frequencies_of({0, range.first});
  return set_.part(frequencies_of(range), counted);
}

std::string CubeVisibilities::numbers_of(const imager::PlaneRange& range) const {
  const std::string of = " of " + std::to_string(sampling_.axis.channels);
  if (range.count == 1) return std::to_string(range.first) + of;
  return std::to_string(range.first) + " to " + std::to_string(range.first + range.count - 1) + of;
}

/// The visibilities of some planes, unless they are there.
void CubeVisibilities::gather(const imager::PlaneRange& batch, ProgressLine& progress, imager::StageTimes& times) {
  if (gathered_) return;
  progress.begin("planes " + numbers_of(batch));
  if (const auto part = part_of(batch)) {
    const auto update = [&](std::uint64_t done, std::uint64_t total) { progress.update(done, total); };
    gathered_ = imager::gather_planes(*part, sampling_, batch, {threads_, &times, update});
  } else {
    gathered_.emplace();
  }
  progress.end();
}

void CubeVisibilities::look_through(const std::vector<imager::PlaneRange>& batches,
                                    const std::function<void(const imager::VisibilitySource&)>& visit, ProgressLine& progress,
                                    imager::StageTimes& times) {
  for (const imager::PlaneRange& batch : batches) {
    if (batches_.read_again) {
      if (const auto part = part_of(batch)) visit(imager::PlaneView(*part, sampling_, batch.first));
      continue;
    }
    gather(batch, progress, times);
    for (int i = 0; i < batch.count; ++i) visit(gathered_->plane(i));
    if (batch.count < sampling_.axis.channels) gathered_.reset();
  }
}

void CubeVisibilities::visit_planes(const PlaneVisitor& visitor, ProgressLine& progress, imager::StageTimes& times) {
  while (!visitor.stopped()) {
    const std::optional<imager::PlaneRange> batch = visitor.next();
    if (!batch) return;
    if (batches_.read_again) {
      progress.begin("image " + numbers_of(*batch), stops_itself_);
      visit_streamed(batch->first, visitor);
      progress.end();
      continue;
    }
    gather(*batch, progress, times);
    count_read(gathered_->counts().read);
    outside_planes_ += gathered_->counts().outside_planes;
    visit_held(*batch, visitor, progress, times);
    gathered_.reset();
  }
}

void CubeVisibilities::visit_held(const imager::PlaneRange& batch, const PlaneVisitor& visitor, ProgressLine& progress,
                                  imager::StageTimes& times) {
  progress.begin("images " + numbers_of(batch), stops_itself_);
  const auto planes = static_cast<std::size_t>(batch.count);
  std::vector<double> taking_s(planes);
  std::atomic<std::uint64_t> done = 0;
  std::atomic<bool> interrupted = false;
  imager::parallel_for(planes, batches_.workers.count, [&](std::size_t i) {
    if (visitor.stopped() || interrupted) return;
    try {
      imager::StoredVisibilities samples;
      imager::add_seconds_of(taking_s[i], [&] { samples = gathered_->take(static_cast<int>(i)); });
      visit_held(batch.first + static_cast<int>(i), std::move(samples), visitor);
      progress.update(++done, planes);
    } catch (const Interrupted&) {  // also one that gave up: what another threw comes before it
      interrupted = true;
    } catch (...) {
      visitor.give_up();
      throw;
    }
  });
  times.add("planes", std::accumulate(taking_s.begin(), taking_s.end(), 0.0) / batches_.workers.count);
  if (interrupted) throw Interrupted();
  progress.end();
}

void CubeVisibilities::visit_held(int channel, imager::StoredVisibilities samples, const PlaneVisitor& visitor) {
  if (samples.samples() == 0) return visitor.leave_empty(channel);
  const imager::HandedOver source(std::move(samples));
  imager::StreamedVisibilities visibilities(source, {.keep = true, .ahead = 0, .uv_reach_lambda = 0});
  visitor.make(channel, visibilities);
}

/// A plane that reads its own visibilities in every pass.
void CubeVisibilities::visit_streamed(int channel, const PlaneVisitor& visitor) {
  const auto part = part_of({channel, 1});
  if (!part) return visitor.leave_empty(channel);
  const imager::PlaneView source(*part, sampling_, channel);
  imager::StreamedVisibilities visibilities(source, {.keep = false, .ahead = 0, .uv_reach_lambda = 0});
  try {
    visitor.make(channel, visibilities);
    count_read(visibilities.counts());
  } catch (const imager::NothingUsable&) {
    visitor.leave_empty(channel);
  }
}

void CubeVisibilities::count_read(imager::SampleCounts counts) {
  counts.used = 0;
  counts_ += counts;
}

}  // namespace misfit::tools
