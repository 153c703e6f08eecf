#pragma once

#include <chrono>
#include <string>

#include "framework/control/observer.h"

namespace tactus::app {

/// One line on stderr, at most ten times a second, and only when stderr is a terminal: simulated time and the
/// real-time factor.
class Progress final : public control::Observer {
 public:
  /// `from`, s, is where the run begins.
  explicit Progress(double duration, std::string label = "", double from = 0);
  ~Progress() override;

  void observe(const control::ObservedTick& tick) override;

 private:
  using Clock = std::chrono::steady_clock;
  bool terminal_;
  double duration_, from_;                                         ///< s
  std::string label_;
  Clock::time_point start_, shown_;
};

}  // namespace tactus::app
