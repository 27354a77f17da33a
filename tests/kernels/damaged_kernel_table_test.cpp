// Files that are no kernel tables, or no longer.
#include <boost/test/unit_test.hpp>
#include <random>

#include "kernels/catalogue.h"
#include "kernels/kernel_table.h"
#include "tests/kernels/kernels.h"
#include "tests/temporary_folder.h"

using namespace misfit::kernels;
using namespace misfit::kernels::testing;
using misfit::testing::TemporaryFolder;

namespace {

struct Files {
  TemporaryFolder folder;
  std::string path = folder / "k.fits";

  /// One line that names the path and has `part`.
  void refused(const std::string& part) const {
    BOOST_CHECK_EXCEPTION(read_kernel_table(path), std::runtime_error, [&](const std::exception& error) {
      const std::string message = error.what();
      BOOST_TEST_INFO(message);
      BOOST_TEST(message.find(path) != std::string::npos);
      BOOST_TEST_INFO(message << " lacks " << part);
      BOOST_TEST(message.find(part) != std::string::npos);
      return message.find('\n') == std::string::npos;
    });
  }
};

const Kernel& example() {
  static const Kernel kernel = kernel_family("least-misfit").make(7, 0.25);
  return kernel;
}

/// The file with the value of a card exchanged, in the primary header.
std::string altered(std::string fits, const std::string& card, const std::string& value) {
  const std::size_t at = fits.find(card);
  BOOST_REQUIRE(at != std::string::npos);
  return fits.replace(at + 10, 20, std::string(20 - value.size(), ' ') + value);
}

}  // namespace

BOOST_AUTO_TEST_SUITE(damaged_kernel_table)

BOOST_AUTO_TEST_CASE(no_changed_byte_goes_unnoticed) {
  const Files files;
  write_kernel_table(kernel_family("least-misfit").make(2, 0.25), TableSampling{4, 1}, files.path);
  const std::string good = content(files.path);
  std::mt19937 random(1);
  for (std::size_t i = 0; i < good.size(); i += 1 + random() % 60) {
    std::string bad = good;
    bad[i] = static_cast<char>(bad[i] ^ (1 << random() % 8));
    put(files.path, bad);
    try {
      BOOST_TEST_INFO("byte " << i);
      BOOST_TEST(!read_kernel_table(files.path).checksum_ok);
    } catch (const std::runtime_error& error) {
      BOOST_TEST(std::string(error.what()).find(files.path) != std::string::npos);
    }
  }
}

BOOST_AUTO_TEST_CASE(a_file_cut_short_is_refused_unless_the_kernel_is_whole) {
  const Files files;
  write_kernel_table(example(), TableSampling{}, files.path);
  const std::string good = content(files.path);
  int between = 0;
  for (std::size_t size = 80; size < good.size(); size += 400) {
    put(files.path, good.substr(0, size));
    try {
      const KernelTable table = read_kernel_table(files.path);  // where it ends between two HDUs only tables for hosts are lost
      BOOST_TEST(same(table.kernel, example()));
      BOOST_TEST(!table.checksum_ok);
      ++between;
    } catch (const std::runtime_error&) {
      files.refused("cannot read");
    }
  }
  BOOST_TEST(between <= 3);
  put(files.path, good + std::string(2880, '\0'));
  BOOST_TEST(!read_kernel_table(files.path).checksum_ok);
  BOOST_CHECK_EXCEPTION(read_intact_kernel_table(files.path), std::runtime_error, [&](const std::runtime_error& error) {
    return std::string(error.what()).find(files.path + " does not match its checksum") != std::string::npos;
  });
  put(files.path, good);
  BOOST_TEST(same(read_intact_kernel_table(files.path).kernel, example()));
}

BOOST_AUTO_TEST_CASE(what_is_no_kernel_table_is_refused_by_name) {
  const Files files;
  files.refused("does not exist");
  put(files.path, "");
  files.refused("no FITS file");
  put(files.path, "least-misfit, width 7\n");
  files.refused("no FITS file");
  put(files.path, "SIMPLE  = nonsense" + std::string(2880 - 18, ' '));
  files.refused("cannot read kernel table");
  std::filesystem::remove(files.path);
  std::filesystem::create_directory(files.path);
  files.refused("no regular file");
}

