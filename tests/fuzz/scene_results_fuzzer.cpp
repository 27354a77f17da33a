// What a comparison of kernels that was stopped left in its folder: results.json. Any content is taken or left; none is an
// error.
#include <nlohmann/json.hpp>
#include <vector>

#include "tests/fuzz/fuzzing.h"
#include "tools/scene/results_file.h"

using namespace misfit;
using namespace misfit::fuzz;

namespace {

const nlohmann::json owner{{"vis", "a"}, {"threads", 2}};

/// Two points that nothing was measured of.
std::vector<tools::PointResult> points() {
  std::vector<tools::PointResult> results(2);
  results[0].point.kernel = "least-misfit";
  results[1].point.kernel = "sinc";
  return results;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const InputFile file(data, size, "results.json");
  std::vector<tools::PointResult> results = points();
  const tools::FoundResults found = tools::read_results(file.path(), owner, results);
  std::size_t runs = 0;
  for (const tools::PointResult& r : results) {
    runs += r.runs.size();
    for (const tools::SceneSeconds& seconds : r.runs) require(seconds.image() > 0, "every run took some time");
  }
  require(runs == found.runs, "runs are those that are counted");
  require(found.not_used.empty() || runs == 0, "of a file that is not used nothing is");

  tools::write_results(file.path(), owner, results);
  std::vector<tools::PointResult> again = points();
  require(tools::read_results(file.path(), owner, again).runs == runs, "what is written is read");
  return 0;
}
