#include "kernels/kernel_table.h"

#include <fitsio.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <new>
#include <stdexcept>
#include <string_view>

#include "kernels/cfitsio_call.h"
#include "kernels/fits_sizes.h"
#include "kernels/kernel_table_content_internal.h"
#include "kernels/version.h"
#include "kernels/whole_file.h"

namespace misfit::kernels {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t largest_file = std::size_t{1} << 28;  // 2^20 rows a cell, 16 bytes each, in half of 20 cells: 168 MB

/// CFITSIO lengthens a file in memory to what its headers say, even one that it only reads. Given no function for that it reads
/// beyond the memory.
void* within_limit(void* memory, std::size_t size) {
  return size <= largest_file ? std::realloc(memory, size) : nullptr;
}

/// A FITS file in memory. CFITSIO does not touch files on the disk, so that these are whole or absent.
class FitsMemory {
 public:
  explicit FitsMemory(std::string doing) : doing_(std::move(doing)) {
    constexpr std::size_t growth = 1 << 18;
    int status = 0;
    check(fits_create_memfile(&file_, &buffer_, &size_, growth, std::realloc, &status));
  }
  FitsMemory(std::string doing, const std::vector<char>& bytes) : FitsMemory(std::move(doing), bytes.size()) {
    std::copy(bytes.begin(), bytes.end(), static_cast<char*>(buffer_));
    int status = 0;
    check(fits_open_memfile(&file_, "kernel-table", READONLY, &buffer_, &size_, 0, within_limit, &status));
  }
  FitsMemory(const FitsMemory&) = delete;
  FitsMemory& operator=(const FitsMemory&) = delete;
  ~FitsMemory() {
    int status = 0;
    if (file_ != nullptr) fits_close_file(file_, &status);
    fits_clear_errmsg();
    std::free(buffer_);
  }

  fitsfile* get() const { return file_; }
  const char* data() const { return static_cast<const char*>(buffer_); }

  /// Bytes up to the end of the last HDU. Moves to the first.
  std::size_t end() const {
    int status = 0, count = 0;
    LONGLONG header = 0, body = 0, end = 0;
    check(fits_get_num_hdus(file_, &count, &status));
    check(fits_movabs_hdu(file_, count, nullptr, &status));
    check(fits_get_hduaddrll(file_, &header, &body, &end, &status));
    check(fits_movabs_hdu(file_, 1, nullptr, &status));
    return static_cast<std::size_t>(end);
  }
  /// Ends writing: what CFITSIO still holds goes to memory.
  void close() {
    int status = 0;
    fits_close_file(file_, &status);
    file_ = nullptr;
    check(status);
  }
  [[noreturn]] void fail(const std::string& reason) const { throw std::runtime_error("cannot " + doing_ + ": " + reason); }
  void check(int status) const {
    if (status == 0) return;
    std::array<char, FLEN_STATUS> text{};
    fits_get_errstatus(status, text.data());
    fits_clear_errmsg();
    fail(std::string(text.data()) + " (CFITSIO's status " + std::to_string(status) + ")");
  }

 private:
  FitsMemory(std::string doing, std::size_t size) : doing_(std::move(doing)), buffer_(std::malloc(size)), size_(size) {
    if (buffer_ == nullptr) throw std::bad_alloc();
  }

  std::string doing_;
  void* buffer_ = nullptr;
  std::size_t size_ = 0;
  fitsfile* file_ = nullptr;
};

class HeaderWriter {
 public:
  explicit HeaderWriter(const FitsMemory& file) : file_(file) {}
  void number(const char* key, double value, const char* comment) const {
    int status = 0;  // 17 digits give the same double back
    file_.check(fits_update_key_dbl(file_.get(), key, value, -17, comment, &status));
  }
  void whole(const char* key, int value, const char* comment) const {
    int status = 0;
    file_.check(fits_update_key(file_.get(), TINT, key, &value, comment, &status));
  }
  void text(const char* key, const std::string& value, const char* comment) const {
    int status = 0;
    file_.check(fits_update_key_str(file_.get(), key, value.c_str(), comment, &status));
  }
  void comment(const char* line) const {
    int status = 0;
    file_.check(fits_write_comment(file_.get(), line, &status));
  }

