#include <sys/stat.h>

#include <filesystem>
#include <tuple>

#include "ms_io/file_states_internal.h"

namespace misfit::ms_io {

namespace fs = std::filesystem;

bool FileStates::State::operator==(const State& other) const {
  const auto all = [](const State& s) { return std::tie(s.changed_s, s.changed_ns, s.bytes, s.device, s.number); };
  return all(*this) == all(other);
}

void FileStates::remember(const std::string& table) {
  tables_.push_back(table);
  look(table, before_);
}

void FileStates::look(const std::string& table, States& states) {
  std::error_code ignored;  // what cannot be looked at, others complain of
  for (fs::recursive_directory_iterator entry(table, ignored), end; entry != end; entry.increment(ignored)) {
    struct stat found = {};
    const std::string path = entry->path();
    if (entry->path().filename() == "table.lock" || stat(path.c_str(), &found) != 0 || !S_ISREG(found.st_mode)) continue;
    states[path] = {found.st_mtim.tv_sec, found.st_mtim.tv_nsec, found.st_size, found.st_dev, found.st_ino};
  }
}

std::vector<std::string> FileStates::changed() const {
  std::vector<std::string> paths;
  States now;
  for (const std::string& table : tables_) look(table, now);
  for (const auto& [path, state] : before_) {
    const auto found = now.find(path);
    if (found == now.end() || !(found->second == state)) paths.push_back(path);
  }
  for (const auto& [path, state] : now)
    if (before_.find(path) == before_.end()) paths.push_back(path);
  return paths;
}

}  // namespace misfit::ms_io
