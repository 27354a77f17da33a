#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

namespace misfit::imager {

/// The messages among ranks, counted.
struct Traffic {
  std::uint64_t exchanges = 0;
  std::uint64_t bytes = 0;  ///< that one rank gave
};

/// The numbers of an image that pass from rank to rank in one piece, where images are added up on their way to rank 0.
inline constexpr std::size_t chain_piece = std::size_t{1} << 18;

/// True if the sum of `count` numbers reaches rank 0 sooner along a chain of all ranks, in pieces that follow each other, than
/// in a binomial tree, where rank 0 takes numbers in from each of its branches.
bool pass_along_ranks(int ranks, std::size_t count);

/// The processes of a run that share its samples, "ranks" as MPI has them. Each has a part of the samples and computes with it;
/// all get the sums over the parts, so that all decide alike and go on together. All functions but send(), receive() and
/// waiting() are called by all ranks, in the same order, from one thread at a time. A failed exchange ends the run.
class Ranks {
 public:
  virtual ~Ranks() = default;
  virtual int size() const = 0;
  /// The number of this rank, from 0.
  virtual int rank() const = 0;
  /// The number of ranks on this rank's machine, and the number of these that may run on its cores; itself included.
  virtual int on_this_machine() const = 0;
  virtual int on_these_cores() const = 0;
  bool alone() const { return size() == 1; }
  /// True if this is rank 0, which alone prints and writes.
  bool first() const { return rank() == 0; }

  /// Waits until all are here.
  virtual void meet() const = 0;
  /// Adds up `count` numbers of each rank, element by element; all ranks get the same bits.
  virtual void sum(double* values, std::size_t count) const = 0;
  /// Adds up numbers likewise, for rank 0 alone; the values of others are undefined afterwards.
  virtual void sum_at_first(double* values, std::size_t count) const = 0;
  /// The largest of each number over all ranks; all ranks get the same bits.
  virtual void largest(double* values, std::size_t count) const = 0;
  /// Copies rank 0's bytes to all ranks; each has room for as many bytes.
  virtual void share(void* bytes, std::size_t count) const = 0;
  /// The bytes of each rank [rank], at rank 0; nothing at others.
  virtual std::vector<std::string> gather_at_first(const std::string& bytes) const = 0;
  /// Sends bytes to another rank, which waits for them in receive(). Any thread may call send() and receive(), one at a time
  /// for each rank.
  virtual void send(int to, const std::string& bytes) const = 0;
  virtual std::string receive(int from) const = 0;
  /// A rank whose message waits for receive(); none where nobody has sent one.
  virtual std::optional<int> waiting() const = 0;
  /// The traffic so far.
  virtual Traffic traffic() const = 0;
};

/// The one process of a run that shares with nobody.
const Ranks& alone();

/// Adds up numbers over all ranks. Counts are exact up to 2^53.
template <typename... Number>
void sum_over(const Ranks& ranks, Number&... values) {
  if (ranks.alone()) return;
  double all[] = {static_cast<double>(values)...};
  ranks.sum(all, sizeof...(values));
  std::size_t next = 0;
  ((values = static_cast<Number>(all[next++])), ...);
}

/// The largest over all ranks.
inline double largest_of(const Ranks& ranks, double value) {
  ranks.largest(&value, 1);
  return value;
}

/// True if `here` is true on any rank.
inline bool any_of(const Ranks& ranks, bool here) {
  return largest_of(ranks, here ? 1 : 0) > 0;
}

/// Gives all ranks the values of rank 0.
template <typename... Value>
void share_values(const Ranks& ranks, Value&... values) {
  static_assert((std::is_trivially_copyable_v<Value> && ...));
  if (!ranks.alone()) (ranks.share(&values, sizeof values), ...);
}

/// Gives all ranks the list of rank 0.
template <typename Value>
void share_list(const Ranks& ranks, std::vector<Value>& values) {
  static_assert(std::is_trivially_copyable_v<Value>);
  if (ranks.alone()) return;
  std::size_t count = values.size();
  share_values(ranks, count);
  values.resize(count);
  ranks.share(values.data(), count * sizeof(Value));
}

/// The lists of all ranks one after the other, at rank 0; nothing at others.
template <typename Value>
std::vector<Value> join_at_first(const Ranks& ranks, const std::vector<Value>& values) {
  static_assert(std::is_trivially_copyable_v<Value>);
  if (ranks.alone()) return values;
  std::vector<Value> all;
  for (const std::string& bytes :
       ranks.gather_at_first(std::string(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(Value)))) {
    const std::size_t before = all.size();
    all.resize(before + bytes.size() / sizeof(Value));
    if (!bytes.empty()) std::memcpy(all.data() + before, bytes.data(), bytes.size());
  }
  return all;
}

}  // namespace misfit::imager