BOOST_AUTO_TEST_CASE(values_that_make_no_kernel_are_refused_with_what_was_expected) {
  const Files files;
  write_kernel_table(example(), {}, files.path);
  const std::string good = content(files.path);
  const auto refused = [&](const std::string& card, const std::string& value, const std::string& part) {
    put(files.path, altered(good, card, value));
    files.refused(part);
  };
  refused("W       =", "21", "W is 21, expected 1 to 20");
  refused("W       =", "0", "W is 0, expected 1 to 20");
  refused("W       =", "8", "POLY has 7 rows, expected as many as W, 8");
  refused("W       =", "99999999999999999999", "W cannot be understood");
  refused("W       =", "'seven'", "W cannot be understood");
  refused("X0      =", "0.5", "X0 is 0.5");
  refused("X0      =", "-0.25", "X0 is -0.25");
  refused("X0      =", "NaN", "X0 ");
  refused("E       =", "-1.0", "E is -1");
  refused("KERNEL  =", "''", "KERNEL is empty");
  put(files.path, altered(good, "W       =", "7").replace(good.find("E       ="), 8, "NOTE    "));
  files.refused("it has no E");
}

BOOST_AUTO_TEST_CASE(tables_of_another_shape_are_refused_before_memory_is_taken) {
  const Files files;
  write_kernel_table(example(), {}, files.path);
  const std::string good = content(files.path);
  const auto refused = [&](const std::string& fits, const std::string& part) {
    put(files.path, fits);
    files.refused(part);
  };
  const auto exchanged = [&](const std::string& what, const std::string& with) {
    std::string fits = good;
    return fits.replace(fits.find(what), what.size(), with);
  };
  refused(exchanged("'POLY    '", "'OTHER   '"), "it has no table POLY");
  refused(exchanged("'COEFF   '", "'COEFFS  '"), "POLY has no column COEFF");
  refused(altered(good, "NAXIS2  =", "900000000000000"), "cut short");
  refused(altered(good, "NAXIS2  =", "9000000000000000000"), "cannot read kernel table");
  refused(exchanged("COMMENT Row r = 0 ... W-1", "THEAP   = 2147483647 /   "), "THEAP is 2147483647, expected 0 to ");
  refused(altered(good, "BITPIX  =", "\r4294967294"), "BITPIX cannot be understood");
  refused(altered(exchanged("EXTEND  =", "PCOUNT  ="), "PCOUNT  =", "1"), "PCOUNT is 1, expected 0 to 0");  // and no axes
  refused(exchanged("COMMENT Row r = 0 ... W-1", "GCOUNT  =          1 /   "), "a header has GCOUNT where no other begins");
  refused(exchanged("END     ", "END SIMP"), "END has a value");
  const std::size_t format = good.find("TFORM1");
  std::string wide = good;
  refused(wide.replace(format + 10, 13, "'900000000D' "), "cannot read kernel table");
  std::string text = good;
  refused(text.replace(format + 10, 8, "'8A    '"), "cannot read kernel table");
  put(files.path, good.substr(0, 2880 * (good.find("XTENSION") / 2880)));
  files.refused("it has no table POLY");
}

BOOST_AUTO_TEST_CASE(coefficients_that_are_no_numbers_are_refused) {
  const Files files;
  Kernel kernel = example();
  kernel.polynomial.coefficient.setConstant(12345.678);
  write_kernel_table(kernel, {}, files.path);
  std::string fits = content(files.path);
  const std::string value("\x40\xc8\x1c\xd6\xc8\xb4\x39\x58", 8), nan("\x7f\xf8\0\0\0\0\0\0", 8);
  BOOST_REQUIRE(fits.find(value) != std::string::npos);
  put(files.path, fits.replace(fits.find(value), 8, nan));
  files.refused("not finite");
}

BOOST_AUTO_TEST_SUITE_END()
