#include "tools/run/sharing.h"

#include <algorithm>

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

}  // namespace

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

imager::Decision traffic_decision(const imager::Traffic& traffic, double seconds) {
  return {"exchanged among ranks", mib_text(static_cast<double>(traffic.bytes)),
          grouped(static_cast<long long>(traffic.exchanges)) + " exchanges, in " + duration(seconds) +
              " of rank 0, waiting for others included"};
}

imager::Decision channel_traffic_decision(const imager::Traffic& traffic) {
  return {"exchanged among ranks", mib_text(static_cast<double>(traffic.bytes)),
          grouped(static_cast<long long>(traffic.exchanges)) + " messages: batches to make, and the images that come of them"};
}

}  // namespace misfit::tools
