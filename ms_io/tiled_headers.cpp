#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "ms_io/tiled_headers_internal.h"

namespace misfit::ms_io {
namespace {

namespace fs = std::filesystem;

/// Reads in the order in which casacore (TiledStMan, TSMFile, TSMCube) does.
class TiledHeader {
 public:
  TiledHeader(const std::string& path, const TableFile& table, const StorageManager& manager)
      : rows_(table.rows), columns_(columns_of(table, manager)), manager_(manager.type), bytes_(path), in_(bytes_) {}

  void check() {
    in_.magic();
    const std::uint64_t version = in_.object(manager_);
    if (manager_ == "TiledColumnStMan" || manager_ == "TiledCellStMan") in_.lengths();
    check_common();
    check_cubes();
    if (manager_ == "TiledShapeStMan") check_rows();
    if (manager_ == "TiledDataStMan") check_chunks(version);
  }

 private:
  void check_common() {
    common_version_ = in_.object("TiledStMan");
    const std::size_t size = common_version_ >= 3 ? 8 : 4;
    if (common_version_ >= 2) in_.number(1);
    in_.number(4);
    in_.number(size);
    const std::uint64_t columns = in_.count(4, "columns", 4);
    for (std::uint64_t c = 0; c < columns; ++c) bits_ = std::max(bits_, static_cast<double>(bits_of(in_.number(4))));
    in_.text();
    in_.number(size);
    axes_ = in_.number(4);
    files_.resize(in_.count(size, "files", 1));
    for (std::size_t f = 0; f < files_.size(); ++f)
      if (in_.number(1) != 0) files_[f] = file();
    const std::uint64_t cubes = in_.count(size, "hypercubes", 4);
    for (std::uint64_t c = 0; c < cubes; ++c) check_cube();
  }

  struct Cube {
    std::uint64_t rows = 0;  ///< the length of its last axis
    double cells_a_row = 0;  ///< of all others
  };
  struct File {
    bool exists = false;
    double bytes = 0;
  };

  File file() {
    const std::uint64_t version = in_.number(4), number = in_.number(4);
    in_.number(version == 1 ? 4 : 8);
    std::error_code none;
    const auto bytes = fs::file_size(bytes_.path() + "_TSM" + std::to_string(number), none);
    return {true, none ? 0 : static_cast<double>(bytes)};
  }

  void check_cube() {
    const std::uint64_t version = in_.number(4);
    check_values();
    in_.number(1);
    const std::uint64_t axes = in_.number(4);
    const std::vector<std::int64_t> cube = in_.lengths(), tile = in_.lengths();
    const std::int64_t in_file = in_.integer(4);
    in_.number(version == 1 ? 4 : 8);
    if (cube.size() != axes || tile.size() != axes)
      bytes_.fail(std::to_string(cube.size()) + " and " + std::to_string(tile.size()) + " axes of a hypercube and its tiles",
                  std::to_string(axes) + " of both");
    double elements = 1, tiles = 1;
    double across = 1;
    bool empty = axes == 0;
    for (std::size_t i = 0; i < axes; ++i) {
      if (cube[i] < 0) bytes_.fail("a hypercube of length " + std::to_string(cube[i]), "0 or more");
      if (tile[i] < 1) bytes_.fail("tiles of length " + std::to_string(tile[i]), "1 or more");
      elements *= static_cast<double>(tile[i]);
      tiles *= std::max(1.0, std::ceil(static_cast<double>(cube[i]) / static_cast<double>(tile[i])));
      empty = empty || cube[i] == 0;
      if (i + 1 < axes) across *= static_cast<double>(cube[i]);
    }
    if (!empty) check_shapes(cube);
    cubes_.push_back({empty ? 0 : static_cast<std::uint64_t>(cube.back()), across});
    const File file =
        in_file < 0 || static_cast<std::size_t>(in_file) >= files_.size() ? File() : files_[static_cast<std::size_t>(in_file)];
    if (!empty && !file.exists) bytes_.fail("tiles in file " + std::to_string(in_file), "a file that it has");
    // Some may not have been written yet.
    constexpr double any_bytes = 1 << 24, any_tiles = 1 << 20, longer = 4;
    const double bytes = elements * bits_ / 8, in_all = file.bytes;
    if (bytes > std::max(any_bytes, in_all))
      bytes_.fail("tiles of " + shown(bytes) + " bytes", "no more than their file holds");
    if (tiles > std::max(any_tiles, longer * in_all / bytes))
      bytes_.fail(shown(tiles) + " tiles", "no more than their file holds");
  }

