#define OMPI_SKIP_MPICXX
#include <mpi.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "tools/mpi/launcher.h"
#include "tools/mpi/world.h"

namespace misfit::tools {
namespace {

/// MPI counts with int, and holds copies of what is reduced.
constexpr std::size_t most_at_once = std::size_t{1} << 22;

/// Calls exchange(first, count) for pieces of `count` values.
template <typename Exchange>
void in_pieces(std::size_t count, const Exchange& exchange) {
  for (std::size_t first = 0; first < count; first += most_at_once)
    exchange(first, static_cast<int>(std::min(most_at_once, count - first)));
}

/// The world of MPI. What fails in it ends the program, with MPI's message.
class MpiRanks : public imager::Ranks {
 public:
  MpiRanks() {
    MPI_Comm_size(MPI_COMM_WORLD, &size_);
    MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
    MPI_Comm here = MPI_COMM_NULL;
    MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, rank_, MPI_INFO_NULL, &here);
    MPI_Comm_size(here, &on_this_machine_);
    MPI_Comm_free(&here);
  }

  int size() const override { return size_; }
  int rank() const override { return rank_; }
  int on_this_machine() const override { return on_this_machine_; }

  void sum(double* values, std::size_t count) const override {
    sum_at_first(values, count);
    share(values, count * sizeof(double));  // so that all have the same bits, whatever the order of the sums
  }
  void sum_at_first(double* values, std::size_t count) const override { reduce(values, count, MPI_SUM); }
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
    std::vector<double> sizes(static_cast<std::size_t>(size_));
    sizes[static_cast<std::size_t>(rank_)] = static_cast<double>(bytes.size());
    sum(sizes.data(), sizes.size());
    count_bytes(bytes.size());
    if (!first()) {
      in_pieces(bytes.size(),
                [&](std::size_t at, int some) { MPI_Send(bytes.data() + at, some, MPI_BYTE, 0, tag, MPI_COMM_WORLD); });
      return {};
    }
    std::vector<std::string> all{bytes};
    for (int from = 1; from < size_; ++from) {
      std::string& theirs = all.emplace_back(static_cast<std::size_t>(sizes[static_cast<std::size_t>(from)]), '\0');
      in_pieces(theirs.size(), [&](std::size_t at, int some) {
        MPI_Recv(theirs.data() + at, some, MPI_BYTE, from, tag, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
      });
    }
    return all;
  }
  imager::Traffic traffic() const override { return traffic_; }

  /// Waits until all are here. MPI itself keeps a core busy while it waits, of which the others' threads may have need.
  void meet() const {
    MPI_Request request = MPI_REQUEST_NULL;
    MPI_Ibarrier(MPI_COMM_WORLD, &request);
    const auto start = std::chrono::steady_clock::now();
    for (int here = 0; MPI_Test(&request, &here, MPI_STATUS_IGNORE), here == 0;)
      if (std::chrono::steady_clock::now() - start > std::chrono::microseconds(200))
        std::this_thread::sleep_for(std::chrono::microseconds(100));
  }

 private:
  static constexpr int tag = 0;

  void reduce(double* values, std::size_t count, MPI_Op how) const {
    meet();
    count_bytes(count * sizeof(double));
    in_pieces(count, [&](std::size_t at, int some) {
      MPI_Reduce(first() ? MPI_IN_PLACE : values + at, values + at, some, MPI_DOUBLE, how, 0, MPI_COMM_WORLD);
    });
  }
  void count_bytes(std::size_t bytes) const {
    ++traffic_.exchanges;
    traffic_.bytes += bytes;
  }

  int size_ = 1;
  int rank_ = 0;
  int on_this_machine_ = 1;
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
  if (was_launched()) mpi_ = std::make_unique<Mpi>();
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
