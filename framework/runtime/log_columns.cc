#include "framework/runtime/log_columns.h"

#include <cmath>

namespace tactus::runtime {

using control::LevelReport;
using control::TickSolution;

LogColumns::LogColumns(const control::Controller& controller, ColumnSet set, const ContactMetrics* contacts,
                       const std::vector<MovingObject>& objects,
                       const std::vector<const control::FaultRecord*>& faults,
                       const std::vector<control::LogColumn>& measures) {
  add("time", [](const control::ObservedTick& tick) { return tick.sensed.time; });
  addLevels(controller);
  addTasksAndSignals(controller);
  addSensors(controller.readings(), set);
  addObjects(objects);
  for (const control::FaultRecord* fault : faults)
    add("fault/" + fault->name, [fault](const control::ObservedTick&) { return fault->strikes; });
  for (const control::LogColumn& column : measures)
    add(column.name, [value = column.value](const control::ObservedTick&) { return *value; });
  if (contacts) addContacts(*contacts);
  addController(controller);
  if (set == ColumnSet::all) addJoints(controller);
}

void LogColumns::add(std::string name, Value value) {
  names_.push_back(std::move(name));
  values_.push_back(std::move(value));
}

void LogColumns::addLevels(const control::Controller& controller) {
  const auto& levels = controller.solution().levels;
  for (size_t i = 0; i < levels.size(); ++i) {
    const std::string path = "level/" + std::to_string(levels[i].priority) + "/";
    const auto addField = [&](const std::string& name, auto field) {
      add(path + name, [i, field](const control::ObservedTick& tick) -> double {
        return static_cast<double>(field(tick.controller.solution().levels[i]));
      });
    };
    addField("rank", [](const LevelReport& level) { return level.rank; });
    addField("nullity", [](const LevelReport& level) { return level.nullity; });
    addField("active", [](const LevelReport& level) { return level.active.size(); });
    addField("residual", [](const LevelReport& level) { return level.residual; });
  }
}

void LogColumns::addTasksAndSignals(const control::Controller& controller) {
  const auto addOwn = [&](const std::string& path, const auto& owner) {
    std::vector<control::LogColumn> columns;
    owner.columns(columns);
    for (const control::LogColumn& column : columns) {
      add(path + column.name, [value = column.value](const control::ObservedTick&) { return *value; });
    }
  };
  for (const control::Level& level : controller.levels()) {
    for (const control::NamedTask& named : level.tasks) {
      const std::string path = "task/" + named.name + "/";
      add(path + "error", [task = named.task.get()](const control::ObservedTick&) { return task->error(); });
      addOwn(path, *named.task);
      if (!named.activation.isConditional() && !level.activation.isConditional()) continue;
      add(path + "share", [level = &level, name = named.name](const control::ObservedTick& tick) {
        return level->activation.share() * tick.controller.activationOf(name).share();
      });
    }
  }
  for (const control::Level& level : controller.levels()) {
    if (!level.owner.controller) continue;
    addOwn("level/" + std::to_string(level.priority) + "/" + level.owner.name + "/", *level.owner.controller);
  }
  for (const control::NamedSignal& named : controller.signals()) {
    addOwn("signal/" + named.name + "/", *named.signal);
  }
}

void LogColumns::addSensors(const control::Readings& readings, ColumnSet set) {
  constexpr int few = 6;
  for (size_t i = 0; i < readings.rows().size(); ++i) {
    const control::ReadingRow& row = readings.rows()[i];
    if (set != ColumnSet::all && row.count > few) continue;
    const std::string path = "sensor/" + row.sensor + "/" + row.port;
    for (int k = 0; k < row.count; ++k)
      add(row.scalar ? path : path + "/" + std::to_string(k),
          [value = &readings.values(i)[k]](const control::ObservedTick&) { return *value; });
  }
}

void LogColumns::addObjects(const std::vector<MovingObject>& objects) {
  for (const MovingObject& object : objects) {
    const std::string path = "object/" + object.name + "/";
    const size_t index = static_cast<size_t>(object.index);
    for (int axis = 0; axis < 3; ++axis)
      add(path + "xyz"[axis], [index, axis](const control::ObservedTick& tick) {
        return tick.objects[index].pose.translation()[axis];
      });
    for (int i = 0; i < 4; ++i)
      add(path + "q" + "wxyz"[i], [index, i](const control::ObservedTick& tick) {
        const Eigen::Quaterniond q(tick.objects[index].pose.linear());
        const double numbers[] = {q.w(), q.x(), q.y(), q.z()};
        return std::copysign(1.0, q.w()) * numbers[i];
      });
  }
}

void LogColumns::addContacts(const ContactMetrics& contacts) {
  const ContactMetrics::Now* now = &contacts.now();
  add("contact/contacts", [now](const control::ObservedTick&) { return now->contacts; });
  add("contact/links", [now](const control::ObservedTick&) { return now->links; });
  add("contact/mean_N", [now](const control::ObservedTick&) { return now->mean_N; });
  add("contact/max_N", [now](const control::ObservedTick&) { return now->max_N; });
  add("contact/undesired_max_N", [now](const control::ObservedTick&) { return now->undesired_max_N; });
  if (contacts.touchesItself())
    add("contact/self_max_N", [now](const control::ObservedTick&) { return now->self_max_N; });
}

void LogColumns::addController(const control::Controller& controller) {
  add("controller/torque_norm", [](const control::ObservedTick& tick) { return tick.torque.norm(); });
  add("controller/scale", [](const control::ObservedTick& tick) { return tick.controller.solution().scale; });
  add("controller/status", [](const control::ObservedTick& tick) { return static_cast<int>(tick.controller.record().status); });
  add("controller/fallback",
      [](const control::ObservedTick& tick) { return static_cast<int>(tick.controller.record().source); });
  add("controller/limited", [](const control::ObservedTick& tick) { return tick.controller.record().limited; });
  if (std::isfinite(controller.options().torque_rate)) {
    add("controller/rate_limited", [](const control::ObservedTick& tick) { return tick.controller.record().rate_limited; });
  }
  if (controller.options().deadline.isDeclared()) {
    add("controller/late", [](const control::ObservedTick& tick) { return tick.controller.record().late; });
  }
  if (!controller.solution().has_kkt) return;
  add("kkt/stationarity", [](const control::ObservedTick& tick) { return tick.controller.solution().kkt.stationarity; });
  add("kkt/primal", [](const control::ObservedTick& tick) { return tick.controller.solution().kkt.primal; });
  add("kkt/complementarity", [](const control::ObservedTick& tick) { return tick.controller.solution().kkt.complementarity; });
}

void LogColumns::addJoints(const control::Controller& controller) {
  const std::vector<std::string>& joints = controller.model().jointNames();
  for (size_t i = 0; i < joints.size(); ++i) {
    const auto j = static_cast<Eigen::Index>(i);
    add("q/" + joints[i], [j](const control::ObservedTick& tick) { return tick.sensed.q[j]; });
    add("qd/" + joints[i], [j](const control::ObservedTick& tick) { return tick.sensed.qd[j]; });
    add("tau/" + joints[i], [j](const control::ObservedTick& tick) { return tick.torque[j]; });
  }
  add("sensing/joints_held", [](const control::ObservedTick& tick) { return tick.controller.record().sensing.joints_held; });
  add("sensing/contacts_ignored",
      [](const control::ObservedTick& tick) { return tick.controller.record().sensing.contacts_ignored; });
}

}  // namespace tactus::runtime
