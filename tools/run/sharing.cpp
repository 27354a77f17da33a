#include "tools/run/sharing.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "tools/base/json_text.h"
#include "tools/base/memory.h"
#include "tools/base/numbers.h"

namespace misfit::tools {
namespace {

std::string mib_text(double bytes) {
  return significant(bytes / (1 << 20), 3) + " MiB";
}

std::string parts_text(const ms_io::SampleSharing& sharing) {
  if (!sharing.whole_sets) return "a range of rows each";
  return sharing.sets < sharing.samples.size() ? "a set each, as far as there are some" : "whole sets each";
}

/// The option in which another rank differs from rank 0, in words; empty where they agree.
std::string unlike_option(const nlohmann::json& first, const nlohmann::json& others, std::size_t rank) {
  const std::set<std::string> own{"threads", "memory", "quiet"};
  for (const auto& [name, value] : others.items())
    if (const nlohmann::json expected = first.value(name, nlohmann::json()); own.count(name) == 0 && value != expected)
      return "--" + name + " " + json_text(value) + " of rank " + std::to_string(rank) + ": expected " + json_text(expected) +
             ", which rank 0 has; only --threads, --memory and --quiet may differ";
  return "";
}

void give_image(const imager::Ranks& ranks, imager::Image& image) {
  imager::share_values(ranks, image.width, image.height);
  imager::share_list(ranks, image.pixel);
}

}  // namespace

std::unique_ptr<ms_io::MeasurementSet> Sharing::own_part(const ms_io::MeasurementSet& set) const {
  if (of_channels_ || ranks_.alone()) return nullptr;
  return set.share(ranks_);
}

ms_io::SetReach Sharing::reach(const ms_io::MeasurementSet& own) const {
  return of_channels_ && !ranks_.alone() ? own.share(ranks_)->reach() : own.reach();
}

double Sharing::all_samples(double own) const {
  if (!of_channels_) imager::sum_over(ranks_, own);
  return own;
}

void Sharing::require_same(const nlohmann::json& option_values) const {
  if (ranks_.alone()) return;
  std::string unlike;
  const std::vector<std::string> all = ranks_.gather_at_first(json_text(option_values));
  for (std::size_t rank = 1; rank < all.size() && unlike.empty(); ++rank)
    unlike = unlike_option(option_values, nlohmann::json::parse(all[rank]), rank);
  std::vector<char> words(unlike.begin(), unlike.end());
  imager::share_list(ranks_, words);
  if (!words.empty()) throw std::invalid_argument(std::string(words.begin(), words.end()));
}

void Sharing::give_models(std::size_t stokes, int terms, std::vector<imager::CleanResult>& cleaned) const {
  if (ranks_.alone()) return;
  cleaned.resize(stokes);
  for (imager::CleanResult& result : cleaned) {
    result.further_models.resize(static_cast<std::size_t>(terms - 1));
    give_image(ranks_, result.model);
    for (imager::Image& further : result.further_models) give_image(ranks_, further);
  }
}

imager::Decision Sharing::traffic_decision(const imager::StageTimes& times) const {
  imager::Traffic all = ranks_.traffic();
  if (of_channels_) imager::sum_over(ranks_, all.bytes, all.exchanges);
  const std::string exchanges = grouped(static_cast<long long>(all.exchanges));
  return {"exchanged among ranks", mib_text(static_cast<double>(all.bytes)),
          of_channels_ ? exchanges + " messages: batches to make, and the images that come of them"
                       : exchanges + " exchanges, in " + duration(times.of(imager::stage::exchange)) +
                             " of rank 0, waiting for others included"};
}

ExchangeForecast exchange_of(double pixels, int images, int residuals) {
  return {sizeof(double) * pixels * images, sizeof(double) * pixels * residuals};
}

imager::Decision sharing_decision(const ms_io::SampleSharing& sharing, const ExchangeForecast& exchange) {
  const auto [least, most] = std::minmax_element(sharing.samples.begin(), sharing.samples.end());
  const std::string samples = grouped(static_cast<long long>(*least)) +
                              (*least == *most ? "" : " to " + grouped(static_cast<long long>(*most))) + " samples";
  return {"shared among ranks", std::to_string(sharing.samples.size()) + ", " + parts_text(sharing),
          samples + " each; images come to rank 0, which cleans and writes: each other rank gives " +
              mib_text(exchange.first_bytes) + " for PSF and dirty image, and " + mib_text(exchange.cycle_bytes) +
              " a major cycle, for which it gets the model's components"};
}

double channel_bytes(const RunWork& work) {
  return sizeof(double) * work.pixels * work.images;
}

imager::Decision channel_sharing_decision(int ranks, int channels, int channels_of_a_batch, double channel_bytes) {
  const std::string idle =
      channels >= ranks ? ""
                        : "; " + std::to_string(ranks - channels) + " of the ranks have nothing to do, as there are few planes";
  return {"shared among ranks",
          std::to_string(ranks) + ", which take " +
              (channels_of_a_batch == 1 ? "a plane" : std::to_string(channels_of_a_batch) + " planes") + " at a time",
          "planes do not need each other: whoever is free takes the next and reads its channels alone; images come to rank 0, "
          "which writes, " +
              mib_text(channel_bytes) + " a plane" + idle};
}

}  // namespace misfit::tools