 private:
  const FitsMemory& file_;
};

void write_facts(const FitsMemory& file, Kernel kernel, const std::optional<TableSampling>& sampling) {
  const HeaderWriter header(file);
  header.text("KERNEL", kernel.name, "name of the gridding function");
  header.whole("W", kernel.width(), "width in cells");
  header.number("PADDING", 0.5 / kernel.x0, "least FFT size over image size, 1 / (2 X0)");
  if (sampling) {
    header.whole("MS", sampling->per_cell, "rows of CONVFUNC a cell");
    header.whole("INTERP", sampling->interpolation, "degree to interpolate CONVFUNC with");
  }
  for (const Fact& fact : facts_of(kernel))
    if (!(fact.may_lack && std::isnan(*fact.value))) header.number(fact.key, *fact.value, fact.comment);
  header.whole("ITERATNS", kernel.origin.iterations, "of the solver");
  header.text("PRECISN", kernel.origin.precision, "arithmetic of the solution");
  header.text("ORIGIN", "misfit", "program that wrote this file");
  header.text("VERSION", MISFIT_VERSION, "its version");
  header.whole("SOLVER", solver_version, "version of its kernels' bits");
}

void add_checksum(const FitsMemory& file) {
  int status = 0;
  file.check(fits_write_chksum(file.get(), &status));
}

void write_host_table(const FitsMemory& file, const HostTable& table) {
  std::vector<char*> names, formats;
  for (const HostTable::Column& column : table.columns) {
    names.push_back(const_cast<char*>(column.name.c_str()));
    formats.push_back(const_cast<char*>("1D"));
  }
  const Eigen::Index rows = table.columns.front().value.size();
  int status = 0, number = 0;
  file.check(fits_create_tbl(file.get(), BINARY_TBL, rows, static_cast<int>(names.size()), names.data(), formats.data(),
                             nullptr, table.name.c_str(), &status));
  for (const std::string& line : table.comments) HeaderWriter(file).comment(line.c_str());
  for (const HostTable::Column& column : table.columns)
    file.check(fits_write_col(file.get(), TDOUBLE, ++number, 1, 1, rows, const_cast<double*>(column.value.data()), &status));
  add_checksum(file);
}

void write_polynomial(const FitsMemory& file, const Kernel& kernel, const std::optional<TableSampling>& sampling) {
  Eigen::MatrixXd coefficient = kernel.polynomial.coefficient;
  std::string format = std::to_string(coefficient.rows()) + "D", name = "COEFF";
  std::array<char*, 1> names{name.data()}, formats{format.data()};
  int status = 0;
  file.check(
      fits_create_tbl(file.get(), BINARY_TBL, coefficient.cols(), 1, names.data(), formats.data(), nullptr, "POLY", &status));
  write_facts(file, kernel, sampling);
  const HeaderWriter header(file);
  header.comment("Row r = 0 ... W-1: the value at r - (W-1)/2 - t in cells, as a");
  header.comment("polynomial in ascending powers of t, -1/2 <= t <= 1/2: the place of");
  header.comment("the visibility from the middle of its cell.");
  file.check(fits_write_col(file.get(), TDOUBLE, 1, 1, 1, coefficient.size(), coefficient.data(), &status));
  add_checksum(file);
}

class HeaderReader {
 public:
  explicit HeaderReader(const FitsMemory& file) : file_(file) {}

