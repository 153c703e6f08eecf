#include "framework/control/conflict.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "framework/control/row_conflict.h"
#include "framework/control/whitened_problem.h"

namespace tactus::control {
namespace {

using Eigen::MatrixXd;
using Eigen::RowVectorXd;
using Kind = ConflictGroup::Kind;

constexpr int rows_per_friction_contact = 3;

/// What a row of a contact is in this tick.  A contact whose reference is negative backs off: its normal is an
/// inequality row, its tangents hold nothing.
enum class Role { task, force, backing_off, dropped };

Role roleOf(const TickTask& task, int row) {
  if (!task.contact) return Role::task;
  const int normal = task.friction ? row - row % rows_per_friction_contact : row;
  if (task.force[normal] >= 0) return Role::force;
  return row == normal ? Role::backing_off : Role::dropped;
}

/// The groups of a problem over x = (y, φ): τ_s = L y, φ = ‖J‖ f with ‖·‖ the M⁻¹ norm.
class Constraints {
 public:
  Constraints(const TickProblem& problem, const WhitenedProblem& whitened)
      : problem_(problem), whitened_(whitened), force_(whitened.rowCount(), -1), variables_(problem.dof) {
    for (int j = 0; j < whitened_.rowCount(); ++j)
      if (role(j) == Role::force) force_[j] = variables_++;
    for (int i = 0; i < static_cast<int>(problem_.levels.size()); ++i)
      for (int t = 0; t < static_cast<int>(problem_.levels[i].tasks.size()); ++t) {
        addRows(i, t);
        addForces(i, t);
      }
    if (problem_.torque_limits) addLimits();
  }

  const std::vector<RowGroup>& rows() const { return rows_; }
  const ConflictGroup& group(int i) const { return groups_[static_cast<std::size_t>(i)]; }

 private:
  const TickTask& taskOf(int j) const {
    return problem_.levels[whitened_.origin(j).level].tasks[whitened_.origin(j).task];
  }
  Role role(int j) const { return roleOf(taskOf(j), whitened_.origin(j).row); }
  double scale(int j) const { return whitened_.norm(j) > 0 ? whitened_.norm(j) : 1; }
  bool isOf(int j, int level, int task) const {
    return whitened_.origin(j).level == level && whitened_.origin(j).task == task;
  }
  RowVectorXd zero() const { return RowVectorXd::Zero(variables_); }

  void addRows(int level, int task) {
    begin();
    for (int j = 0; j < whitened_.rowCount(); ++j) {
      if (!isOf(j, level, task) || role(j) == Role::dropped) continue;
      const bool inequality = j >= whitened_.firstInequality() || role(j) == Role::backing_off;
      if (!inequality && role(j) != Role::force) continue;
      RowVectorXd row = zero();
      row.head(problem_.dof) = whitened_.norm(j) * whitened_.row(j).transpose();
      add(row, 0);
      if (!inequality) add(-row, 0);
    }
    end({Kind::rows, level, task, -1});
  }

  void addForces(int level, int task) {
    begin();
    for (int j = 0; j < whitened_.rowCount(); ++j) {
      if (!isOf(j, level, task) || force_[j] < 0) continue;
      const TickTask& contact = taskOf(j);
      if (contact.friction && whitened_.origin(j).row % rows_per_friction_contact != 0) continue;
      RowVectorXd normal = zero();
      normal[force_[j]] = 1 / scale(j);
      add(-normal, 0);
      if (std::isfinite(contact.force_max)) add(normal, contact.force_max);
      if (!contact.friction) continue;
      for (const double s1 : {1.0, -1.0})
        for (const double s2 : {1.0, -1.0}) {
          RowVectorXd side = -*contact.friction * normal;
          side[force_[j + 1]] = s1 / scale(j + 1);
          side[force_[j + 2]] = s2 / scale(j + 2);
          add(side, 0);
        }
    }
    end({Kind::forces, level, task, -1});
  }

  void addLimits() {
    const MatrixXd L = whitened_.massFactor().triangularView<Eigen::Lower>();
    for (int i = 0; i < problem_.dof; ++i) {
      RowVectorXd torque = zero();
      torque.head(problem_.dof) = L.row(i);
      for (int j = 0; j < whitened_.rowCount(); ++j)
        if (force_[j] >= 0) torque[force_[j]] = taskOf(j).jacobian(whitened_.origin(j).row, i) / scale(j);
      begin();
      if (std::isfinite(problem_.torque_limits->upper[i])) add(torque, problem_.torque_limits->upper[i]);
      if (std::isfinite(problem_.torque_limits->lower[i])) add(-torque, -problem_.torque_limits->lower[i]);
      end({Kind::torque_limit, -1, -1, i});
    }
  }

  void begin() { next_ = RowGroup{MatrixXd(0, variables_), Eigen::VectorXd(0)}; }
  void add(const RowVectorXd& row, double bound) {
    const Eigen::Index m = next_.rows.rows();
    next_.rows.conservativeResize(m + 1, variables_);
    next_.bounds.conservativeResize(m + 1);
    next_.rows.row(m) = row;
    next_.bounds[m] = bound;
  }
  void end(const ConflictGroup& group) {
    if (next_.bounds.size() == 0) return;
    rows_.push_back(next_);
    groups_.push_back(group);
  }

