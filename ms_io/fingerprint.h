#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace misfit::ms_io {

/// A number that differs, but for a chance of 2⁻⁶⁴, where what was added does. It tells changes, not forgeries.
class Fingerprint {
 public:
  Fingerprint& add(const void* bytes, std::size_t count) {
    const char* from = static_cast<const char*>(bytes);
    if (count >= 4 * lane_bytes) {  // four at a time, which need not wait for each other
      std::uint64_t lanes[4] = {state_, 1, 2, 3};
      for (; count >= lane_bytes; count -= lane_bytes, from += lane_bytes) {
        std::uint64_t words[4];
        std::memcpy(words, from, lane_bytes);
        for (int k = 0; k < 4; ++k) lanes[k] = mixed(lanes[k], words[k]);
      }
      for (const std::uint64_t lane : lanes) mix(lane);
    }
    for (; count >= sizeof(std::uint64_t); count -= sizeof(std::uint64_t), from += sizeof(std::uint64_t)) {
      std::uint64_t word = 0;
      std::memcpy(&word, from, sizeof word);
      mix(word);
    }
    std::uint64_t rest = 0;
    std::memcpy(&rest, from, count);
    mix(rest + count);
    return *this;
  }
  Fingerprint& add(std::uint64_t number) {
    mix(number);
    return *this;
  }
  Fingerprint& add(const std::string& text) { return add(text.data(), text.size()).add(text.size()); }
  Fingerprint& add(const std::vector<double>& numbers) {
    return add(numbers.data(), numbers.size() * sizeof(double)).add(numbers.size());
  }

  std::uint64_t value() const { return state_; }

 private:
  static constexpr std::size_t lane_bytes = 4 * sizeof(std::uint64_t);

  static std::uint64_t mixed(std::uint64_t state, std::uint64_t word) {
    state = (state ^ word) * 0x9e3779b97f4a7c15U;  // odd, so that no bit is lost
    return state ^ state >> 29U;
  }
  void mix(std::uint64_t word) { state_ = mixed(state_, word); }

  std::uint64_t state_ = 0x6d69736669740001U;
};

}  // namespace misfit::ms_io
