#include "tools/scene/results_file.h"

#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "tools/base/files.h"
#include "tools/base/json_text.h"

namespace misfit::tools {
namespace {

using nlohmann::json;

/// A member of a struct, by name.
template <typename T, typename V>
struct Member {
  const char* name;
  V T::*value;
};

constexpr Member<SceneErrors, double> error_numbers[] = {
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
constexpr Member<SceneSeconds, double> second_numbers[] = {
    {"grid", &SceneSeconds::grid},
    {"fft", &SceneSeconds::fft},
    {"degrid", &SceneSeconds::degrid},
    {"predict_fft", &SceneSeconds::predict_fft},
};
constexpr Member<PointResult, double> result_numbers[] = {
    {"x0", &PointResult::x0},
    {"padding", &PointResult::padding},
    {"memory_bytes", &PointResult::memory_bytes},
    {"expected_rms", &PointResult::expected_rms},
    {"bound_rms", &PointResult::bound_rms},
    {"bound_max", &PointResult::bound_max},
};

constexpr Member<SceneSeconds, int> second_counts[] = {{"stretch", &SceneSeconds::stretch}};
constexpr Member<PointResult, int> result_counts[] = {
    {"width", &PointResult::width},
    {"width_w", &PointResult::width_w},
    {"passes", &PointResult::passes},
};
constexpr Member<PointResult, std::string> result_words[] = {
    {"refused", &PointResult::refused},
    {"evaluation", &PointResult::evaluation},
    {"precision", &PointResult::precision},
    {"work", &PointResult::work},
};

/// A number as JSON, which has none that is not finite.
json json_of(double value) {
  return std::isfinite(value) ? json(value) : json();
}
template <typename V>
json json_of(const V& value) {
  return value;
}
void take(const json& from, double& to) {
  to = from.is_null() ? std::numeric_limits<double>::quiet_NaN() : from.get<double>();
}
void take(const json& from, int& to) {
  if (!from.is_number_integer() || from < std::numeric_limits<int>::min() || from > std::numeric_limits<int>::max())
    throw std::runtime_error("a count is no whole number");
  from.get_to(to);
}
void take(const json& from, std::string& to) {
  from.get_to(to);
}

template <typename T, typename V, std::size_t N>
void put(const T& of, const Member<T, V> (&members)[N], json& to) {
  for (const auto& [name, value] : members) to[name] = json_of(of.*value);
}
template <typename T, typename V, std::size_t N>
void take(const json& from, const Member<T, V> (&members)[N], T& to) {
  for (const auto& [name, value] : members) take(from.at(name), to.*value);
}

json written(const PointResult& r) {
  json value{{"options", options_text(r.point)}};
  put(r, result_words, value);
  put(r, result_counts, value);
  put(r, result_numbers, value);
  put(r.errors, error_numbers, value["errors"]);
  value["runs"] = json::array();
  for (const SceneSeconds& seconds : r.runs) {
    json& run = value["runs"].emplace_back();
    put(seconds, second_numbers, run);
    put(seconds, second_counts, run);
  }
  return value;
}

void take_result(const json& value, PointResult& r) {
  take(value, result_words, r);
  take(value, result_counts, r);
  take(value, result_numbers, r);
  take(value.at("errors"), error_numbers, r.errors);
  for (const json& run : value.at("runs")) {
    SceneSeconds& seconds = r.runs.emplace_back();
    take(run, second_numbers, seconds);
    take(run, second_counts, seconds);
    if (!(seconds.image() > 0)) throw std::runtime_error("a run took no time");
  }
}

/// The names of members in which the two differ: "version, threads".
std::string differences(const json& has, const json& expected) {
  std::set<std::string> all;
  for (const json* of : {&has, &expected})
    for (const auto& [name, value] : of->items()) all.insert(name);
  const json nothing;
  const auto at = [&](const json& of, const std::string& name) -> const json& {  // a copy takes stack for every bracket
    const auto found = of.find(name);
    return found == of.end() ? nothing : *found;
  };
  std::string names;
  for (const std::string& name : all)
    if (at(has, name) != at(expected, name)) names += (names.empty() ? "" : ", ") + name;
  return names;
}

}  // namespace

void write_results(const std::string& path, const json& owner, const std::vector<PointResult>& results) {
  json content{{"owner", owner}, {"results", json::array()}};
  for (const PointResult& r : results)
    if (!r.runs.empty() || !r.refused.empty()) content["results"].push_back(written(r));
  write_file(path, json_text(content) + "\n");
}

FoundResults read_results(const std::string& path, const json& owner, std::vector<PointResult>& results) {
  std::error_code none;
  if (!std::filesystem::is_regular_file(path, none)) return {};
  std::vector<PointResult> found = results;
  FoundResults taken;
  try {
    const json content = json::parse(read_file(path));
    const json& has = content.at("owner");
    if (!has.is_object()) throw std::runtime_error("nothing says what it belongs to");
    if (has != owner) return {0, "it was measured with other " + differences(has, owner)};
    for (const json& value : content.at("results"))
      for (PointResult& r : found)
        if (value.at("options") == options_text(r.point)) {
          take_result(value, r);
          taken.runs += value.at("runs").size();
        }
  } catch (const std::exception&) {
    return {0, "it is damaged"};
  }
  results = std::move(found);
  return taken;
}

}  // namespace misfit::tools
