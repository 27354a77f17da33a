#pragma once

#include <cereal/archives/binary.hpp>
#include <sstream>
#include <string>

namespace misfit::tools {

/// A thing as the bytes that processes of one program send each other, by cereal, which must know it.
template <typename Thing>
std::string packed(const Thing& thing) {
  std::ostringstream bytes;
  cereal::BinaryOutputArchive archive(bytes);
  archive(thing);
  return std::move(bytes).str();
}

/// The thing that packed() made `bytes` of. Throws cereal::Exception where there are fewer bytes than the thing has.
template <typename Thing>
Thing unpacked(std::string packed) {
  std::istringstream bytes(std::move(packed));
  cereal::BinaryInputArchive archive(bytes);
  Thing thing;
  archive(thing);
  return thing;
}

}  // namespace misfit::tools
