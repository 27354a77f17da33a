#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace misfit::ms_io {

/// The states of all files of some tables and their subtables, lock files apart: when they were last changed, how long they
/// are, and which ones they are.
class FileStates {
 public:
  void remember(const std::string& table);
  /// The files that changed since they were remembered, are there no more, or are new, as paths, in the order of their names.
  std::vector<std::string> changed() const;

 private:
  struct State {
    std::int64_t changed_s = 0, changed_ns = 0, bytes = 0;
    std::uint64_t device = 0, number = 0;
    bool operator==(const State& other) const;
  };
  using States = std::map<std::string, State>;  ///< by path

  static void look(const std::string& table, States& states);

  std::vector<std::string> tables_;
  States before_;
};

}  // namespace misfit::ms_io
