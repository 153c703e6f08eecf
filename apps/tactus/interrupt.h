#pragma once

#include <atomic>
#include <stdexcept>

namespace tactus::app {

/// Thrown where an interrupted run has nothing to keep; exit code 130.
class Interrupted : public std::runtime_error {
 public:
  Interrupted() : std::runtime_error("interrupted") {}
};

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
