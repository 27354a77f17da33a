#include "kernels/kernel_table.h"

#include <fitsio.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <boost/test/data/test_case.hpp>
#include <boost/test/unit_test.hpp>
#include <csignal>
#include <limits>
#include <random>

#include "kernels/catalogue.h"
#include "kernels/least_misfit.h"
#include "kernels/sampled_function.h"
#include "tests/kernels/kernels.h"
#include "tests/temporary_folder.h"

using namespace misfit::kernels;
using namespace misfit::kernels::testing;
using misfit::testing::TemporaryFolder;
namespace bdata = boost::unit_test::data;

namespace {

struct Files {
  TemporaryFolder folder;
  std::string path = folder / "k.fits";

  Kernel through_file(const Kernel& kernel) const {
    write_kernel_table(kernel, {}, path);
    const KernelTable table = read_kernel_table(path);
    BOOST_TEST(table.checksum_ok);
    return table.kernel;
  }
};

const Kernel& example() {
  static const Kernel kernel = kernel_family("least-misfit").make(7, 0.25);
  return kernel;
}

/// A kernel of nothing but awkward numbers.
Kernel random_kernel(int width, int degree, unsigned seed) {
  std::mt19937_64 random(seed);
  const auto number = [&random] { return std::ldexp(std::generate_canonical<double, 64>(random), int(random() % 600) - 300); };
  Kernel kernel;
  kernel.name = "it's a 'kernel'";
  kernel.x0 = 0.49 * std::generate_canonical<double, 64>(random) + 1e-3;
  kernel.polynomial.coefficient.resize(degree + 1, width);
  for (double& value : kernel.polynomial.coefficient.reshaped()) value = number() - number();
  kernel.polynomial.coefficient(0, 0) = -0.0;
  kernel.polynomial.coefficient(degree, width - 1) = std::numeric_limits<double>::denorm_min();
  kernel.misfit = {number(), number(), number(), number()};
  kernel.origin = {number(), number(), seed % 2 == 0 ? number() : std::nan(""), number(), number(), 17, "256 bits"};
  return kernel;
}

/// What a table of a FITS file holds.
struct HostFile {
  fitsfile* file = nullptr;
  int status = 0;
  explicit HostFile(const std::string& path) { BOOST_REQUIRE(fits_open_diskfile(&file, path.c_str(), READONLY, &status) == 0); }
  ~HostFile() { fits_close_file(file, &status); }
  Eigen::VectorXd column(std::string table, std::string name) {
    long rows = 0;
    int number = 0;
    fits_movnam_hdu(file, BINARY_TBL, table.data(), 0, &status);
    fits_get_num_rows(file, &rows, &status);
    fits_get_colnum(file, CASESEN, name.data(), &number, &status);
    Eigen::VectorXd value(rows);
    fits_read_col(file, TDOUBLE, number, 1, 1, rows, nullptr, value.data(), nullptr, &status);
    BOOST_REQUIRE(status == 0);
    return value;
  }
  double header(const std::string& key) {
    double value = 0;
    fits_movabs_hdu(file, 1, nullptr, &status);
    fits_read_key(file, TDOUBLE, key.c_str(), &value, nullptr, &status);
    BOOST_REQUIRE(status == 0);
    return value;
  }
};

}  // namespace

BOOST_AUTO_TEST_SUITE(kernel_table)

BOOST_AUTO_TEST_CASE(a_kernel_comes_back_bit_for_bit, *boost::unit_test::label("sweep")) {
  const Files files;
  for (const KernelFamily& family : kernel_catalogue())
    for (int width = family.min_width; width <= std::min(family.max_width, 11); ++width)
      for (const double x0 : {0.25, 1.0 / 3, 0.1}) {
        const Kernel kernel = family.make(width, x0);
        BOOST_TEST_INFO(family.name << " " << width);
        BOOST_TEST(same(files.through_file(kernel), kernel));
      }
}

BOOST_DATA_TEST_CASE(any_numbers_come_back_bit_for_bit_at_any_width, bdata::xrange(1, 21), width) {
  const Files files;
  for (const int degree : {0, 1, width, highest_degree}) {
    const Kernel kernel = random_kernel(width, degree, static_cast<unsigned>(100 * width + degree));
    BOOST_TEST(same(files.through_file(kernel), kernel));
  }
}

BOOST_AUTO_TEST_CASE(the_sampling_and_the_versions_come_back) {
  const Files files;
  write_kernel_table(example(), TableSampling{33, 3}, files.path);
  const KernelTable table = read_kernel_table(files.path);
  BOOST_TEST(table.sampling->per_cell == 33);
  BOOST_TEST(table.sampling->interpolation == 3);
  BOOST_TEST(!table.version.empty());
  BOOST_TEST(table.solver == solver_version);
  BOOST_TEST(table.checksum_ok);
  BOOST_TEST(same(table.kernel, example()));
  write_kernel_table(example(), {}, files.path);
  BOOST_TEST(!read_kernel_table(files.path).sampling.has_value());
}

