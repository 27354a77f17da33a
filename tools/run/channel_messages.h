#pragma once

#include <optional>
#include <string>

#include "imager/cube/channel_map.h"
#include "imager/files/image_writer.h"
#include "tools/run/channel_run.h"

namespace misfit::tools {

/// What a rank that makes channels tells rank 0.
struct ChannelMessage {
  enum class Kind {
    next,     ///< it has nothing to do
    image,    ///< a plane of one of the images
    channel,  ///< what came of a channel, whose images came before
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

/// What rank 0 answers.
struct ChannelAnswer {
  bool stop = false;                             ///< the user wants no more
  std::optional<imager::PlaneRange> channels{};  ///< to make next; none where all are given out
};

/// As ranks of one program send them. Throws cereal::Exception for fewer bytes than such a message has.
std::string bytes_of(const ChannelMessage& message);
ChannelMessage channel_message(std::string bytes);
std::string bytes_of(const ChannelAnswer& answer);
ChannelAnswer channel_answer(std::string bytes);

}  // namespace misfit::tools
