#include "tools/scene/results_file.h"

#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "tools/base/files.h"

namespace misfit::tools {
namespace {

using nlohmann::json;

/// The members of a struct that are numbers, by name.
template <typename T>
struct Number {
  const char* name;
  double T::*value;
};

constexpr Number<SceneErrors> error_numbers[] = {
    {"rms", &SceneErrors::rms},
    {"rms_noise", &SceneErrors::rms_noise},
    {"max", &SceneErrors::max},
    {"centre_rms", &SceneErrors::centre_rms},
    {"centre_max", &SceneErrors::centre_max},
    {"border_rms", &SceneErrors::border_rms},
    {"border_max", &SceneErrors::border_max},
    {"predict_rms", &SceneErrors::predict_rms},
    {"predict_noise", &SceneErrors::predict_noise},
    {"predict_max", &SceneErrors::predict_max},
};
constexpr Number<SceneSeconds> second_numbers[] = {
    {"grid", &SceneSeconds::grid},
    {"fft", &SceneSeconds::fft},
    {"degrid", &SceneSeconds::degrid},
    {"predict_fft", &SceneSeconds::predict_fft},
};
constexpr Number<PointResult> result_numbers[] = {
    {"x0", &PointResult::x0},
    {"padding", &PointResult::padding},
    {"memory_bytes", &PointResult::memory_bytes},
    {"expected_rms", &PointResult::expected_rms},
    {"bound_rms", &PointResult::bound_rms},
    {"bound_max", &PointResult::bound_max},
};

/// JSON has no number for what is not finite.
template <typename T, std::size_t N>
void put(const T& of, const Number<T> (&numbers)[N], json& to) {
  for (const auto& [name, value] : numbers) to[name] = std::isfinite(of.*value) ? json(of.*value) : json();
}
template <typename T, std::size_t N>
void take(const json& from, const Number<T> (&numbers)[N], T& to) {
  for (const auto& [name, value] : numbers)
    to.*value = from.at(name).is_null() ? std::numeric_limits<double>::quiet_NaN() : from.at(name).template get<double>();
}

json json_of(const PointResult& r) {
  json value{{"options", options_text(r.point)},
             {"refused", r.refused},
             {"width", r.width},
             {"width_w", r.width_w},
             {"passes", r.passes},
             {"evaluation", r.evaluation},
             {"precision", r.precision},
             {"work", r.work}};
  put(r, result_numbers, value);
  put(r.errors, error_numbers, value["errors"]);
  value["runs"] = json::array();
  for (const SceneSeconds& run : r.runs) {
    json& written = value["runs"].emplace_back();
    put(run, second_numbers, written);
    written["stretch"] = run.stretch;
  }
  return value;
}

void take_result(const json& value, PointResult& r) {
  r.refused = value.at("refused");
  r.width = value.at("width");
  r.width_w = value.at("width_w");
  r.passes = value.at("passes");
  r.evaluation = value.at("evaluation");
  r.precision = value.at("precision");
  r.work = value.at("work");
  take(value, result_numbers, r);
  take(value.at("errors"), error_numbers, r.errors);
  for (const json& run : value.at("runs")) {
    SceneSeconds& taken = r.runs.emplace_back();
    take(run, second_numbers, taken);
    taken.stretch = run.at("stretch");
    if (!(taken.image() > 0)) throw std::runtime_error("a run took no time");
  }
}

/// Names of what the two do not have in common: "version, threads".
std::string differences(const json& has, const json& expected) {
  std::string names;
  json all = expected;
  all.update(has);
  for (const auto& [name, value] : all.items())
    if (has.value(name, json()) != expected.value(name, json())) names += (names.empty() ? "" : ", ") + name;
  return names;
}

}  // namespace

void write_results(const std::string& path, const json& owner, const std::vector<PointResult>& results) {
  json content{{"owner", owner}, {"results", json::array()}};
  for (const PointResult& r : results)
    if (!r.runs.empty() || !r.refused.empty()) content["results"].push_back(json_of(r));
  write_file(path, content.dump() + "\n");
}

FoundResults read_results(const std::string& path, const json& owner, std::vector<PointResult>& results) {
  std::error_code none;
  if (!std::filesystem::is_regular_file(path, none)) return {};
  std::vector<PointResult> found = results;
  FoundResults taken;
  try {
    const json content = json::parse(read_file(path));
    const json& has = content.at("owner");
    if (has != owner) return {0, "it was measured with other " + differences(has, owner)};
    for (const json& value : content.at("results"))
      for (PointResult& r : found)
        if (value.at("options") == options_text(r.point)) {
          take_result(value, r);
          taken.runs += r.runs.size();
        }
  } catch (const std::exception&) {
    return {0, "it is damaged"};
  }
  results = std::move(found);
  return taken;
}

}  // namespace misfit::tools