BOOST_DATA_TEST_CASE(tables_for_hosts_follow_from_the_polynomial, bdata::make({1, 4, 7, 12}), width) {
  const Files files;
  const Kernel kernel = kernel_family("least-misfit").make(width, 0.2);
  const PiecewisePolynomial& taps = kernel.polynomial;
  write_kernel_table(kernel, TableSampling{100, 2}, files.path);
  HostFile host(files.path);
  const Eigen::VectorXd u = host.column("CONVFUNC", "U");
  BOOST_TEST(u[0] == 0);
  BOOST_TEST(u[u.size() - 1] == width / 2.0);
  for (Eigen::Index i = 0; i < u.size(); ++i) BOOST_TEST(u[i] == static_cast<double>(i) / 100);
  BOOST_TEST((host.column("CONVFUNC", "C") == sampled_function(taps, 100)));
  const Eigen::VectorXd x = host.column("CORRECT", "X"), h = host.column("CORRECT", "H");
  BOOST_TEST(x.size() == 1025);
  BOOST_TEST(x[0] == 0);
  BOOST_TEST(x[1024] == kernel.x0);
  BOOST_TEST((h == optimal_correction(taps, x)));
  BOOST_TEST(h[0] == 1.0, boost::test_tools::tolerance(1e-9));  // the polynomial is true to 1e-10
  // With the optimal correction ℓ = 1 − h c, which doubles hold to 1e-15.
  const Eigen::VectorXd missing = (1 - h.array() / host.column("CORRECT", "ONE_OVER_C").array()).matrix();
  BOOST_TEST((missing - map_error(taps, x)).cwiseAbs().maxCoeff() < 1e-14);
  const Eigen::VectorXd everywhere = host.column("MAPERROR", "X");
  BOOST_TEST(everywhere[0] == 0);
  BOOST_TEST(everywhere[everywhere.size() - 1] == 0.5);
  BOOST_TEST((host.column("MAPERROR", "ELL") == map_error(taps, everywhere)));
}

BOOST_AUTO_TEST_CASE(the_header_says_what_the_kernel_is) {
  const Files files;
  write_kernel_table(example(), TableSampling{}, files.path);
  HostFile host(files.path);
  BOOST_TEST(host.header("W") == 7);
  BOOST_TEST(host.header("X0") == 0.25);
  BOOST_TEST(host.header("PADDING") == 2);
  BOOST_TEST(host.header("MS") == 128);
  BOOST_TEST(host.header("INTERP") == 3);
  BOOST_TEST(host.header("E") == judge(example().polynomial, 0.25).mean);
  BOOST_TEST(host.header("MAXELL") == judge(example().polynomial, 0.25).max);
  BOOST_TEST(host.header("EOPT") == example().origin.mean_error);
  BOOST_TEST(host.header("COND") == example().origin.condition);
}

BOOST_AUTO_TEST_CASE(what_a_table_cannot_hold_is_not_written) {
  const Files files;
  const auto refused = [&](auto change, const std::optional<TableSampling>& sampling = {}) {
    Kernel kernel = example();
    change(kernel);
    BOOST_CHECK_THROW(write_kernel_table(kernel, sampling, files.path), std::invalid_argument);
    BOOST_TEST(!std::filesystem::exists(files.path));
  };
  const auto keep = [](Kernel&) {};
  refused([](Kernel& k) { k.name = ""; });
  refused([](Kernel& k) { k.name = std::string(61, 'k'); });
  refused([](Kernel& k) { k.x0 = 0.5; });
  refused([](Kernel& k) { k.x0 = std::nan(""); });
  refused([](Kernel& k) { k.misfit.mean = std::nan(""); });
  refused([](Kernel& k) { k.origin.condition = std::numeric_limits<double>::infinity(); });
  refused([](Kernel& k) { k.polynomial.coefficient(1, 1) = std::nan(""); });
  refused([](Kernel& k) { k.polynomial.coefficient = Eigen::MatrixXd::Ones(3, 21); });
  refused([](Kernel& k) { k.polynomial.coefficient = Eigen::MatrixXd::Ones(26, 3); });
  refused([](Kernel& k) { k.polynomial.coefficient.resize(0, 0); });
  refused(keep, TableSampling{0, 1});
  refused(keep, TableSampling{(1 << 20) + 1, 1});
  refused(keep, TableSampling{128, 4});
  refused(keep, TableSampling{128, -1});
}

BOOST_AUTO_TEST_CASE(a_file_is_replaced_whole_or_not_at_all) {
  const Files files;
  write_kernel_table(example(), {}, files.path);
  const std::string before = content(files.path);
  const pid_t child = fork();
  if (child == 0) {  // with a disk that has room for 20 000 bytes
    signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{20000, 20000};
    setrlimit(RLIMIT_FSIZE, &limit);
    try {
      write_kernel_table(example(), TableSampling{}, files.path);
    } catch (const std::runtime_error& error) {
      _exit(std::string(error.what()).find(files.path) != std::string::npos ? 0 : 2);
    }
    _exit(3);
  }
  int status = 0;
  BOOST_REQUIRE(waitpid(child, &status, 0) == child);
  BOOST_TEST(WEXITSTATUS(status) == 0);
  BOOST_TEST(content(files.path) == before);
  BOOST_TEST(std::distance(std::filesystem::directory_iterator(files.folder / ""), {}) == 1);
}

BOOST_AUTO_TEST_CASE(a_folder_that_does_not_exist_is_named) {
  const Files files;
  const std::string path = files.folder / "none/k.fits";
  BOOST_CHECK_EXCEPTION(write_kernel_table(example(), {}, path), std::runtime_error,
                        [&](const std::exception& e) { return std::string(e.what()).find(path) != std::string::npos; });
}

BOOST_AUTO_TEST_SUITE_END()
