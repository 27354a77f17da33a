#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "kernels/kernel.h"

namespace misfit::kernels {

/// Counted up whenever any bit of any kernel of the catalogue changes, so that kernels which older versions left in caches are
/// made anew.
inline constexpr int solver_version = 2;

inline constexpr int kernel_table_max_width = 20;
inline constexpr int kernel_table_max_per_cell = 1 << 20;

/// How a host is to look C up in the table CONVFUNC.
struct TableSampling {
  int per_cell = 128;     ///< Ms: rows for |u| = i / Ms
  int interpolation = 3;  ///< degree of the polynomial through rows next to each other, 0 (nearest row) to 3
};

/// The content of a kernel-table file. Its HDUs are
/// - primary: no data; KERNEL, W, X0, PADDING, E, MAXELL, EOPT, COND, PRECISN and more: all of `Kernel` that is no table;
/// - POLY: a row for each cell r = 0 … W−1, COEFF = ascending powers of t, as in `PiecewisePolynomial`; the same header;
/// - CONVFUNC: U, C as in sampled_function(); CORRECT: X, H, ONE_OVER_C, the optimal correction and 1/c over 0 ≤ x ≤ x0;
///   MAPERROR: X, ELL, the map error over 0 ≤ x ≤ ½. For hosts; they follow from POLY, and may be lacking, and others may
///   follow.
struct KernelTable {
  Kernel kernel;
  std::optional<TableSampling> sampling;  ///< where there is a CONVFUNC
  std::string version;                    ///< of the program that wrote it
  int solver = 0;                         ///< its solver_version
  bool checksum_ok = false;               ///< every HDU has a CHECKSUM and a DATASUM, and they match
};

/// A further table in a file, for a host, beside the kernel's own tables.
struct HostTable {
  struct Column {
    std::string name;
    Eigen::VectorXd value;
  };
  std::string name;
  std::vector<Column> columns;        ///< of equal lengths
  std::vector<std::string> comments;  ///< lines of at most 70 characters of ASCII
};

/// Writes `kernel` to `path`, with tables for hosts where a `sampling` is given, and `more`. The file appears under its name
/// only when complete. Throws std::invalid_argument for a kernel or a sampling that a table cannot hold, std::runtime_error
/// that names the path when it cannot be written.
void write_kernel_table(const Kernel& kernel, const std::optional<TableSampling>& sampling, const std::filesystem::path& path,
                        const std::vector<HostTable>& more = {});

/// Reads POLY and the header: the same kernel bit for bit. Throws std::runtime_error that names the path, the thing and what
/// was expected when this is no such file. A checksum that does not match is for the caller to judge.
KernelTable read_kernel_table(const std::filesystem::path& path);
/// Reads as read_kernel_table() does, but throws std::runtime_error that names the path where the checksum does not match.
KernelTable read_intact_kernel_table(const std::filesystem::path& path);

}  // namespace misfit::kernels
