#include "tools/kernel_choice/machine_costs.h"

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "kernels/version.h"
#include "tools/base/files.h"
#include "tools/base/json_text.h"

namespace misfit::tools {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

struct Constant {
  const char* name;
  double imager::CostModel::*value;
};
constexpr Constant constants[] = {{"sample_ns", &imager::CostModel::sample_ns},
                                  {"cell_ns", &imager::CostModel::cell_ns},
                                  {"tap_ns", &imager::CostModel::tap_ns},
                                  {"fft_ns", &imager::CostModel::fft_ns},
                                  {"double_cost", &imager::CostModel::double_cost}};

/// The costs in a file, if they are this machine's.
std::optional<imager::CostModel> costs_in(const std::string& content) {
  const json kept = json::parse(content, nullptr, false);
  if (!kept.is_object() || !kept.contains("machine") || kept["machine"] != machine_name()) return {};
  imager::CostModel model;
  for (const Constant& constant : constants) {
    if (!kept.contains(constant.name)) return {};
    const json& value = kept[constant.name];  // a copy takes as much stack as a damaged file has brackets
    if (!value.is_number() || !(value.get<double>() > 0) || !std::isfinite(value.get<double>())) return {};
    model.*constant.value = value.get<double>();
  }
  return model;
}

fs::path costs_file(const fs::path& folder) {
  return folder / "costs.json";
}

std::string text_of(const imager::CostModel& model) {
  json kept{{"machine", machine_name()}};
  for (const Constant& constant : constants) kept[constant.name] = model.*constant.value;
  return json_text(kept, 2) + "\n";
}

}  // namespace

std::string machine_name() {
  std::ifstream info("/proc/cpuinfo");
  std::string line;
  while (std::getline(info, line))
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 1) + ", misfit " MISFIT_VERSION;
  return "processor unknown, misfit " MISFIT_VERSION;
}

std::optional<imager::CostModel> kept_costs(const fs::path& folder) {
  const fs::path file = costs_file(folder);
  std::error_code none;
  return fs::is_regular_file(file, none) ? costs_in(read_file(file)) : std::nullopt;
}

imager::CostModel machine_costs(const fs::path& folder, const std::function<imager::CostModel()>& measure) {
  if (folder.empty()) return measure();
  if (const auto kept = kept_costs(folder)) return *kept;
  const imager::CostModel measured = measure();
  std::error_code none;
  fs::create_directories(folder, none);
  try {
    write_file(costs_file(folder), text_of(measured));
  } catch (const std::runtime_error&) {  // a folder that cannot be written is no cache, and no error
  }
  return measured;
}

}  // namespace misfit::tools
