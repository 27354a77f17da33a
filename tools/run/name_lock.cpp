#include "tools/run/name_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <string_view>

namespace misfit::tools {
namespace {

/// True if the file that was opened still lies under its name: the last holder of the lock removes it.
bool is_in_place(int file, const std::string& path) {
  struct stat opened = {};
  struct stat named = {};
  return fstat(file, &opened) == 0 && stat(path.c_str(), &named) == 0 && opened.st_ino == named.st_ino &&
         opened.st_dev == named.st_dev;
}

/// The holder, as it wrote itself: "process 12 on host".
std::string holder(int file) {
  std::array<char, 512> text{};
  const ssize_t size = pread(file, text.data(), text.size(), 0);
  const std::string_view told(text.data(), size > 0 ? static_cast<std::size_t>(size) : 0);
  const std::string who(told.substr(0, told.find('\n')));
  return who.empty() ? "" : ", " + who;
}

std::string own_name() {
  std::array<char, 256> host{};
  gethostname(host.data(), host.size() - 1);
  return "process " + std::to_string(getpid()) + " on " + host.data() + "\n";
}

}  // namespace

NameLock::NameLock(const std::string& imagename, const std::string& option) : path_(imagename + ".lock") {
  do {
    if (file_ >= 0) close(file_);
    file_ = open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
    if (file_ < 0) throw std::runtime_error("cannot write " + path_ + ": " + std::strerror(errno));
    if (flock(file_, LOCK_EX | LOCK_NB) == 0) continue;
    if (errno != EWOULDBLOCK) return;
    const std::string who = holder(file_);
    close(file_);
    throw std::runtime_error("another run is making " + imagename + ".*" + who + "; expected another " + option +
                             ", or the end of that run");
  } while (!is_in_place(file_, path_));
  const std::string name = own_name();
  if (ftruncate(file_, 0) == 0) static_cast<void>(pwrite(file_, name.data(), name.size(), 0));  // a courtesy, and no more
}

NameLock::~NameLock() {
  if (is_in_place(file_, path_)) unlink(path_.c_str());
  close(file_);
}

}  // namespace misfit::tools
