#pragma once

#include <optional>
#include <string>

#include "imager/cube/channel_map.h"
#include "imager/files/image_writer.h"
#include "tools/run/cube_planes.h"

namespace misfit::tools {

/// What a rank that makes planes of a cube tells rank 0.
struct PlaneMessage {
  enum class Kind {
    next,     ///< it has nothing to do
    image,    ///< a plane of one of the files
    plane,    ///< what came of a plane, whose images came before
    stopped,  ///< the user wants no more
    ended,    ///< it makes no more
  };

  Kind kind = Kind::next;
  int file = 0;  ///< of the image, among those that a cube has
  imager::PlaneIndex at;
  imager::Image image;
  std::optional<imager::Beam> beam;
  CubePlane plane;
};

/// What rank 0 answers.
struct PlaneAnswer {
  bool stop = false;                           ///< the user wants no more
  std::optional<imager::PlaneRange> planes{};  ///< to make next; none where all are given out
};

/// As ranks of one program send them. Throws cereal::Exception for fewer bytes than such a message has.
std::string bytes_of(const PlaneMessage& message);
PlaneMessage plane_message(std::string bytes);
std::string bytes_of(const PlaneAnswer& answer);
PlaneAnswer plane_answer(std::string bytes);

}  // namespace misfit::tools
