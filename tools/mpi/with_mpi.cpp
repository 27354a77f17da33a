#define OMPI_SKIP_MPICXX
#include <mpi.h>
#include <sched.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <mutex>
#include <stdexcept>
#include <thread>

#include "tools/mpi/launcher.h"
#include "tools/mpi/world.h"

namespace misfit::tools {
namespace {

using imager::chain_piece;

/// The most numbers in one call: MPI counts with int, and holds copies of the numbers that it reduces, which should fit a
/// cache.
constexpr std::size_t most_at_once = std::size_t{1} << 20;

/// Calls exchange(first, count) for pieces of `count` values.
template <typename Exchange>
void in_pieces(std::size_t count, const Exchange& exchange) {
  for (std::size_t first = 0; first < count; first += most_at_once)
    exchange(first, static_cast<int>(std::min(most_at_once, count - first)));
}

/// The ranks of MPI's world. A failure in MPI ends the program, with MPI's message.
class MpiRanks : public imager::Ranks {
 public:
  MpiRanks() {
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm here = MPI_COMM_NULL;
    MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, rank_, MPI_INFO_NULL, &here);
    MPI_Comm_size(here, &on_this_machine_);
    count_on_these_cores(here);
    MPI_Comm_free(&here);
  }

  int size() const override { return size_; }
  int rank() const override { return rank_; }
  int on_this_machine() const override { return on_this_machine_; }
  int on_these_cores() const override { return on_these_cores_; }

  void meet() const override {
    wait([](MPI_Request* request) { MPI_Ibarrier(MPI_COMM_WORLD, request); });
  }
  void sum(double* values, std::size_t count) const override {
    sum_at_first(values, count);
    share(values, count * sizeof(double));  // so that all have the same bits, whatever the order of the sums
  }
  void sum_at_first(double* values, std::size_t count) const override {
    imager::pass_along_ranks(size_, count) ? sum_along_ranks(values, count) : reduce(values, count, MPI_SUM);
  }
  void largest(double* values, std::size_t count) const override {
    reduce(values, count, MPI_MAX);
    share(values, count * sizeof(double));
  }
  void share(void* bytes, std::size_t count) const override {
    meet();
    count_bytes(count);
    in_pieces(count, [&](std::size_t first, int some) {
      MPI_Bcast(static_cast<char*>(bytes) + first, some, MPI_BYTE, 0, MPI_COMM_WORLD);
    });
  }
  std::vector<std::string> gather_at_first(const std::string& bytes) const override {
    if (!first()) {
      send(0, bytes);
      return {};
    }
    std::vector<std::string> all{bytes};
    for (int from = 1; from < size_; ++from) all.push_back(receive(from));
    return all;
  }
  void send(int to, const std::string& bytes) const override {
    count_bytes(bytes.size());
    std::uint64_t size = bytes.size();
    wait([&](MPI_Request* request) { MPI_Isend(&size, sizeof size, MPI_BYTE, to, tag, MPI_COMM_WORLD, request); });
    in_pieces(bytes.size(), [&](std::size_t at, int some) {
      wait([&](MPI_Request* request) { MPI_Isend(bytes.data() + at, some, MPI_BYTE, to, tag, MPI_COMM_WORLD, request); });
    });
  }
  std::string receive(int from) const override {
    std::uint64_t size = 0;
    wait([&](MPI_Request* request) { MPI_Irecv(&size, sizeof size, MPI_BYTE, from, tag, MPI_COMM_WORLD, request); });
    std::string bytes(size, '\0');
    in_pieces(bytes.size(), [&](std::size_t at, int some) {
      wait([&](MPI_Request* request) { MPI_Irecv(bytes.data() + at, some, MPI_BYTE, from, tag, MPI_COMM_WORLD, request); });
    });
    return bytes;
  }
  std::optional<int> waiting() const override {
    const std::lock_guard lock(one_at_a_time_);
    int there = 0;
    MPI_Status status;
    MPI_Iprobe(MPI_ANY_SOURCE, tag, MPI_COMM_WORLD, &there, &status);
    return there != 0 ? std::optional(status.MPI_SOURCE) : std::nullopt;
  }
  imager::Traffic traffic() const override {
    const std::lock_guard lock(one_at_a_time_);
    return traffic_;
  }

 private:
  static constexpr int tag = 0, chain_tag = 1;

  /// A launcher may bind ranks to cores, several of them to the same.
  void count_on_these_cores(MPI_Comm here) {
    std::vector<cpu_set_t> all(static_cast<std::size_t>(on_this_machine_));
    cpu_set_t own;
    CPU_ZERO(&own);
    sched_getaffinity(0, sizeof own, &own);
    MPI_Allgather(&own, sizeof own, MPI_BYTE, all.data(), sizeof own, MPI_BYTE, here);
    on_these_cores_ = 0;
    for (const cpu_set_t& other : all) {
      cpu_set_t both;
      CPU_AND(&both, &own, &other);
      on_these_cores_ += CPU_COUNT(&both) > 0 ? 1 : 0;
    }
    on_these_cores_ = std::max(1, on_these_cores_);
  }

