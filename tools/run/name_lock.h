#pragma once

#include <string>

namespace misfit::tools {

/// Keeps other runs from files of the same name: a lock of the system on <imagename>.lock, which ends with the process, however
/// that ends. The file goes with it, unless the process is killed.
class NameLock {
 public:
  /// Throws std::runtime_error that names the run that holds the name, which `option` gave, or the file where it cannot be
  /// made. Where the file system knows no locks, nothing is kept from anyone.
  explicit NameLock(const std::string& imagename, const std::string& option = "--imagename");
  NameLock(const NameLock&) = delete;
  NameLock& operator=(const NameLock&) = delete;
  ~NameLock();

 private:
  std::string path_;
  int file_ = -1;
};

}  // namespace misfit::tools
