#pragma once

#include <atomic>

namespace tactus::app {

/// While it lives, Ctrl-C and a polite kill (SIGINT, SIGTERM) raise `stop()` instead of ending the program: a run
/// then ends with everything written.  A second signal ends the program at once.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  const std::atomic<bool>& stop() const;
};

}  // namespace tactus::app
