#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "framework/control/observer.h"
#include "framework/description/robot.h"
#include "framework/runtime/contact_metrics.h"

namespace tactus::app {

/// A link that has touched, with the normal forces of all its touches added.
struct LiveLink {
  std::string name;
  bool desired = false;
  double force_N = 0;                                              ///< now
  double mean_N = 0;                                               ///< of the ticks in which it touched
  double largest_N = 0;
};

/// How a run stands.
struct LiveState {
  double time = 0, duration = 0;                                   ///< s
  double rate = 0;                                                 ///< × real time; 0: not known yet
  runtime::ContactMetrics::Now now;
  std::vector<LiveLink> links;                                     ///< those that have touched, in the robot's order
};

/// "12.3 of 30.0 s, 2.4 × real time, 0:07 left"
std::string liveProgress(const LiveState& state);
/// "7 links, mean 0.51, largest 0.83, undesired 0.00 N"
std::string liveForces(const LiveState& state);
/// These two, and a row for each link with a bar for its force: at most `height` lines of at most `width` characters.
std::vector<std::string> liveTable(const LiveState& state, size_t width, size_t height);

/// Contacts and forces on stderr as a run goes.  On a terminal a table, drawn anew five times a second and taken away
/// at the end; nothing of the terminal's settings is touched.  Elsewhere a line at every tenth of the run, and after
/// every 30 s of the wall clock without one.
class LiveView final : public control::Observer {
 public:
  /// `robot` and `contacts`, which observes before, outlive it; `from`, s, is where the run begins.
  LiveView(const description::Robot& robot, const runtime::ContactMetrics& contacts, double from, double duration);
  ~LiveView() override;

  void observe(const control::ObservedTick& tick) override;

 private:
  using Clock = std::chrono::steady_clock;
  struct Touch {
    double force_N = 0, sum_N = 0, largest_N = 0;
    long ticks = 0;
  };

  LiveState state(double time, Clock::time_point now) const;
  void redraw(const LiveState& state);

  const description::Robot& robot_;
  const runtime::ContactMetrics& contacts_;
  double from_, duration_;                                         ///< s
  bool terminal_;
  std::vector<Touch> touches_;                                     ///< of each link
  Clock::time_point start_, shown_;
  int tenths_ = 0;                                                 ///< of the run that have been told
  size_t lines_ = 0;                                               ///< on the terminal
};

}  // namespace tactus::app
