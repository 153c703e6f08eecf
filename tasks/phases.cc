#include "tasks/phases.h"

#include <algorithm>

namespace tactus::tasks {

using namespace control;

namespace {

constexpr double threshold = 0.5;                                  // of a port that is on or off
constexpr double rounding = 1e-9;                                  // s

ElementRow nextRow() {
  return {.name = "next",
          .description = "A way out of a phase: taken when its guard holds.",
          .attributes = {{.name = "to", .type = ValueType::identifier, .required = true,
                          .description = "The phase that comes then."},
                         {.name = "when", .type = ValueType::port,
                          .description = "A number that is looked at; with neither `above` nor `below`: above 0.5.",
                          .port_type = "scalar"},
                         {.name = "above", .type = ValueType::real, .description = "The guard holds above this."},
                         {.name = "below", .type = ValueType::real, .description = "The guard holds below this."},
                         {.name = "for", .type = ValueType::real, .unit = "s", .default_text = "0",
                          .description = "Time on end that the guard must have held.", .lower = 0},
                         {.name = "after", .type = ValueType::real, .unit = "s",
                          .description = "The guard holds no earlier than this time after the phase began.", .lower = 0}},
          .presence = {{Presence::any_of, {"when", "after"}},
                       {Presence::exclusive, {"above", "below"}},
                       {Presence::needs, {"above", "when"}},
                       {Presence::needs, {"below", "when"}}}};
}

ElementRow phaseRow() {
  return {.name = "phase",
          .description = "One thing that the robot is at; without a way out it lasts.",
          .attributes = {{.name = "name", .type = ValueType::identifier, .required = true,
                          .description = "Its name, and that of the port which is 1 during it."}},
          .children = {{"next"}}};
}

}  // namespace

void Phases::registerIn(Registry& registry) {
  registry.addStructure(phaseRow());
  registry.addStructure(nextRow());
  registry.addSignal({.name = "phases",
                      .description = "A state machine: approach until touch, then sweep, then lift. Tasks and levels take "
                                     "part in a phase by active=\"machine.phase\".",
                      .attributes = {{.name = "start", .type = ValueType::identifier,
                                      .description = "The first phase; not given: the one that stands first."}},
                      .children = {{"phase", 1}},
                      .ports = {{"@phase", "scalar", "1", "1 during the phase of that name, else 0.", 1},
                                {"time", "scalar", "s", "Time since the phase began.", 1},
                                {"index", "scalar", "1", "Which phase it is, counted from 1 as they stand.", 1}}},
                     [](const BuildContext& context) { return std::make_unique<Phases>(context); });
}

Phases::Phases(const BuildContext& context) {
  std::vector<std::string> names;
  for (const ElementValues& child : context.values.children) {
    const std::string& name = child.text("name");
    if (name == "time" || name == "index") throw ElementError(child, "name", "'" + name + "' is a port of every <phases>");
    if (std::find(names.begin(), names.end(), name) != names.end())
      throw ElementError(child, "name", "there is a phase '" + name + "' already");
    names.push_back(name);
  }
  const auto indexOf = [&](const std::string& name) {
    return static_cast<int>(std::find(names.begin(), names.end(), name) - names.begin());
  };
  for (const ElementValues& child : context.values.children) {
    Phase phase;
    phase.name = child.text("name");
    for (const ElementValues& way : child.children) {
      Next next;
      next.to = indexOf(way.text("to"));
      if (next.to == static_cast<int>(names.size()))
        throw ElementError(way, "to", "there is no phase '" + way.text("to") + "'", names);
      if (way.has("when")) {
        next.when = &context.port<double>(way, "when");
        if (way.has("below")) next.below = way.real("below");
        else next.above = way.has("above") ? way.real("above") : threshold;
      }
      next.hold = way.real("for");
      if (way.has("after")) next.after = way.real("after");
      phase.next.push_back(next);
    }
    phases_.push_back(std::move(phase));
  }
  int first = 0;
  if (context.values.has("start")) {
    first = indexOf(context.values.text("start"));
    if (first == static_cast<int>(names.size()))
      throw ElementError("start", "there is no phase '" + context.values.text("start") + "'", names);
  }
  enter(first, 0);
  changes_ = 0;
}

void Phases::enter(int phase, double time) {
  if (current_ >= 0) phases_[static_cast<std::size_t>(current_)].active = 0;
  current_ = phase;
  entered_ = time;
  time_in_phase_ = 0;
  index_ = phase + 1;
  ++changes_;
  Phase& now = phases_[static_cast<std::size_t>(phase)];
  now.active = 1;
  for (Next& next : now.next) next.held_since = -1;
}

void Phases::doUpdate(const Tick& tick) {
  Phase& phase = phases_[static_cast<std::size_t>(current_)];
  phase.time += std::max(0.0, tick.time - last_update_);
  last_update_ = tick.time;
  time_in_phase_ = tick.time - entered_;
  for (Next& next : phase.next) {
    // NaN is neither above nor below.
    const bool holds = (!next.when || (*next.when > next.above && *next.when < next.below)) &&
                       time_in_phase_ >= next.after - rounding;
    if (!holds) {
      next.held_since = -1;
      continue;
    }
    if (next.held_since < 0) next.held_since = tick.time;
    if (tick.time - next.held_since < next.hold - rounding) continue;
    enter(next.to, tick.time);
    return;
  }
}

void Phases::doArchive(Archive& archive) {
  archive("phases", phases_);
  archive.whole("current", current_, 0, static_cast<std::int64_t>(phases_.size()) - 1);
  archive("entered", entered_);
  archive("last-update", last_update_);
  archive("time-in-phase", time_in_phase_);
  archive("index", index_);
  archive("changes", changes_);
}

const void* Phases::doPort(std::string_view name) const {
  if (name == "time") return &time_in_phase_;
  if (name == "index") return &index_;
  for (const Phase& phase : phases_)
    if (phase.name == name) return &phase.active;
  return nullptr;
}

void Phases::columns(std::vector<LogColumn>& columns) const {
  columns.push_back({"phase", &index_});
}

void Phases::metrics(std::vector<Metric>& metrics) const {
  metrics.push_back({"phase_changes", changes_});
  for (const Phase& phase : phases_) metrics.push_back({"phase_" + phase.name + "_s", phase.time});
}

}  // namespace tactus::tasks