  std::optional<double> number(const char* key) const {
    double value = 0;
    return read(key, TDOUBLE, &value) ? std::optional(value) : std::nullopt;
  }
  std::optional<int> whole(const char* key, int least, int most) const {
    // CFITSIO 4.2 itself, where a number cannot be understood, writes past the end of its message.
    std::array<char, FLEN_VALUE> digits{};
    if (!read(key, TSTRING, digits.data())) return {};
    const std::string_view text = digits.data();
    long long value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) file_.fail(std::string(key) + " cannot be understood");
    if (value < least || value > most)
      file_.fail(std::string(key) + " is " + std::to_string(value) + ", expected " + std::to_string(least) + " to " +
                 std::to_string(most));
    return static_cast<int>(value);
  }
  std::optional<std::string> text(const char* key) const {
    std::array<char, FLEN_VALUE> value{};
    if (!read(key, TSTRING, value.data())) return {};
    const std::string found = value.data();
    if (!std::all_of(found.begin(), found.end(), [](char c) { return c >= ' ' && c <= '~'; }))
      file_.fail(std::string(key) + " has characters that no header may have");
    return found;
  }
  template <typename Value>
  Value needed(const char* key, const std::optional<Value>& value) const {
    if (!value) file_.fail(std::string("it has no ") + key);
    return *value;
  }

 private:
  bool read(const char* key, int type, void* value) const {
    int status = 0;
    fits_read_key(file_.get(), type, key, value, nullptr, &status);
    if (status != KEY_NO_EXIST && status != VALUE_UNDEFINED) {
      if (status != 0) file_.fail(std::string(key) + " cannot be understood");
      return true;
    }
    fits_clear_errmsg();
    return false;
  }
  const FitsMemory& file_;
};

/// Everything but the polynomial.
KernelTable read_facts(const FitsMemory& file) {
  const HeaderReader header(file);
  constexpr int any = 1 << 30;
  KernelTable table;
  Kernel& kernel = table.kernel;
  kernel.name = header.needed("KERNEL", header.text("KERNEL"));
  if (kernel.name.empty()) file.fail("KERNEL is empty, expected a name");
  if (kernel.name.size() > longest_name)
    file.fail("KERNEL has " + std::to_string(kernel.name.size()) + " characters, expected at most " +
              std::to_string(longest_name));
  for (const Fact& fact : facts_of(kernel)) {
    const std::optional<double> value = header.number(fact.key);
    if (!value && fact.may_lack) continue;
    *fact.value = header.needed(fact.key, value);
    if (!std::isfinite(*fact.value) || *fact.value < 0)
      file.fail(std::string(fact.key) + " is " + std::to_string(*fact.value) + ", expected a number of at least 0");
  }
  if (!(kernel.x0 > 0 && kernel.x0 < 0.5))
    file.fail("X0 is " + std::to_string(kernel.x0) + ", expected more than 0 and less than 0.5");
  kernel.origin.iterations = header.needed("ITERATNS", header.whole("ITERATNS", 0, any));
  kernel.origin.precision = header.needed("PRECISN", header.text("PRECISN"));
  if (const std::optional<int> per_cell = header.whole("MS", 1, kernel_table_max_per_cell))
    table.sampling = {*per_cell, header.needed("INTERP", header.whole("INTERP", 0, 3))};
  table.version = header.text("VERSION").value_or("");
  table.solver = header.whole("SOLVER", 0, any).value_or(0);
  return table;
}

