#include "apps/tactus/progress.h"

#include <unistd.h>

#include <cstdio>

namespace tactus::app {
namespace {

constexpr std::chrono::milliseconds interval{100};

}  // namespace

Progress::Progress(double duration, std::string label, double from)
    : terminal_(::isatty(STDERR_FILENO) == 1),
      duration_(duration),
      from_(from),
      label_(std::move(label)),
      start_(Clock::now()),
      shown_(start_) {}

Progress::~Progress() {
  if (terminal_) std::fputs("\r\033[K", stderr);
}

void Progress::observe(const control::ObservedTick& tick) {
  if (!terminal_) return;
  const auto now = Clock::now();
  if (now - shown_ < interval) return;
  shown_ = now;
  const double wall = std::chrono::duration<double>(now - start_).count();
  std::fprintf(stderr, "\r\033[K%s%.1f of %.1f s, %.1f × real time", label_.c_str(), tick.sensed.time, duration_,
               (tick.sensed.time - from_) / wall);
}

}  // namespace tactus::app
