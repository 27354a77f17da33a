#include "imager/data/ranks.h"

#include <stdexcept>

namespace misfit::imager {
namespace {

class Alone : public Ranks {
 public:
  int size() const override { return 1; }
  int rank() const override { return 0; }
  int on_this_machine() const override { return 1; }
  int on_these_cores() const override { return 1; }
  void meet() const override {}
  void sum(double*, std::size_t) const override {}
  void sum_at_first(double*, std::size_t) const override {}
  void largest(double*, std::size_t) const override {}
  void share(void*, std::size_t) const override {}
  std::vector<std::string> gather_at_first(const std::string& bytes) const override { return {bytes}; }
  void send(int to, const std::string&) const override { throw_none(to); }
  std::string receive(int from) const override { throw_none(from); }
  std::optional<int> waiting() const override { return {}; }
  Traffic traffic() const override { return {}; }

 private:
  [[noreturn]] static void throw_none(int rank) { throw std::logic_error("there is no rank " + std::to_string(rank)); }
};

}  // namespace

bool pass_along_ranks(int ranks, std::size_t count) {
  std::size_t branches = 0;
  while ((std::size_t{1} << branches) < static_cast<std::size_t>(ranks)) ++branches;
  const std::size_t pieces = (count + chain_piece - 1) / chain_piece;
  return pieces + static_cast<std::size_t>(ranks) <= branches * pieces + 2;
}

const Ranks& alone() {
  static const Alone ranks;
  return ranks;
}

}  // namespace misfit::imager