PiecewisePolynomial read_polynomial(const FitsMemory& file, int width) {
  int status = 0, column = 0, type = 0;
  LONGLONG rows = 0, repeat = 0, bytes = 0;
  std::string hdu = "POLY", name = "COEFF";
  if (fits_movnam_hdu(file.get(), BINARY_TBL, hdu.data(), 0, &status) != 0) file.fail("it has no table POLY");
  if (fits_get_colnum(file.get(), CASESEN, name.data(), &column, &status) != 0) file.fail("POLY has no column COEFF");
  file.check(fits_get_num_rowsll(file.get(), &rows, &status));
  file.check(fits_get_coltypell(file.get(), column, &type, &repeat, &bytes, &status));
  if (rows != width) file.fail("POLY has " + std::to_string(rows) + " rows, expected as many as W, " + std::to_string(width));
  if (type != TDOUBLE || repeat < 1 || repeat > highest_degree + 1)
    file.fail("COEFF has " + std::to_string(repeat) + " values of CFITSIO's type " + std::to_string(type) +
              " in a row, expected 1 to " + std::to_string(highest_degree + 1) + " doubles");
  PiecewisePolynomial polynomial{Eigen::MatrixXd(repeat, rows)};
  file.check(fits_read_col(file.get(), TDOUBLE, column, 1, 1, rows * repeat, nullptr, polynomial.coefficient.data(), nullptr,
                           &status));
  if (!polynomial.coefficient.allFinite()) file.fail("COEFF has values that are not finite");
  return polynomial;
}

bool has_table(const FitsMemory& file, std::string name) {
  int status = 0;
  const bool found = fits_movnam_hdu(file.get(), BINARY_TBL, name.data(), 0, &status) == 0;
  fits_clear_errmsg();
  return found;
}

/// True if every HDU is as it was written, and nothing behind them.
bool is_intact(const FitsMemory& file, std::size_t size) {
  int status = 0, count = 0;
  bool intact = file.end() == size;
  file.check(fits_get_num_hdus(file.get(), &count, &status));
  for (int i = 1; i <= count; ++i) {
    int data = 0, hdu = 0;
    file.check(fits_movabs_hdu(file.get(), i, nullptr, &status));
    file.check(fits_verify_chksum(file.get(), &data, &hdu, &status));
    intact = intact && data == 1 && hdu == 1;
  }
  return intact;
}

}  // namespace

void write_kernel_table(const Kernel& kernel, const std::optional<TableSampling>& sampling, const fs::path& path,
                        const std::vector<HostTable>& more) {
  check_storable(kernel, sampling);
  const CfitsioCall call;
  FitsMemory file("write kernel table " + path.string());
  int status = 0;
  file.check(fits_create_img(file.get(), BYTE_IMG, 0, nullptr, &status));
  write_facts(file, kernel, sampling);
  add_checksum(file);
  write_polynomial(file, kernel, sampling);
  if (sampling)
    for (const HostTable& table : host_tables(kernel, sampling->per_cell)) write_host_table(file, table);
  for (const HostTable& table : more) write_host_table(file, table);
  const std::size_t size = file.end();
  file.close();
  write_whole_file(path, file.data(), size);
}

KernelTable read_kernel_table(const fs::path& path) {
  const std::vector<char> bytes = read_whole_file(path, largest_file);
  const std::size_t size = bytes.size();
  const std::string doing = "read kernel table " + path.string();
  try {
    check_fits_sizes({bytes.data(), size});
  } catch (const std::runtime_error& error) {
    throw std::runtime_error("cannot " + doing + ": " + error.what());
  }
  const CfitsioCall call;
  const FitsMemory file(doing, bytes);
  KernelTable table = read_facts(file);
  const HeaderReader header(file);
  const int width = header.needed("W", header.whole("W", 1, kernel_table_max_width));
  table.kernel.polynomial = read_polynomial(file, width);
  table.checksum_ok = is_intact(file, size);
  if (table.sampling && !has_table(file, "CONVFUNC")) {  // cut off between two HDUs
    table.sampling.reset();
    table.checksum_ok = false;
  }
  return table;
}

KernelTable read_intact_kernel_table(const fs::path& path) {
  KernelTable table = read_kernel_table(path);
  if (!table.checksum_ok)
    throw std::runtime_error(
        "kernel table " + path.string() +
        " does not match its checksum: it was changed or cut short after it was written; expected the file "
        "as misfit kernel wrote it");
  return table;
}

}  // namespace misfit::kernels
