#include <cstring>
#include <fstream>
#include <iterator>

#include "ms_io/fingerprint.h"
#include "ms_io/kept_cells_internal.h"

namespace misfit::ms_io {
namespace {

constexpr const char* kind = "kept";

void append_number(std::string& bytes, std::uint64_t number) {
  bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

/// Numbers and cells in the order in which they were appended.
class KeptBytes {
 public:
  explicit KeptBytes(const std::string& bytes) : bytes_(bytes) {}

  /// The next number; 0 behind the end.
  std::uint64_t number() {
    std::uint64_t value = 0;
    if (bytes_.size() - at_ >= sizeof value) copy(&value, sizeof value);
    return value;
  }
  /// True if as many bytes follow.
  bool has(std::uint64_t count) const { return bytes_.size() - at_ >= count; }
  void copy(void* to, std::size_t count) {
    std::memcpy(to, bytes_.data() + at_, count);
    at_ += count;
  }

 private:
  const std::string& bytes_;
  std::size_t at_ = 0;
};

std::uint64_t checksum_of(const std::string& bytes, std::size_t count) {
  return Fingerprint().add(bytes.data(), count).value();
}

/// The file's bytes without the checksum at their end; nothing where the checksum is wrong or there is no file.
std::string read_checked(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(file), {}};
  std::uint64_t checksum = 0;
  if (bytes.size() < sizeof checksum) return "";
  const std::size_t count = bytes.size() - sizeof checksum;
  std::memcpy(&checksum, bytes.data() + count, sizeof checksum);
  if (checksum != checksum_of(bytes, count)) return "";
  bytes.resize(count);
  return bytes;
}

std::uint64_t run_of(const ModelJournal& journal) {
  return Fingerprint().add(journal.identity).add(journal.column).add(journal.written).value();
}

}  // namespace

KeptCells::KeptCells(const casacore::Table& set, const std::string& column) : path_(files_beside(set, kind, column).front()) {}

void KeptCells::keep(const ModelJournal& journal, std::size_t setup, const Rows& rows, const CellColumn::Cells& cells) const {
  std::string bytes;
  append_number(bytes, run_of(journal));
  append_number(bytes, setup);
  append_number(bytes, rows.count());
  for (std::uint64_t r = 0; r < rows.count(); ++r) append_number(bytes, rows[r]);
  bytes.append(reinterpret_cast<const char*>(cells.data()), cells.nelements() * sizeof(casacore::Complex));
  append_number(bytes, checksum_of(bytes, bytes.size()));
  replace_file(path_, bytes, "the former values of the cells that are being written");
}

void KeptCells::put_back(const ModelJournal& journal, const std::vector<Setup>& setups, ModelCells& column) const {
  const std::string bytes = read_checked(path_);
  KeptBytes kept(bytes);
  if (bytes.empty() || kept.number() != run_of(journal)) return;  // nothing of these rows had been written
  const std::size_t setup = kept.number();
  std::vector<Run> runs;
  for (std::uint64_t count = kept.number(); count > 0; --count) append(runs, kept.number());
  if (setup >= setups.size() || runs.empty()) return;
  const Rows rows(runs);
  CellColumn::Cells cells(casacore::IPosition(3, static_cast<ssize_t>(setups[setup].correlation_types.size()),
                                              static_cast<ssize_t>(setups[setup].channel_span()),
                                              static_cast<ssize_t>(rows.count())));
  const std::uint64_t cell_bytes = cells.nelements() * sizeof(casacore::Complex);
  if (!kept.has(cell_bytes)) return;
  kept.copy(cells.data(), cell_bytes);
  column.write(rows, setups[setup], cells);
}

void KeptCells::forget() const {
  remove_file(path_);
}

}  // namespace misfit::ms_io