  /// Begins something and waits for its end. MPI itself keeps a core busy while it waits, which other ranks' threads may need.
  /// Several threads may wait; MPI is called by one at a time.
  template <typename Begin>
  void wait(const Begin& begin) const {
    MPI_Request request = MPI_REQUEST_NULL;
    {
      const std::lock_guard lock(one_at_a_time_);
      begin(&request);
    }
    const auto start = std::chrono::steady_clock::now();
    for (int over = 0; over == 0;) {
      {
        const std::lock_guard lock(one_at_a_time_);
        MPI_Test(&request, &over, MPI_STATUS_IGNORE);
      }
      if (over == 0 && std::chrono::steady_clock::now() - start > std::chrono::microseconds(200))
        std::this_thread::sleep_for(std::chrono::microseconds(100));
    }
  }

  /// Each rank adds its numbers to those that it gets from the next rank, and sends the sums to the rank before, a piece at a
  /// time. Pieces follow each other on their way to rank 0, so that all ranks receive and send the numbers once, at the same
  /// time. In a tree, as MPI_Reduce makes it, rank 0 receives them from each of its branches.
  void sum_along_ranks(double* values, std::size_t count) const {
    constexpr std::size_t ahead = 2;
    meet();
    count_bytes(first() ? 0 : count * sizeof(double));
    const bool gets = rank_ + 1 < size_;
    const std::size_t pieces = (count + chain_piece - 1) / chain_piece;
    const auto length = [&](std::size_t piece) { return static_cast<int>(std::min(chain_piece, count - piece * chain_piece)); };
    std::array<std::vector<double>, ahead> theirs;
    std::array<MPI_Request, ahead> coming{MPI_REQUEST_NULL, MPI_REQUEST_NULL};
    MPI_Request going = MPI_REQUEST_NULL;
    const auto expect = [&](std::size_t piece) {
      if (!gets || piece >= pieces) return;
      theirs[piece % ahead].resize(chain_piece);
      MPI_Irecv(theirs[piece % ahead].data(), length(piece), MPI_DOUBLE, rank_ + 1, chain_tag, MPI_COMM_WORLD,
                &coming[piece % ahead]);
    };
    for (std::size_t piece = 0; piece < ahead; ++piece) expect(piece);
    for (std::size_t piece = 0; piece < pieces; ++piece) {
      double* const own = values + piece * chain_piece;
      if (gets) {
        MPI_Wait(&coming[piece % ahead], MPI_STATUS_IGNORE);
        const double* const their = theirs[piece % ahead].data();
        for (int i = 0; i < length(piece); ++i) own[i] += their[i];
        expect(piece + ahead);
      }
      if (first()) continue;
      MPI_Wait(&going, MPI_STATUS_IGNORE);
      MPI_Isend(own, length(piece), MPI_DOUBLE, rank_ - 1, chain_tag, MPI_COMM_WORLD, &going);
    }
    MPI_Wait(&going, MPI_STATUS_IGNORE);
  }

  void reduce(double* values, std::size_t count, MPI_Op how) const {
    meet();
    count_bytes(count * sizeof(double));
    in_pieces(count, [&](std::size_t at, int some) {
      MPI_Reduce(first() ? MPI_IN_PLACE : values + at, values + at, some, MPI_DOUBLE, how, 0, MPI_COMM_WORLD);
    });
  }
  void count_bytes(std::size_t bytes) const {
    const std::lock_guard lock(one_at_a_time_);
    ++traffic_.exchanges;
    traffic_.bytes += bytes;
  }

  int size_ = 1;
  int rank_ = 0;
  int on_this_machine_ = 1;
  int on_these_cores_ = 1;
  mutable std::mutex one_at_a_time_;  ///< guards calls of MPI, and the members below
  mutable imager::Traffic traffic_;
};

}  // namespace

class World::Mpi {
 public:
  Mpi() {
    int given = 0;
    MPI_Init_thread(nullptr, nullptr, MPI_THREAD_SERIALIZED, &given);
    ranks_ = std::make_unique<MpiRanks>();
  }
  ~Mpi() {
    ranks_->meet();
    MPI_Finalize();
  }
  const MpiRanks& ranks() const { return *ranks_; }

 private:
  std::unique_ptr<MpiRanks> ranks_;
};

World::World() {
  if (!was_launched()) return;
  mpi_ = std::make_unique<Mpi>();
  if (const int size = launched(); mpi_->ranks().alone() && size > 1)
    throw std::runtime_error(
        "misfit was started as one of " + std::to_string(size) + " processes by a launcher that " + mpi_version() +
        " does not understand, so that each would write the same files; expected its own mpirun, or " + "srun --mpi=pmix");
}

World::~World() = default;

const imager::Ranks& World::ranks() const {
  return mpi_ ? static_cast<const imager::Ranks&>(mpi_->ranks()) : imager::alone();
}

void World::end_all(int exit_code) const {
  if (mpi_ && !mpi_->ranks().alone()) MPI_Abort(MPI_COMM_WORLD, exit_code);
}

std::string mpi_version() {
  char text[MPI_MAX_LIBRARY_VERSION_STRING] = {};
  int length = 0;
  MPI_Get_library_version(text, &length);
  const std::string version(text, static_cast<std::size_t>(length));
  return version.substr(0, version.find(','));
}

}  // namespace misfit::tools
