#pragma once

#include <string>
#include <vector>

#include "framework/control/archive.h"
#include "framework/control/tick.h"
#include "framework/control/tick_problem.h"

namespace tactus::control {

/// One thing that the robot should do: each tick it fills rows J, F (see TickTask).  A task knows neither its
/// priority nor its weight nor the back end.
///
/// A class derived from it takes all its memory in the constructor; `doUpdate` sets `rows.rows` ≤ capacity and
/// writes jacobian, force and, if it wants, acceleration of these rows, allocating nothing.
class Task {
 public:
  virtual ~Task() = default;

  Relation relation() const { return relation_; }
  int capacity() const { return capacity_; }
  bool isContact() const { return contact_; }

  void update(const Tick& tick, TickTask& rows) { doUpdate(tick, rows); }
  /// A measure of how far the task is from its goal in this tick (its unit is the task's; 0 = done).
  double error() const { return error_; }
  /// What J is the derivative of, for checks that hold it against differences: how far each row's quantity moves while
  /// the robot goes from the state of the last update to another one close by; Δx = J Δq + O(‖Δq‖²), in m or rad, a
  /// turn as angle-axis in the rows' axes.  False where the task does not tell.
  virtual bool displacement(const dynamics::DynamicsCache& /*from*/, const dynamics::DynamicsCache& /*to*/,
                            Eigen::Ref<Eigen::VectorXd> /*dx*/) const {
    return false;
  }
  /// More numbers for the log than the error; pointers stay valid.
  virtual void columns(std::vector<LogColumn>&) const {}
  /// What it steers for, for a replay of the run; pointers stay valid.
  virtual void marks(std::vector<Mark>&) const {}
  /// Figures of the whole run.
  virtual void metrics(std::vector<Metric>&) const {}
  /// What it carries from one tick to the next.
  void archive(Archive& archive) {
    archive("error", error_);
    doArchive(archive);
  }

 protected:
  Task(Relation relation, int capacity, bool contact = false)
      : relation_(relation), capacity_(capacity), contact_(contact) {}
  double error_ = 0;

 private:
  virtual void doUpdate(const Tick& tick, TickTask& rows) = 0;
  virtual void doArchive(Archive&) {}

  Relation relation_;
  int capacity_;
  bool contact_;
};

}  // namespace tactus::control
