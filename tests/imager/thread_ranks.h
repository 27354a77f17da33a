#pragma once

#include <algorithm>
#include <barrier>
#include <cmath>
#include <condition_variable>
#include <cstring>
#include <deque>
#include <exception>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "imager/data/ranks.h"
#include "imager/data/stored_visibilities.h"

namespace misfit::imager::testing {

/// Ranks that are threads of one process.
class ThreadRanks {
 public:
  explicit ThreadRanks(int size) : size_(size), barrier_(size), values_(static_cast<std::size_t>(size)) {}

  /// Calls run(ranks) in a thread for each rank, with the ranks as that one sees them. Rethrows what the first of them threw;
  /// they must all throw, or none.
  void run(const std::function<void(const Ranks&)>& run) {
    std::vector<std::thread> threads;
    std::vector<std::exception_ptr> thrown(static_cast<std::size_t>(size_));
    for (int rank = 0; rank < size_; ++rank)
      threads.emplace_back([&, rank] {
        try {
          run(One(*this, rank));
        } catch (...) {
          thrown[static_cast<std::size_t>(rank)] = std::current_exception();
        }
      });
    for (std::thread& thread : threads) thread.join();
    if (thrown.front()) std::rethrow_exception(thrown.front());
  }

 private:
  /// What one rank gives for an exchange.
  struct Given {
    double* values = nullptr;
    void* bytes = nullptr;
    const std::string* text = nullptr;
  };

  class One : public Ranks {
   public:
    One(ThreadRanks& all, int rank) : all_(all), rank_(rank) {}
    int size() const override { return all_.size_; }
    int rank() const override { return rank_; }
    int on_this_machine() const override { return all_.size_; }
    int on_these_cores() const override { return all_.size_; }
    void meet() const override { all_.barrier_.arrive_and_wait(); }
    void sum(double* values, std::size_t count) const override {
      combine(values, count, true, [](double a, double b) { return a + b; });
    }
    void sum_at_first(double* values, std::size_t count) const override {
      combine(values, count, false, [](double a, double b) { return a + b; });
    }
    void largest(double* values, std::size_t count) const override {
      combine(values, count, true, [](double a, double b) { return std::max(a, b); });
    }
    void share(void* bytes, std::size_t count) const override {
      exchange({.bytes = bytes}, [&](const std::vector<Given>& given) {
        if (!first()) std::memcpy(bytes, given.front().bytes, count);
      });
    }
    std::vector<std::string> gather_at_first(const std::string& bytes) const override {
      std::vector<std::string> all;
      exchange({.text = &bytes}, [&](const std::vector<Given>& given) {
        for (const Given& theirs : given)
          if (first()) all.push_back(*theirs.text);
      });
      return all;
    }
    void send(int to, const std::string& bytes) const override { all_.mail(rank_, to).put(bytes); }
    std::string receive(int from) const override { return all_.mail(from, rank_).take(); }
    std::optional<int> waiting() const override {
      for (int from = 0; from < size(); ++from)
        if (!all_.mail(from, rank_).empty()) return from;
      return {};
    }
    Traffic traffic() const override { return {}; }

   private:
    template <typename How>
    void combine(double* values, std::size_t count, bool at_all, const How& how) const {
      std::vector<double> combined(values, values + count);
      exchange({.values = values}, [&](const std::vector<Given>& given) {
        for (std::size_t i = 0; i < count; ++i) {
          combined[i] = given.front().values[i];
          for (std::size_t r = 1; r < given.size(); ++r) combined[i] = how(combined[i], given[r].values[i]);
        }
      });
      const double useless = std::nan("");  // so that whoever uses it is found out
      for (std::size_t i = 0; i < count; ++i) values[i] = at_all || first() ? combined[i] : useless;
    }
    /// All give, and then all take.
    template <typename Take>
    void exchange(const Given& own, const Take& take) const {
      all_.values_[static_cast<std::size_t>(rank_)] = own;
      all_.barrier_.arrive_and_wait();
      take(all_.values_);
      all_.barrier_.arrive_and_wait();
    }

    ThreadRanks& all_;
    int rank_;
  };

  /// What one rank sent another.
  class Mail {
   public:
    void put(const std::string& bytes) {
      const std::lock_guard lock(mutex_);
      bytes_.push_back(bytes);
      there_is_some_.notify_one();
    }
    bool empty() {
      const std::lock_guard lock(mutex_);
      return bytes_.empty();
    }
    std::string take() {
      std::unique_lock lock(mutex_);
      there_is_some_.wait(lock, [&] { return !bytes_.empty(); });
      std::string first = std::move(bytes_.front());
      bytes_.pop_front();
      return first;
    }

   private:
    std::mutex mutex_;
    std::condition_variable there_is_some_;
    std::deque<std::string> bytes_;
  };

  Mail& mail(int from, int to) {
    const std::lock_guard lock(mutex_);
    return mail_[{from, to}];
  }

  int size_;
  std::mutex mutex_;  ///< guards what follows
  std::map<std::pair<int, int>, Mail> mail_;
  std::barrier<> barrier_;
  std::vector<Given> values_;
};

/// Counts the block's samples, those of weight 0 as flagged.
inline void count(VisibilityBlock& block) {
  block.counts = {};
  block.counts.rows_read = block.rows();
  block.counts.samples_read = block.samples();
  for (const float weight : block.weight) ++(weight == 0 ? block.counts.flagged : block.counts.used);
}

/// A rank's part of some blocks: every `size`-th row.
class RankShare : public VisibilitySource {
 public:
  RankShare(const std::vector<VisibilityBlock>& blocks, const Ranks& ranks) : ranks_(ranks) {
    for (const VisibilityBlock& block : blocks) add(block);
  }
  std::unique_ptr<BlockStream> open() const override { return blocks_.open(); }
  std::uint64_t samples() const override { return blocks_.samples(); }
  const Ranks& ranks() const override { return ranks_; }

 private:
  void add(const VisibilityBlock& block) {
    VisibilityBlock part;
    part.frequency_hz = block.frequency_hz;
    const std::size_t channels = block.channels();
    for (auto row = static_cast<std::size_t>(ranks_.rank()); row < block.rows();
         row += static_cast<std::size_t>(ranks_.size())) {
      const auto at = static_cast<std::ptrdiff_t>(row * channels), end = at + static_cast<std::ptrdiff_t>(channels);
      if (!block.sights.empty()) part.sights.push_back(block.sights[row]);
      part.uvw_m.append(&block.uvw_m[3 * row], &block.uvw_m[3 * row] + 3);
      part.visibility.insert(part.visibility.end(), block.visibility.begin() + at, block.visibility.begin() + end);
      part.weight.insert(part.weight.end(), block.weight.begin() + at, block.weight.begin() + end);
    }
    count(part);
    if (part.rows() > 0) blocks_.append(std::make_shared<const VisibilityBlock>(std::move(part)));
  }

  const Ranks& ranks_;
  StoredVisibilities blocks_;
};

}  // namespace misfit::imager::testing
