#pragma once

#include <functional>
#include <string>
#include <vector>

#include "framework/runtime/contact_metrics.h"
#include "framework/control/observer.h"

namespace tactus::runtime {

enum class ColumnSet {
  standard,                                                        ///< columns="default"
  all                                                              ///< joint positions, velocities and torques too
};

/// An object of the scene whose motion is logged.
struct MovingObject {
  std::string name;
  int index = 0;                                                   ///< in ObservedTick::objects
};

/// The columns of log.csv: slash-separated names, `time` first, and where each value stands.
///
///     time
///     level/<priority>/{rank,nullity,active,residual}
///     task/<name>/error, task/<name>/<the task's own>
///     task/<name>/share                                     of tasks that the stack switches on and off
///     level/<priority>/<controller>/<the controller's own>
///     signal/<name>/<the signal's own>
///     sensor/<name>/<port>, or <port>/0, <port>/1, … of a vector of at most 6 numbers; all of it in the set `all`
///     object/<name>/{x,y,z,qw,qx,qy,qz}                     of objects that move: m, and a quaternion with w ≥ 0
///     fault/<name>                                          of what was asked to go wrong: 1 while it strikes
///     measure/<name>/<the measure's own>
///     contact/{contacts,links,mean_N,max_N,undesired_max_N}, and self_max_N of robots that touch themselves
///     controller/{torque_norm,scale,status,fallback,limited}
///     controller/rate_limited, controller/late              when the controller declares a torque rate, a deadline
///     kkt/{stationarity,primal,complementarity}            when the back end says them
///     q/<joint>, qd/<joint>, tau/<joint>                   in the set `all`, with
///     sensing/{joints_held,contacts_ignored}
///
/// No column depends on wall-clock time: a log repeats to the byte.
class LogColumns {
 public:
  using Value = std::function<double(const control::ObservedTick&)>;

  /// Made from the first tick: what a back end tells is known only after it has solved once.
  /// `contacts` may be null; controller, contacts, faults and what stands behind `measures` must outlive this object.
  LogColumns(const control::Controller& controller, ColumnSet set, const ContactMetrics* contacts,
             const std::vector<MovingObject>& objects = {},
             const std::vector<const control::FaultRecord*>& faults = {},
             const std::vector<control::LogColumn>& measures = {});

  const std::vector<std::string>& names() const { return names_; }
  size_t size() const { return values_.size(); }
  double value(size_t column, const control::ObservedTick& tick) const { return values_[column](tick); }

 private:
  void add(std::string name, Value value);
  void addLevels(const control::Controller& controller);
  void addTasksAndSignals(const control::Controller& controller);
  void addSensors(const control::Readings& readings, ColumnSet set);
  void addObjects(const std::vector<MovingObject>& objects);
  void addContacts(const ContactMetrics& contacts);
  void addController(const control::Controller& controller);
  void addJoints(const control::Controller& controller);

  std::vector<std::string> names_;
  std::vector<Value> values_;
};

}  // namespace tactus::runtime
