#include "framework/runtime/log_columns.h"

#include <cmath>

namespace tactus::runtime {

using control::LevelReport;
using control::TickSolution;

LogColumns::LogColumns(const control::Controller& controller, ColumnSet set, const ContactMetrics* contacts) {
  add("time", [](const ObservedTick& tick) { return tick.sensed.time; });
  addLevels(controller);
  addTasksAndSignals(controller);
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
      add(path + name, [i, field](const ObservedTick& tick) -> double {
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
      add(path + column.name, [value = column.value](const ObservedTick&) { return *value; });
    }
  };
  for (const control::Level& level : controller.levels()) {
    for (const control::NamedTask& named : level.tasks) {
      const std::string path = "task/" + named.name + "/";
      add(path + "error", [task = named.task.get()](const ObservedTick&) { return task->error(); });
      addOwn(path, *named.task);
      if (!named.activation.isConditional() && !level.activation.isConditional()) continue;
      add(path + "share", [level = &level, name = named.name](const ObservedTick& tick) {
        return level->activation.share() * tick.controller.activationOf(name).share();
      });
    }
  }
  for (const control::NamedSignal& named : controller.signals()) {
    addOwn("signal/" + named.name + "/", *named.signal);
  }
}

void LogColumns::addContacts(const ContactMetrics& contacts) {
  const ContactMetrics::Now* now = &contacts.now();
  add("contact/contacts", [now](const ObservedTick&) { return now->contacts; });
  add("contact/links", [now](const ObservedTick&) { return now->links; });
  add("contact/mean_N", [now](const ObservedTick&) { return now->mean_N; });
  add("contact/max_N", [now](const ObservedTick&) { return now->max_N; });
  add("contact/undesired_max_N", [now](const ObservedTick&) { return now->undesired_max_N; });
}

void LogColumns::addController(const control::Controller& controller) {
  add("controller/torque_norm", [](const ObservedTick& tick) { return tick.torque.norm(); });
  add("controller/scale", [](const ObservedTick& tick) { return tick.controller.solution().scale; });
  add("controller/status", [](const ObservedTick& tick) { return static_cast<int>(tick.controller.record().status); });
  add("controller/fallback",
      [](const ObservedTick& tick) { return static_cast<int>(tick.controller.record().source); });
  add("controller/limited", [](const ObservedTick& tick) { return tick.controller.record().limited; });
  if (std::isfinite(controller.options().torque_rate)) {
    add("controller/rate_limited", [](const ObservedTick& tick) { return tick.controller.record().rate_limited; });
  }
  if (controller.options().deadline.isDeclared()) {
    add("controller/late", [](const ObservedTick& tick) { return tick.controller.record().late; });
  }
  if (!controller.solution().has_kkt) return;
  add("kkt/stationarity", [](const ObservedTick& tick) { return tick.controller.solution().kkt.stationarity; });
  add("kkt/primal", [](const ObservedTick& tick) { return tick.controller.solution().kkt.primal; });
  add("kkt/complementarity", [](const ObservedTick& tick) { return tick.controller.solution().kkt.complementarity; });
}

void LogColumns::addJoints(const control::Controller& controller) {
  const std::vector<std::string>& joints = controller.model().jointNames();
  for (size_t i = 0; i < joints.size(); ++i) {
    const auto j = static_cast<Eigen::Index>(i);
    add("q/" + joints[i], [j](const ObservedTick& tick) { return tick.sensed.q[j]; });
    add("qd/" + joints[i], [j](const ObservedTick& tick) { return tick.sensed.qd[j]; });
    add("tau/" + joints[i], [j](const ObservedTick& tick) { return tick.torque[j]; });
  }
  add("sensing/joints_held", [](const ObservedTick& tick) { return tick.controller.record().sensing.joints_held; });
  add("sensing/contacts_ignored",
      [](const ObservedTick& tick) { return tick.controller.record().sensing.contacts_ignored; });
}

}  // namespace tactus::runtime
