// Kernel tables, as --kernel FILE, kernel --inspect and the cache of kernels read them.
#include <cstring>

#include "kernels/kernel_table.h"
#include "tests/fuzz/fuzzing.h"

using namespace misfit;
using namespace misfit::fuzz;
using kernels::KernelTable;

namespace {

bool same(double a, double b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

void require_same(const kernels::Kernel& a, const kernels::Kernel& b) {
  require(a.name == b.name && same(a.x0, b.x0), "a kernel that was written is read again");
  const auto &p = a.polynomial.coefficient, &q = b.polynomial.coefficient;
  require(p.rows() == q.rows() && p.cols() == q.cols(), "its polynomials have the same size");
  for (Eigen::Index i = 0; i < p.size(); ++i) require(same(p.data()[i], q.data()[i]), "its polynomials have the same bits");
}

void require_promises(const KernelTable& table) {
  const kernels::Kernel& kernel = table.kernel;
  require(kernel.width() >= 1 && kernel.width() <= kernels::kernel_table_max_width, "a width is one that tables have");
  require(kernel.polynomial.coefficient.allFinite(), "coefficients are finite");
  require(kernel.x0 > 0 && kernel.x0 < 0.5, "x0 is one that kernels have");
  require(kernel.misfit.mean >= 0 && kernel.misfit.max >= 0, "errors are none below 0");
  if (table.sampling)
    require(table.sampling->per_cell >= 1 && table.sampling->interpolation >= 0 && table.sampling->interpolation <= 3,
            "a sampling is one that tables have");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const InputFile file(data, size, "k.fits");
  const auto table = read_or_refused(file.path(), [&] { return kernels::read_kernel_table(file.path()); });
  const auto intact = read_or_refused(file.path(), [&] { return kernels::read_intact_kernel_table(file.path()); });
  require(intact.has_value() == (table && table->checksum_ok), "a table is intact where its checksums are");
  if (!table) return 0;
  require_promises(*table);
  const std::string again = (file.folder() / "again.fits").string();
  kernels::write_kernel_table(table->kernel, {}, again);
  require_same(table->kernel, kernels::read_intact_kernel_table(again).kernel);
  return 0;
}
