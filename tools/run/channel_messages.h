#pragma once

#include <optional>
#include <string>

#include "imager/cube/channel_map.h"
#include "imager/files/image_writer.h"
#include "tools/run/channel_run.h"

namespace misfit::tools {

/// A message to rank 0 from another rank that makes channels.
struct ChannelMessage {
  enum class Kind {
    next,     ///< it has nothing to do
    image,    ///< a plane of one of the images
    channel,  ///< the results of a channel, whose images came before
    stopped,  ///< the user wants no more
    ended,    ///< it makes no more
  };

  Kind kind = Kind::next;
  std::string image_kind{};
  imager::PlaneIndex at{};
  imager::Image image{};
  std::optional<imager::Beam> beam{};
  MadeChannel channel{};
};

/// The answer of rank 0.
struct ChannelAnswer {
  bool stop = false;                             ///< the user wants no more
  std::optional<imager::PlaneRange> channels{};  ///< to make next; none where all are given out
};

/// Messages and answers as ranks of one program send them. Throws cereal::Exception for fewer bytes than a message has.
std::string bytes_of(const ChannelMessage& message);
ChannelMessage channel_message(std::string bytes);
std::string bytes_of(const ChannelAnswer& answer);
ChannelAnswer channel_answer(std::string bytes);

}  // namespace misfit::tools
