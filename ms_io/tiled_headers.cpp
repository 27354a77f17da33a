#include <casacore/casa/Utilities/DataType.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
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
class ObjectFile {
 public:
  explicit ObjectFile(const std::string& path) : path_(path) {
    std::error_code none;
    const fs::file_status status = fs::status(path, none);
    if (!fs::exists(status)) throw NoHeader();
    if (!fs::is_regular_file(status)) throw std::runtime_error("cannot read " + path + ": it is no regular file");
    left_ = fs::file_size(path, none);
    file_.open(path, std::ios::binary);
    if (none || !file_) throw NoHeader();
  }

  [[noreturn]] void fail(const std::string& tells, const std::string& expected) const {
    throw std::runtime_error("cannot read " + path_ + ": it tells of " + tells + ", expected " + expected);
  }

  std::uint64_t number(std::size_t size) {
    std::array<char, 8> bytes{};
    take(bytes.data(), size);
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < size; ++i) value = value << 8 | static_cast<unsigned char>(bytes[i]);
    return value;
  }
  std::int64_t integer(std::size_t size) {
    const std::uint64_t value = number(size);
    return size == 4 ? static_cast<std::int32_t>(value) : static_cast<std::int64_t>(value);
  }
  /// A number of things that take as many bytes each, at least.
  std::uint64_t count(std::size_t size, const std::string& things, std::size_t bytes_each) {
    const std::uint64_t counted = number(size);
    if (counted > left_ / bytes_each) fail(std::to_string(counted) + " " + things, "no more than it holds");
    return counted;
  }
  std::string text() {
    constexpr std::uint64_t longest = 1 << 16;
    const std::uint64_t length = count(4, "letters", 1);
    if (length > longest) fail("a name of " + std::to_string(length) + " letters", std::to_string(longest) + " or fewer");
    std::string text(length, '\0');
    take(text.data(), length);
    return text;
  }
  void skip_object() {
    const std::uint64_t length = number(4), rest = length - 4;
    if (length < 4 || rest > left_) fail("an object of " + std::to_string(length) + " bytes", "no more than it holds");
    file_.seekg(static_cast<std::streamoff>(rest), std::ios::cur);
    left_ -= rest;
  }
  /// Begins an object of that type; its version.
  std::uint64_t object(const std::string& type) {
    number(4);
    if (text() != type) throw NoHeader();
    return number(4);
  }

 private:
  void take(char* to, std::size_t count) {
    if (count > left_) throw NoHeader();
    errno = 0;
    file_.read(to, static_cast<std::streamsize>(count));
    if (file_.bad()) throw std::runtime_error("cannot read " + path_ + ": " + std::strerror(errno));
    if (!file_) throw NoHeader();
    left_ -= count;
  }

  std::string path_;
  std::ifstream file_;
  std::uint64_t left_ = 0;
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
  explicit TiledHeader(const std::string& path) : path_(path), in_(path) {}

  void check() {
    constexpr std::uint64_t magic = 0xbebebebe;
    if (in_.number(4) != magic) throw NoHeader();
    in_.number(4);
    const std::string manager = in_.text();
    may_have_values_ = manager == "TiledDataStMan";
    const std::uint64_t version = in_.number(4);
    if (manager == "TiledColumnStMan" || manager == "TiledCellStMan") lengths();
    check_common();
    if (manager == "TiledShapeStMan") check_rows();
    if (manager == "TiledDataStMan") check_chunks(version);
  }

 private:
  std::vector<std::int64_t> lengths() {
    const std::size_t size = in_.object("IPosition") == 1 ? 4 : 8;
    std::vector<std::int64_t> all(in_.count(4, "axes", size));
    for (std::int64_t& length : all) length = in_.integer(size);
    return all;
  }

  void check_common() {
    common_version_ = in_.object("TiledStMan");
    const std::size_t size = common_version_ >= 3 ? 8 : 4;
    if (common_version_ >= 2) in_.number(1);
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
    double across = 1;
    bool empty = axes == 0;
    for (std::size_t i = 0; i < axes; ++i) {
      if (cube[i] < 0) in_.fail("a hypercube of length " + std::to_string(cube[i]), "0 or more");
      if (tile[i] < 1) in_.fail("tiles of length " + std::to_string(tile[i]), "1 or more");
      elements *= static_cast<double>(tile[i]);
      tiles *= std::max(1.0, std::ceil(static_cast<double>(cube[i]) / static_cast<double>(tile[i])));
      empty = empty || cube[i] == 0;
      if (i + 1 < axes) across *= static_cast<double>(cube[i]);
    }
    cubes_.push_back({empty ? 0 : static_cast<std::uint64_t>(cube.back()), across});
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

  std::vector<std::uint64_t> numbers(const std::string& things, std::size_t size = 4) {
    in_.object("Block");
    std::vector<std::uint64_t> all(in_.count(4, things, size));
    for (std::uint64_t& value : all) value = in_.number(size);
    return all;
  }
  void check_hypercube(std::uint64_t cube) const {
    if (cube >= cubes_.size()) in_.fail("rows in hypercube " + std::to_string(cube), "one of " + std::to_string(cubes_.size()));
  }
  [[noreturn]] void refuse_rows(std::uint64_t rows, std::uint64_t place, const Cube& cube) const {
    in_.fail(std::to_string(rows) + " rows at row " + std::to_string(place) + " of a hypercube",
             "some of its " + std::to_string(cube.rows));
  }

  /// Of TiledShapeStMan: runs of rows, by the last of each and where that lies.
  void check_rows() {
    lengths();
    const std::uint64_t used = in_.number(4);
    const std::vector<std::uint64_t> last = numbers("last rows"), cube = numbers("hypercubes"), place = numbers("places");
    if (const std::size_t all = std::min({last.size(), cube.size(), place.size()}); used > all)
      in_.fail(std::to_string(used) + " runs of rows", "no more than the " + std::to_string(all) + " that it has");
    for (std::size_t i = 0; i < used; ++i) {
      check_hypercube(cube[i]);
      const std::uint64_t begin = i == 0 ? 0 : last[i - 1] + 1, rows = last[i] + 1 - begin;
      if (cube[i] != 0 && (last[i] < begin || place[i] >= cubes_[cube[i]].rows || rows > place[i] + 1))
        refuse_rows(rows, place[i], cubes_[cube[i]]);
    }
  }

  /// Of TiledDataStMan: chunks, by the first row of each and where that lies; several rows may share a place along the last
  /// axis.
  void check_chunks(std::uint64_t version) {
    const std::uint64_t rows = in_.number(version == 1 && common_version_ < 3 ? 4 : 8);
    if (version == 1) in_.number(4);
    const std::vector<std::uint64_t> first = numbers("first rows", version == 1 ? 4 : 8), cube = numbers("hypercubes"),
                                     place = numbers("places");
    if (first.size() > std::min(cube.size(), place.size()) || (rows > 0 && (first.empty() || first.front() != 0)))
      in_.fail(std::to_string(first.size()) + " chunks of rows", "a hypercube and a place for each, from row 0 on");
    for (std::size_t i = 0; i < first.size(); ++i) {
      check_hypercube(cube[i]);
      const std::uint64_t end = i + 1 < first.size() ? first[i + 1] : rows;
      const Cube& in = cubes_[cube[i]];
      const double room = static_cast<double>(in.rows - std::min(in.rows, place[i])) * in.cells_a_row;
      if (end <= first[i] || static_cast<double>(end - first[i]) > room) refuse_rows(end - first[i], place[i], in);
    }
  }

  std::string path_;
  ObjectFile in_;
  bool may_have_values_ = false;
  double bits_ = 0;  ///< of an element of the column that takes most
  std::vector<File> files_;
  std::uint64_t common_version_ = 0;
  std::vector<Cube> cubes_;
};

}  // namespace

void check_tiled_header(const std::string& path) {
  try {
    TiledHeader(path).check();
  } catch (const NoHeader&) {  // casacore will say so
  }
}

}  // namespace misfit::ms_io
