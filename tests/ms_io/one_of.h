#pragma once

#include <optional>
#include <string>
#include <vector>

#include "imager/data/ranks.h"

namespace misfit::ms_io::testing {

/// One of several ranks, which exchanges nothing.
class OneOf : public imager::Ranks {
 public:
  OneOf(int rank, int size) : rank_(rank), size_(size) {}
  int size() const override { return size_; }
  int rank() const override { return rank_; }
  int on_this_machine() const override { return size_; }
  int on_these_cores() const override { return size_; }
  void meet() const override {}
  void sum(double*, std::size_t) const override {}
  void sum_at_first(double*, std::size_t) const override {}
  void largest(double*, std::size_t) const override {}
  void share(void*, std::size_t) const override {}
  std::vector<std::string> gather_at_first(const std::string&) const override { return {}; }
  void send(int, const std::string&) const override {}
  std::string receive(int) const override { return ""; }
  std::optional<int> waiting() const override { return {}; }
  imager::Traffic traffic() const override { return {}; }

 private:
  int rank_, size_;
};

}  // namespace misfit::ms_io::testing
