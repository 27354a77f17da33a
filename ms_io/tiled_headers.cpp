#include <casacore/casa/Utilities/DataType.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <vector>

#include "ms_io/tiled_headers_internal.h"

namespace misfit::ms_io {
namespace {

namespace fs = std::filesystem;

/// Thrown where the bytes end or are not what a header has.
struct NoHeader {};

/// What casacore's AipsIO writes: numbers with the highest byte first, and objects that begin with their length, their type and
/// its version.
class ObjectBytes {
 public:
  ObjectBytes(const std::string& path, std::string bytes) : path_(path), bytes_(std::move(bytes)) {}

  [[noreturn]] void fail(const std::string& tells, const std::string& expected) const {
    throw std::runtime_error("cannot read " + path_ + ": it tells of " + tells + ", expected " + expected);
  }

  std::uint64_t number(std::size_t size) {
    if (size > left()) throw NoHeader();
    std::uint64_t value = 0;
    for (const std::size_t end = at_ + size; at_ < end; ++at_) value = value << 8 | static_cast<unsigned char>(bytes_[at_]);
    return value;
  }
  std::int64_t integer(std::size_t size) {
    const std::uint64_t value = number(size);
    return size == 4 ? static_cast<std::int32_t>(value) : static_cast<std::int64_t>(value);
  }
  /// A number of things that take as many bytes each, at least.
  std::uint64_t count(std::size_t size, const std::string& things, std::size_t bytes_each) {
    const std::uint64_t counted = number(size);
    if (counted > left() / bytes_each) fail(std::to_string(counted) + " " + things, "no more than it holds");
    return counted;
  }
  std::string text() {
    const std::size_t length = count(4, "letters", 1);
    at_ += length;
    return bytes_.substr(at_ - length, length);
  }
  void skip_object() {
    const std::size_t begin = at_, length = number(4);
    if (length < 4 || length > bytes_.size() - begin)
      fail("an object of " + std::to_string(length) + " bytes", "no more than it holds");
    at_ = begin + length;
  }
  /// Begins an object of that type; its version.
  std::uint64_t object(const std::string& type) {
    number(4);
    if (text() != type) throw NoHeader();
    return number(4);
  }

 private:
  std::uint64_t left() const { return bytes_.size() - at_; }

  std::string path_;
  std::string bytes_;
  std::size_t at_ = 0;
};

double bits_of(std::uint64_t data_type) {
  switch (data_type) {
    case casacore::TpBool:
      return 1;
    case casacore::TpChar:
    case casacore::TpUChar:
      return 8;
    case casacore::TpShort:
    case casacore::TpUShort:
      return 16;
    case casacore::TpDouble:
    case casacore::TpComplex:
    case casacore::TpInt64:
      return 64;
    case casacore::TpDComplex:
      return 128;
    default:
      return 32;
  }
}

/// Reads in the order in which casacore (TiledStMan, TSMFile, TSMCube) does.
class TiledHeader {
 public:
  TiledHeader(const std::string& path, std::string bytes) : path_(path), in_(path, std::move(bytes)) {}

  void check() {
    constexpr std::uint64_t magic = 0xbebebebe;
    if (in_.number(4) != magic) throw NoHeader();
    in_.number(4);
    const std::string manager = in_.text();
    may_have_values_ = manager == "TiledDataStMan";
    in_.number(4);
    if (manager == "TiledColumnStMan" || manager == "TiledCellStMan") lengths();
    check_common();
    if (manager == "TiledShapeStMan") check_rows();
  }

 private:
  std::vector<std::int64_t> lengths() {
    const std::size_t size = in_.object("IPosition") == 1 ? 4 : 8;
    std::vector<std::int64_t> all(in_.count(4, "axes", size));
    for (std::int64_t& length : all) length = in_.integer(size);
    return all;
  }

  void check_common() {
    const std::uint64_t version = in_.object("TiledStMan");
    const std::size_t size = version >= 3 ? 8 : 4;
    if (version >= 2) in_.number(1);
    in_.number(4);
    in_.number(size);
    const std::uint64_t columns = in_.count(4, "columns", 4);
    for (std::uint64_t c = 0; c < columns; ++c) bits_ = std::max(bits_, bits_of(in_.number(4)));
    in_.text();
    in_.number(size);
    in_.number(4);
    files_.resize(in_.count(size, "files", 1));
    for (std::size_t f = 0; f < files_.size(); ++f)
      if (in_.number(1) != 0) files_[f] = file();
    const std::uint64_t cubes = in_.count(size, "hypercubes", 4);
    for (std::uint64_t c = 0; c < cubes; ++c) check_cube();
  }

  struct File {
    bool exists = false;
    double bytes = 0;
  };

