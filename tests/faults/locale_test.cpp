// Where numbers have decimal commas, and points between thousands.
#include <clocale>
#include <cstdlib>
#include <locale>

#include "imager/files/fits_image.h"
#include "kernels/catalogue.h"
#include "kernels/kernel_table.h"
#include "kernels/whole_file.h"
#include "tests/faults/replaced_products.h"

BOOST_AUTO_TEST_SUITE(locale)

using namespace misfit::tools::testing;
namespace kernels = misfit::kernels;
namespace imager = misfit::imager;

namespace {

constexpr const char* german = "de_DE.UTF-8";

/// Where the C library looks for locales, of which Debian installs few.
class LocaleFolder {
 public:
  LocaleFolder() : path_("LOCPATH", folder_ / "") {
    const Outcome made = Child({"-i", "de_DE", "-f", "UTF-8", folder_ / german}, "localedef").wait();
    BOOST_REQUIRE_EQUAL(made.code, 0);
  }

 private:
  TemporaryFolder folder_;
  EnvironmentVariable path_;
};

/// Of this process, for programs whose libraries we are.
class GermanNumbers {
 public:
  GermanNumbers() {
    BOOST_REQUIRE(std::setlocale(LC_ALL, german) != nullptr);
    BOOST_REQUIRE_EQUAL(std::localeconv()->decimal_point, ",");
    std::locale::global(std::locale(german));
  }
  GermanNumbers(const GermanNumbers&) = delete;
  GermanNumbers& operator=(const GermanNumbers&) = delete;
  ~GermanNumbers() { std::locale::global(std::locale::classic()); }

 private:
  LocaleFolder folder_;
};

/// What the libraries write, which they can read.
std::string written(const std::string& folder) {
  std::filesystem::create_directory(folder);
  const std::string table = folder + "/k.fits", image = folder + "/i.fits";
  const kernels::Kernel kernel = kernels::kernel_family("least-misfit").solve(5, 0.3125);
  kernels::write_kernel_table(kernel, kernels::TableSampling{}, table);
  BOOST_TEST(kernels::read_kernel_table(table).kernel.x0 == 0.3125);

  imager::SkyImage sky;
  sky.geometry = {1500, 2, 1.25e-6, {1.25, 0.75, "FK5"}};
  sky.image = imager::Image(1500, 2);
  sky.observation.frequency_hz = 1234567890.125;
  sky.cards = {{"MFBOUND", 1.5e-7, "of the image"}};
  imager::write_fits(sky, image, imager::PixelFormat::float32);
  BOOST_TEST(imager::read_fits(image).observation.frequency_hz == 1234567890.125);

  BOOST_TEST(kernels::is_temporary(kernels::temporary_beside(table)));
  const std::regex time("CHECKSUM= '.{16}'|updated [0-9T:-]{19}");  // differs from second to second
  return std::regex_replace(content(table), time, "") + content(image);
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_run_where_numbers_have_commas_writes_points) {
  const LocaleFolder folder;
  const EnvironmentVariable numbers("LC_ALL", german), language("LANG", german);
  products().restore();
  BOOST_TEST(run(products().run()).code == 0);
  products().expect(products().made());
}

BOOST_AUTO_TEST_CASE(libraries_of_a_program_where_numbers_have_commas_write_and_read_points) {
  const TemporaryFolder folder;
  const std::string points = written(folder / "a");
  const GermanNumbers numbers;
  BOOST_TEST((written(folder / "b") == points));
}

BOOST_AUTO_TEST_SUITE_END()
