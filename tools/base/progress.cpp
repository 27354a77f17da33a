#include "tools/base/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <utility>

#include "tools/base/interrupt.h"
#include "tools/base/numbers.h"
#include "tools/base/text.h"

namespace misfit::tools {
namespace {

std::function<void(const std::string&)> listener;

void tell(const std::string& line) {
  if (listener)
    listener(line);
  else
    std::fprintf(stderr, "%s\n", line.c_str());
}

}  // namespace

void tell_lines(std::function<void(const std::string&)> tell) {
  listener = std::move(tell);
}

ProgressLine::ProgressLine(bool quiet) : quiet_(quiet), live_(!quiet && !listener && isatty(STDERR_FILENO) != 0) {
  catch_interrupts();
}

ProgressLine::~ProgressLine() {
  clear();
}

void ProgressLine::begin(const std::string& stage, bool stops_itself) {
  const std::lock_guard lock(mutex_);
  stage_ = stage;
  stops_itself_ = stops_itself;
  open_ = true;
  start_ = drawn_ = std::chrono::steady_clock::now();
  if (live_) std::fprintf(stderr, "\r\033[K%s", stage.c_str());
}

void ProgressLine::update(std::uint64_t done, std::uint64_t total) {
  const std::lock_guard lock(mutex_);
  if (interrupted() && (!stops_itself_ || interrupted_again())) throw Interrupted();
  const auto now = std::chrono::steady_clock::now();
  if (!live_ || done == 0 || total == 0 || now - drawn_ < std::chrono::milliseconds(100)) return;
  drawn_ = now;
  const double fraction = static_cast<double>(done) / static_cast<double>(total);
  std::fprintf(stderr, "\r\033[K%s  %3.0f%%  %s left", stage_.c_str(), 100 * fraction,
               duration(elapsed_s() * (1 / fraction - 1)).c_str());
}

void ProgressLine::end() {
  const std::lock_guard lock(mutex_);
  if (!open_) return;
  open_ = false;
  if (live_) std::fprintf(stderr, "\r\033[K");
  std::string stage = stage_;
  stage.resize(std::max<std::size_t>(stage.size(), 24), ' ');
  if (!quiet_) tell(stage + " " + duration(elapsed_s()));
}

void ProgressLine::say(const std::string& line) {
  if (quiet_) return;
  const std::lock_guard lock(mutex_);
  if (live_) std::fprintf(stderr, "\r\033[K");
  tell(legible(line));
}

double ProgressLine::elapsed_s() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

void ProgressLine::clear() {
  if (open_ && live_) std::fprintf(stderr, "\r\033[K");
}

}  // namespace misfit::tools