  File file() {
    const std::uint64_t version = in_.number(4), number = in_.number(4);
    in_.number(version == 1 ? 4 : 8);
    std::error_code none;
    const auto bytes = fs::file_size(path_ + "_TSM" + std::to_string(number), none);
    return {true, none ? 0 : static_cast<double>(bytes)};
  }

  void check_cube() {
    const std::uint64_t version = in_.number(4);
    check_values();
    in_.number(1);
    const std::uint64_t axes = in_.number(4);
    const std::vector<std::int64_t> cube = lengths(), tile = lengths();
    const std::int64_t in_file = in_.integer(4);
    in_.number(version == 1 ? 4 : 8);
    if (cube.size() != axes || tile.size() != axes)
      in_.fail(std::to_string(cube.size()) + " and " + std::to_string(tile.size()) + " axes of a hypercube and its tiles",
               std::to_string(axes) + " of both");
    double elements = 1, tiles = 1;
    bool empty = axes == 0;
    for (std::size_t i = 0; i < axes; ++i) {
      if (cube[i] < 0) in_.fail("a hypercube of length " + std::to_string(cube[i]), "0 or more");
      if (tile[i] < 1) in_.fail("tiles of length " + std::to_string(tile[i]), "1 or more");
      elements *= static_cast<double>(tile[i]);
      tiles *= std::max(1.0, std::ceil(static_cast<double>(cube[i]) / static_cast<double>(tile[i])));
      empty = empty || cube[i] == 0;
    }
    rows_of_cube_.push_back(empty ? 0 : cube.back());
    const File file =
        in_file < 0 || static_cast<std::size_t>(in_file) >= files_.size() ? File() : files_[static_cast<std::size_t>(in_file)];
    if (!empty && !file.exists) in_.fail("tiles in file " + std::to_string(in_file), "a file that it has");
    // Some may not have been written yet.
    constexpr double any_bytes = 1 << 24, any_tiles = 1 << 20, longer = 4;
    const double bytes = elements * bits_ / 8, in_all = file.bytes;
    if (bytes > std::max(any_bytes, in_all)) in_.fail("tiles of " + shown(bytes) + " bytes", "no more than their file holds");
    if (tiles > std::max(any_tiles, longer * in_all / bytes))
      in_.fail(shown(tiles) + " tiles", "no more than their file holds");
  }

  static std::string shown(double number) {
    std::ostringstream text;
    text << number;
    return text.str();
  }

  /// They tell hypercubes of TiledDataStMan apart, for which they are read as they are; others have none.
  void check_values() {
    if (may_have_values_) return in_.skip_object();
    in_.object("Record");
    in_.object("RecordDesc");
    if (const std::uint64_t fields = in_.number(4); fields != 0)
      in_.fail("hypercubes with " + std::to_string(fields) + " values", "none");
    in_.number(4);
  }

  /// Which rows lie in which hypercube.
  void check_rows() {
    lengths();
    const std::uint64_t used = in_.number(4);
    const auto map = [&](const std::string& things) {
      in_.object("Block");
      std::vector<std::uint64_t> all(in_.count(4, things, 4));
      for (std::uint64_t& value : all) value = in_.number(4);
      if (all.size() < used)
        in_.fail(std::to_string(used) + " runs of rows", "no more than its " + std::to_string(all.size()) + " " + things);
      return all;
    };
    const std::vector<std::uint64_t> last = map("last rows"), cube = map("hypercubes of rows"),
                                     place = map("places of last rows");
    std::int64_t before = -1;
    for (std::size_t i = 0; i < used; ++i) {
      if (cube[i] >= rows_of_cube_.size())
        in_.fail("rows in hypercube " + std::to_string(cube[i]), "one of " + std::to_string(rows_of_cube_.size()));
      const auto rows = static_cast<std::int64_t>(last[i]) - before, in_cube = rows_of_cube_[cube[i]];
      if (cube[i] != 0 &&
          (rows < 1 || static_cast<std::int64_t>(place[i]) >= in_cube || rows > static_cast<std::int64_t>(place[i]) + 1))
        in_.fail(std::to_string(rows) + " rows up to row " + std::to_string(place[i]) + " of a hypercube",
                 "some of its " + std::to_string(in_cube));
      before = static_cast<std::int64_t>(last[i]);
    }
  }

  std::string path_;
  ObjectBytes in_;
  bool may_have_values_ = false;
  double bits_ = 0;  ///< of an element of the column that takes most
  std::vector<File> files_;
  std::vector<std::int64_t> rows_of_cube_;
};

}  // namespace

void check_tiled_header(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  try {
    TiledHeader(path, {std::istreambuf_iterator<char>(file), {}}).check();
  } catch (const NoHeader&) {  // casacore will say so
  }
}

}  // namespace misfit::ms_io
