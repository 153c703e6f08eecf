#pragma once

#include <vector>

#include "framework/control/tick.h"
#include "framework/control/observer.h"

namespace tactus::runtime {

/// A link's on/off contact state from its force: it goes on when the force has been at least `on_force` for
/// `hold` on end, and off when the force has been at most `off_force` for `hold` on end.
class TouchSwitch {
 public:
  static constexpr double on_force = 0.05;                         ///< N
  static constexpr double off_force = 0.02;                        ///< N
  static constexpr double hold = 0.005;                            ///< s

  /// Returns true when the state changed in this step of `dt` seconds.
  bool update(double force_N, double dt);
  bool on() const { return on_; }
  void archive(control::Archive& archive);

 private:
  bool on_ = false;
  double waited_ = 0;
};

/// Contact figures of a run, from the plant's records of every tick, unfiltered by any signal.
///
/// A *contact* of a tick is a pair (link, object) whose records' normal forces sum to more than 0 N.  It is
/// *desired* when its link is one of the desired links.  The *first touch* is the first tick with a desired
/// contact; everything but the undesired peak is counted from that tick on.  With `countWhile` no figure takes anything
/// from the other ticks, as if they had not been: the first touch is the first one of those that count.
///
/// | metric                     | definition                                                                       |
/// |----------------------------|----------------------------------------------------------------------------------|
/// | contact_force_mean_N       | mean force over all desired contacts of all ticks                                |
/// | contact_force_max_mean_N   | mean, over ticks with a desired contact, of that tick's largest desired force    |
/// | contact_force_peak_N       | largest desired force of the run                                                 |
/// | undesired_force_peak_N     | largest force of a contact that is not desired, in the whole run                 |
/// | links_in_contact_mean      | mean over ticks of the number of desired links that TouchSwitch calls on         |
/// | contact_switches_per_s     | changes of TouchSwitch, on and off, of all desired links, over the time counted  |
///
/// | self_force_peak_N          | largest force of a link on another link, in the whole run; of robots that touch  |
/// |                            | themselves.  No other figure counts such a touch                                 |
///
/// What was never met (no desired touch at all) is NaN.
class ContactMetrics final : public control::Observer {
 public:
  /// This tick's figures, for the log.
  struct Now {
    int contacts = 0;                                              ///< desired
    int links = 0;                                                 ///< desired, on
    double mean_N = 0;                                             ///< over the desired contacts, 0 without any
    double max_N = 0;
    double undesired_max_N = 0;
    double self_max_N = 0;                                         ///< a record's
  };

  /// `desired_links` are indices into Robot::links; `touches_itself`: the robot has links that touch each other.
  ContactMetrics(int links, int objects, const std::vector<int>& desired_links, bool touches_itself = false);

  /// Figures come from ticks in which this port is above 0.5 alone; null: from all.
  void countWhile(const double* port) { count_while_ = port; }

  void observe(const control::ObservedTick& tick) override { update(tick.truth.contacts, tick.controller.period()); }
  void update(const std::vector<control::ContactRecord>& records, double dt);

  const Now& now() const { return now_; }
  bool isDesired(int link) const { return desired_.at(static_cast<size_t>(link)); }
  bool touched() const { return ticks_ > 0; }
  bool touchesItself() const { return touches_itself_; }
  std::vector<control::Metric> metrics() const;
  void archive(control::Archive& archive);

 private:
  int objects_;
  bool touches_itself_;
  const double* count_while_ = nullptr;
  std::vector<bool> desired_;
  std::vector<double> pair_force_;                                 ///< N, link-major
  std::vector<TouchSwitch> switches_;
  Now now_;
  long ticks_ = 0;                                                 ///< from the first touch on
  long ticks_in_contact_ = 0;
  long contacts_ = 0;
  long switches_counted_ = 0;
  double time_ = 0;                                                ///< s, from the first touch on
  double force_sum_ = 0;
  double max_sum_ = 0;
  double peak_ = 0;
  double undesired_peak_ = 0;
  double self_peak_ = 0;
  double links_sum_ = 0;
};

}  // namespace tactus::runtime