  /// Checks that cells have the shape that their column states. For TiledDataStMan, cells of one axis may be coordinates.
  void check_shapes(std::vector<std::int64_t> cube) const {
    if (cube.size() != axes_)
      bytes_.fail("a hypercube of " + std::to_string(cube.size()) + " axes", std::to_string(axes_) + " as of all");
    if (manager_ != "TiledCellStMan") cube.pop_back();
    for (const StoredColumn& column : columns_) {
      const bool may_be_coordinate = manager_ == "TiledDataStMan" && column.shape.size() < 2;
      if (column.has_shape && !may_be_coordinate && column.shape != cube)
        bytes_.fail("cells of " + column.name + " of another shape", "that of the column in table.dat");
    }
  }

  /// Checks that there are as many hypercubes as casacore looks for, and no rows beyond the table's.
  void check_cubes() const {
    const std::uint64_t fewest = manager_ == "TiledCellStMan" ? rows_ : manager_ == "TiledDataStMan" ? 0 : 1;
    if (cubes_.size() < fewest) bytes_.fail(std::to_string(cubes_.size()) + " hypercubes", std::to_string(fewest) + " or more");
    for (const Cube& cube : cubes_)
      if ((manager_ == "TiledColumnStMan" && cube.rows != rows_ && cube.cells_a_row > 0) ||
          (manager_ == "TiledShapeStMan" && cube.rows > rows_))
        bytes_.fail("a hypercube of " + std::to_string(cube.rows) + " rows", "the table's " + std::to_string(rows_));
  }

  /// Checks the values that tell hypercubes of TiledDataStMan apart; others have none.
  void check_values() {
    if (manager_ == "TiledDataStMan") {
      read_record(in_);
      return;
    }
    in_.object("Record");
    in_.object("RecordDesc");
    if (const std::uint64_t fields = in_.number(4); fields != 0)
      bytes_.fail("hypercubes with " + std::to_string(fields) + " values", "none");
    in_.number(4);
  }

  void check_hypercube(std::uint64_t cube) const {
    if (cube >= cubes_.size())
      bytes_.fail("rows in hypercube " + std::to_string(cube), "one of " + std::to_string(cubes_.size()));
  }
  [[noreturn]] void refuse_rows(std::uint64_t rows, std::uint64_t place, const Cube& cube) const {
    bytes_.fail(std::to_string(rows) + " rows at row " + std::to_string(place) + " of a hypercube",
                "some of its " + std::to_string(cube.rows));
  }

  /// Checks the runs of rows of TiledShapeStMan: the last row of each, and where it lies.
  void check_rows() {
    in_.lengths();
    const std::uint64_t used = in_.number(4);
    const std::vector<std::uint64_t> last = in_.block("last rows"), cube = in_.block("hypercubes"), place = in_.block("places");
    if (const std::size_t all = std::min({last.size(), cube.size(), place.size()}); used > all)
      bytes_.fail(std::to_string(used) + " runs of rows", "no more than the " + std::to_string(all) + " that it has");
    for (std::size_t i = 0; i < used; ++i) {
      check_hypercube(cube[i]);
      const std::uint64_t begin = i == 0 ? 0 : last[i - 1] + 1, rows = last[i] + 1 - begin;
      if (cube[i] != 0 && (last[i] < begin || place[i] >= cubes_[cube[i]].rows || rows > place[i] + 1))
        refuse_rows(rows, place[i], cubes_[cube[i]]);
    }
  }

  /// Checks the chunks of TiledDataStMan: the first row of each, and where it lies; several rows may share a place along the
  /// last axis.
  void check_chunks(std::uint64_t version) {
    const std::uint64_t rows = in_.number(version == 1 && common_version_ < 3 ? 4 : 8);
    if (version == 1) in_.number(4);
    const std::vector<std::uint64_t> first = in_.block("first rows", version == 1 ? 4 : 8), cube = in_.block("hypercubes"),
                                     place = in_.block("places");
    if (first.size() > std::min(cube.size(), place.size()) || (rows > 0 && (first.empty() || first.front() != 0)))
      bytes_.fail(std::to_string(first.size()) + " chunks of rows", "a hypercube and a place for each, from row 0 on");
    for (std::size_t i = 0; i < first.size(); ++i) {
      check_hypercube(cube[i]);
      const std::uint64_t end = i + 1 < first.size() ? first[i + 1] : rows;
      const Cube& in = cubes_[cube[i]];
      const double room = static_cast<double>(in.rows - std::min(in.rows, place[i])) * in.cells_a_row;
      if (end <= first[i] || static_cast<double>(end - first[i]) > room) refuse_rows(end - first[i], place[i], in);
    }
  }

  std::uint64_t rows_;
  std::vector<StoredColumn> columns_;
  std::string manager_;
  StoredBytes bytes_;
  ObjectReader in_;
  std::uint64_t axes_ = 0;
  double bits_ = 0;  ///< of an element of the column that takes most
  std::vector<File> files_;
  std::uint64_t common_version_ = 0;
  std::vector<Cube> cubes_;
};

}  // namespace

void check_tiled_header(const std::string& path, const TableFile& table, const StorageManager& manager) {
  TiledHeader(file_of(path, manager), table, manager).check();
}

}  // namespace misfit::ms_io
