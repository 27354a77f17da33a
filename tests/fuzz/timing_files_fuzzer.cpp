// What the folder of caches keeps of earlier runs' times: times.json and costs.json. Any content is taken or left; none is an
// error. MACHINE in it stands for this one.
#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/fuzz/fuzzing.h"
#include "tools/kernel_choice/machine_costs.h"
#include "tools/run/time_forecast.h"

using namespace misfit;
using namespace misfit::fuzz;

namespace {

std::string of_this_machine(std::string text) {
  static const std::string name = nlohmann::json(tools::machine_name()).dump();
  const std::string placeholder = "\"MACHINE\"";
  if (const std::size_t at = text.find(placeholder); at != std::string::npos) text.replace(at, placeholder.size(), name);
  return text;
}

InputFile input(const std::string& content, const std::string& name) {
  return {reinterpret_cast<const std::uint8_t*>(content.data()), content.size(), name};
}

void require_times(const std::string& content) {
  const InputFile file = input(content, "times.json");
  tools::TimeForecast forecast(file.folder());
  imager::GriddingPlan plan;
  plan.direct = true;
  tools::RunWork work;
  work.plan = &plan;
  work.rows = work.samples = 1 << 10;
  work.pixels = 1 << 4;
  work.deconvolver = "hogbom";
  work.major_cycles = 1;
  imager::StageTimes took;
  for (const tools::StageSeconds& s : forecast.expected(work)) {
    require(std::isfinite(s.seconds) && s.seconds >= 0, "a stage takes a number of seconds");
    took.add(s.stage, 1);
  }
  forecast.learn(work, took);
  const tools::TimeForecast again(file.folder());
  const auto expected = forecast.expected(work), kept = again.expected(work);
  for (std::size_t i = 0; i < expected.size(); ++i) require(kept[i].seconds == expected[i].seconds, "what was learned is kept");
}

void require_costs(const std::string& content) {
  const InputFile file = input(content, "costs.json");
  const auto costs = tools::kept_costs(file.folder());
  require(!costs || (costs->sample_ns > 0 && std::isfinite(costs->double_cost)), "costs are numbers above 0");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string content = of_this_machine({reinterpret_cast<const char*>(data), size});
  require_times(content);
  require_costs(content);
  return 0;
}
