#pragma once

#include <Eigen/Geometry>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "dsl/read_robot.h"
#include "framework/control/registry.h"
#include "framework/dynamics/dynamics_cache.h"
#include "tasks/register_tasks.h"

namespace tactus::test {

using Attributes = std::map<std::string, std::string>;

inline description::Robot lwrAllegro() {
  std::vector<dsl::Diagnostic> warnings;
  return dsl::readRobot(TACTUS_SOURCE_DIR "/models/lwr_allegro.urdf", warnings);
}

/// The same robot standing on a base turned by `yaw` about the vertical.
inline description::Robot turned(description::Robot robot, double yaw) {
  for (description::Joint& joint : robot.joints) {
    if (joint.parent == robot.root) joint.origin = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) * joint.origin;
  }
  return robot;
}

/// A configuration with the palm facing down, well inside all limits.
inline Eigen::VectorXd handOverTable() {
  Eigen::VectorXd q(23);
  q << -0.227, -0.535, 0.027, 1.783, 0.120, -0.485, -0.302,  //
      0, 0.15, 0.15, 0.15, 0, 0.15, 0.15, 0.15, 0, 0.15, 0.15, 0.15, 0.29, 1.12, -0.14, -0.12;
  return q;
}

/// A robot, what it feels, and the signal `touch`: all that a task needs to run alone.
class TaskWorld {
 public:
  explicit TaskWorld(description::Robot description = lwrAllegro())
      : robot(std::move(description)), model(robot), cache(model) {
    tasks::registerBuiltIns(registry);
    sensed.q = handOverTable();
    sensed.qd = Eigen::VectorXd::Zero(model.dof());
    touch_values_ = control::makeValues(*registry.elements().find("contacts"), {{"name", "touch"}, {"desired", "fingers"}, {"hold", "0"}});
    touch = registry.makeSignal(context(touch_values_));
  }

  control::BuildContext context(const control::ElementValues& values) {
    return control::BuildContext(values, robot, model, dt,
                                 [this](const std::string&, const std::string& reference, const std::string&) {
                                   return touch->port(reference.substr(reference.find('.') + 1));
                                 });
  }

  std::unique_ptr<control::Task> make(const std::string& type, Attributes attributes) {
    attributes.insert({"name", "task"});
    values_.push_back(
        std::make_unique<control::ElementValues>(control::makeValues(*registry.elements().find(type), attributes)));
    return registry.makeTask(context(*values_.back()));
  }

  control::TickTask rowsFor(const control::Task& task) const {
    control::TickTask rows("task", task.capacity(), model.dof());
    rows.relation = task.relation();
    return rows;
  }

  int link(const std::string& name) const { return robot.linkIndex(name); }

  /// A record on a link at its frame origin moved by `offset_W`.
  control::ContactRecord contactOn(const std::string& name, const Eigen::Vector3d& normal_W, double force) {
    cache.update(sensed.q, sensed.qd);
    control::ContactRecord record;
    record.link = link(name);
    record.object = 0;
    record.point_W = cache.framePose(record.link).translation();
    record.normal_W = normal_W.normalized();
    record.force_N = force;
    record.depth = force / 2000;
    return record;
  }

  /// Dynamics and the signal at the present state.
  void feel() {
    cache.update(sensed.q, sensed.qd);
    touch->update(tick());
  }
  control::Tick tick() const { return control::Tick{sensed.time, dt, sensed, cache}; }

  description::Robot robot;
  dynamics::Model model;
  dynamics::DynamicsCache cache;
  control::Registry registry;
  control::Sensed sensed;
  std::unique_ptr<control::Signal> touch;
  double dt = 1e-3;

 private:
  control::ElementValues touch_values_;
  std::vector<std::unique_ptr<control::ElementValues>> values_;
};

template <class T>
const T& port(const TaskWorld& world, const std::string& name) {
  return *static_cast<const T*>(world.touch->port(name));
}

}  // namespace tactus::test
