#pragma once

#include <limits>
#include <string>
#include <vector>

#include "framework/control/registry.h"

namespace tactus::tasks {

/// A state machine: what the robot is at.  Each phase is a port, 1 while the machine is in it, so that tasks and levels
/// take part by `active="machine.phase"`; they fade in and out as their ramps say.
///
/// A phase is left by the first of its <next> whose guard has held for its time `for`; at most one change a tick.  The
/// guard holds while the port `when` is above `above` or below `below`, and once the phase has lasted `after`.
class Phases final : public control::Signal {
 public:
  static void registerIn(control::Registry& registry);

  explicit Phases(const control::BuildContext& context);

  void columns(std::vector<control::LogColumn>& columns) const override;
  void metrics(std::vector<control::Metric>& metrics) const override;

 private:
  struct Next {
    int to = 0;
    const double* when = nullptr;
    double above = -std::numeric_limits<double>::infinity();
    double below = std::numeric_limits<double>::infinity();
    double hold = 0;                                               ///< s
    double after = 0;                                              ///< s
    double held_since = -1;                                        ///< s; -1 = it does not hold
    void archive(control::Archive& archive) { archive("held-since", held_since); }
  };
  struct Phase {
    std::string name;
    std::vector<Next> next;
    double active = 0;                                             ///< 1 while the machine is in it
    double time = 0;                                               ///< s spent in it
    void archive(control::Archive& archive) {
      archive("next", next);
      archive("active", active);
      archive("time", time);
    }
  };

  void doUpdate(const control::Tick& tick) override;
  const void* doPort(std::string_view name) const override;
  void doArchive(control::Archive& archive) override;
  void enter(int phase, double time);

  std::vector<Phase> phases_;
  int current_ = -1;
  double entered_ = 0;                                             ///< s
  double last_update_ = 0;                                         ///< s
  double time_in_phase_ = 0;                                       ///< s
  double index_ = 0;                                               ///< of the phase, from 1
  double changes_ = 0;
};

}  // namespace tactus::tasks
