#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "framework/control/observer.h"

namespace tactus::runtime {

/// A task, joint or link that something was wrong with.
struct Fault {
  std::string name;
  double first_time = 0;                                           ///< s
  long ticks = 0;                                                  ///< of ignored contacts: how many of them
};

/// How the controller fared over a run: ticks that went another way than the plain one, and its wall-clock times.
class RunStatistics final : public control::Observer {
 public:
  /// Wall-clock times that are kept at most, whatever the length of the run.
  static constexpr long most_times = 1 << 21;

  explicit RunStatistics(long expected_ticks) {
    tick_us_.reserve(static_cast<size_t>(std::clamp(expected_ticks, 0L, most_times)));
  }

  void observe(const control::ObservedTick& tick) override;

  long ticks() const { return ticks_; }
  /// µs, of every tick; of every 2nd, 4th, … in a run that is longer than `most_times`.
  const std::vector<double>& tickTimes() const { return tick_us_; }
  /// Tasks whose numbers made ticks fall back.
  const std::vector<Fault>& unusableTasks() const { return unusable_; }
  /// Joints that were not sensed: their last good values stood in, or the weight alone was borne.
  const std::vector<Fault>& lostJoints() const { return lost_joints_; }
  /// Links some of whose contacts were no numbers and were ignored; "" for contacts of no link.
  const std::vector<Fault>& ignoredContacts() const { return ignored_contacts_; }
  /// Joints that moved faster than their own velocity limit.
  const std::vector<Fault>& fastJoints() const { return fast_joints_; }
  /// What the reader of the run's figures must know, a sentence each.
  std::vector<std::string> warnings() const;

  long fallbacks = 0;                                              ///< the back end failed; another torque was held
  long infeasible = 0;
  long limited = 0;                                                ///< the torque was scaled or cut into its limits
  long late = 0;                                                   ///< the back end missed its deadline
  long rate_limited = 0;                                           ///< the torque was kept from changing faster
  long partial = 0;                                                ///< by TorqueSource, of the ticks that fell back
  long held = 0;
  long gravity = 0;
  long blind = 0;                                                  ///< some joint was unknown for too long
  long lost_rank = 0;                                              ///< a level's rows were dependent or faded
  bool has_kkt = false;
  control::KktResidual kkt_max;                                    ///< worst of the run, each of its own tick

 private:
  void keepTime(double tick_us);
  void noteSensing(const control::ObservedTick& tick);
  void noteSpeeds(const control::ObservedTick& tick);

  long ticks_ = 0;
  long stride_ = 1;                                                ///< every how many-th time is kept
  std::vector<double> tick_us_;
  std::vector<Fault> unusable_;
  std::vector<Fault> lost_joints_;
  std::vector<Fault> ignored_contacts_;
  std::vector<Fault> fast_joints_;
};

}  // namespace tactus::runtime