  const TickProblem& problem_;
  const WhitenedProblem& whitened_;
  std::vector<int> force_;                                         // variable of a row's force, or -1
  int variables_;
  RowGroup next_;
  std::vector<RowGroup> rows_;
  std::vector<ConflictGroup> groups_;
};

Relaxation relaxationOf(const Constraints& constraints, const std::vector<int>& conflict, int group) {
  Relaxation relaxation;
  relaxation.group = constraints.group(group);
  std::optional<Eigen::VectorXd> slack = leastSlack(constraints.rows(), group);
  relaxation.enough = slack.has_value();
  if (!slack) {
    std::vector<RowGroup> alone;
    for (const int i : conflict) alone.push_back(constraints.rows()[static_cast<std::size_t>(i)]);
    slack = leastSlack(alone, static_cast<int>(std::find(conflict.begin(), conflict.end(), group) - conflict.begin()));
  }
  if (!slack) return relaxation;
  Eigen::Index row = 0;
  relaxation.amount = slack->maxCoeff(&row);
  // The row of an upper limit is +τ: the sign of its last joint coordinate tells.
  if (relaxation.group.kind == Kind::torque_limit)
    relaxation.upper =
        constraints.rows()[static_cast<std::size_t>(group)].rows(row, relaxation.group.joint) > 0;
  return relaxation;
}

std::string numberText(double value) {
  char digits[32];
  const auto end = std::to_chars(digits, digits + sizeof digits, value, std::chars_format::general, 3).ptr;
  return {digits, end};
}

class Sentence {
 public:
  Sentence(const TickProblem& problem, const ConflictNames& names) : problem_(problem), names_(names) {}

  std::string text(const Conflict& conflict) const {
    if (conflict.exists()) return contradiction(conflict);
    if (conflict.beyond.empty()) return "";
    std::vector<std::string> parts;
    for (const LimitBeyond& beyond : conflict.beyond)
      parts.push_back("joint " + joint(beyond.joint) + " by " + numberText(beyond.beyond) + " N m");
    return "gravity and motion alone ask for more than the actuators have: " + list(parts, " and ") +
           "; a torque within the limits exists, but is no multiple of the tasks' torque";
  }

 private:
  std::string contradiction(const Conflict& conflict) const {
    std::vector<std::string> tasks, joints, ways;
    for (const ConflictGroup& group : conflict.groups) {
      if (group.kind == Kind::torque_limit) {
        joints.push_back(joint(group.joint));
        continue;
      }
      const std::string name = task(group);
      if (std::find(tasks.begin(), tasks.end(), name) == tasks.end()) tasks.push_back(name);
    }
    bool others = false;
    for (const Relaxation& relaxation : conflict.relaxations) {
      ways.push_back(way(relaxation));
      others |= !relaxation.enough;
    }
    std::vector<std::string> parts;
    if (!tasks.empty()) parts.push_back((tasks.size() > 1 ? "tasks " : "task ") + list(tasks, " and "));
    if (!joints.empty())
      parts.push_back((joints.size() > 1 ? "the torque limits of joints " : "the torque limit of joint ") +
                      list(joints, " and "));
    const bool alone = conflict.groups.size() == 1;
    std::string text = list(parts, " and ") + (alone ? " cannot be met" : " contradict each other");
    text += (ways.size() > 1 ? "; any one of these would do: " : "; this would do: ") + list(ways, ", or ");
    if (others) text += "; other constraints contradict each other besides";
    return text;
  }

  std::string way(const Relaxation& relaxation) const {
    const std::string amount = numberText(relaxation.amount);
    switch (relaxation.group.kind) {
      case Kind::torque_limit:
        return "allow joint " + joint(relaxation.group.joint) + " " + amount + " N m beyond its " +
               (relaxation.upper ? "upper" : "lower") + " limit";
      case Kind::forces: return "allow the force of " + nameOf(relaxation.group) + " " + amount + " N more";
      case Kind::rows:
        return "let " + nameOf(relaxation.group) + " be accelerated by " + amount +
               (taskOf(relaxation.group).contact ? " m/s²" : " m/s² or rad/s²");
    }
    return "";
  }

  const TickTask& taskOf(const ConflictGroup& group) const { return problem_.levels[group.level].tasks[group.task]; }
  std::string nameOf(const ConflictGroup& group) const { return "'" + taskOf(group).name + "'"; }
  std::string task(const ConflictGroup& group) const {
    const auto place = names_.places.find(taskOf(group).name);
    return nameOf(group) + (place == names_.places.end() ? "" : " (" + place->second + ")");
  }
  std::string joint(int i) const {
    return static_cast<std::size_t>(i) < names_.joints.size() ? names_.joints[static_cast<std::size_t>(i)]
                                                              : std::to_string(i + 1);
  }
  /// "a, b and c"
  static std::string list(const std::vector<std::string>& parts, const std::string& last) {
    std::string text;
    for (std::size_t i = 0; i < parts.size(); ++i)
      text += (i == 0 ? "" : i + 1 < parts.size() ? ", " : last) + parts[i];
    return text;
  }

  const TickProblem& problem_;
  const ConflictNames& names_;
};

}  // namespace

Conflict findConflict(const TickProblem& problem) {
  Conflict conflict;
  WhitenedProblem whitened(problem);
  if (!whitened.update(problem)) return conflict;
  if (problem.torque_limits) {
    for (int i = 0; i < problem.dof; ++i) {
      const double beyond = std::max(problem.torque_limits->lower[i], -problem.torque_limits->upper[i]);
      if (std::isnan(beyond)) return {};
      if (beyond > 0) conflict.beyond.push_back({i, beyond});
    }
  }
  const Constraints constraints(problem, whitened);
  const std::vector<int> groups = smallestConflict(constraints.rows());
  for (const int group : groups) {
    conflict.groups.push_back(constraints.group(group));
    conflict.relaxations.push_back(relaxationOf(constraints, groups, group));
  }
  return conflict;
}

std::string describe(const Conflict& conflict, const TickProblem& problem, const ConflictNames& names) {
  return Sentence(problem, names).text(conflict);
}

}  // namespace tactus::control
