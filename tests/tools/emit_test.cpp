// Kernels for other imagers: what their files hold does what is said of it.
#include <boost/test/data/test_case.hpp>

#include "kernels/catalogue.h"
#include "tests/tools/emulated_hosts.h"
#include "tests/tools/program.h"
#include "tools/emit/hosts.h"

namespace bdata = boost::unit_test::data;
namespace {

using namespace misfit;
using namespace misfit::tools::testing;
using nlohmann::json;

const std::vector<std::string> emulated{"wsclean", "ducc", "finufft", "yandasoft", "c-header", "csv"};

struct Scene {
  TemporaryFolder folder;
  std::string file = folder / "k";

  Arguments emit(const std::string& host, const Arguments& more) const {
    return Arguments{"kernel", "--emit", host, "--output", file} + more;
  }
  json emitted(const std::string& host, const Arguments& more) const {
    return json::parse(run(emit(host, more) + Arguments{"--json"}).out);
  }
};

constexpr int pixels = 180;

/// With four digits of a random sky's 800 visibilities known to 4 %, and 180 pixels standing for a continuum to 3 %.
void check_agrees(double measured, double predicted) {
  BOOST_TEST(measured < 1.1 * predicted);
  BOOST_TEST(measured > 0.9 * predicted);
}

}  // namespace

BOOST_AUTO_TEST_SUITE(emit)

BOOST_DATA_TEST_CASE(a_host_errs_by_what_is_said, bdata::make(emulated) * bdata::make({1.2, 1.6, 2.0}) * bdata::make({4, 7, 8}),
                     host, padding, width) {
  const Scene scene;
  const std::string number = std::to_string(padding);
  const json said = scene.emitted(host, {"--width", std::to_string(width), "--padding", number, "--host-padding", number,
                                         "--imsize", std::to_string(pixels)});
  const EmulatedHost emulation = emulated_host(host, content(scene.file));
  const int fft_size = static_cast<int>(std::lround(pixels * padding));
  check_agrees(measured_error(emulation, false, pixels, fft_size), said["error"]["rms"]);
  BOOST_TEST(said["error_with_own_correction"].is_null() == !emulation.own_divisor);
  if (emulation.own_divisor)
    check_agrees(measured_error(emulation, true, pixels, fft_size), said["error_with_own_correction"]["rms"]);
}

BOOST_AUTO_TEST_SUITE_END()
