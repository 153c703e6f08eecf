#include "plugins/enclose/enclose.h"

#include <algorithm>
#include <cmath>

#include "framework/dynamics/dynamics_cache.h"
#include "framework/dynamics/model.h"

namespace tactus::plugins {

using namespace control;

namespace {

/// Does the first joint move all that the other one moves?
bool carries(const dynamics::Model& model, int joint, int other) {
  for (int frame = 0; frame < static_cast<int>(model.frames().size()); ++frame)
    if (model.supports(other, frame) && !model.supports(joint, frame)) return false;
  return true;
}

}  // namespace

/// Pulls each joint to its reference.
class Enclose::Springs final : public Task {
 public:
  Springs(const BuildContext& context, const std::vector<Way>& ways)
      : Task(Relation::equality, static_cast<int>(ways.size())),
        ways_(ways),
        stiffness_(context.values.real("stiffness")),
        damping_(context.values.real("damping")) {}

 private:
  void doUpdate(const Tick& tick, TickTask& rows) override {
    rows.rows = capacity();
    rows.jacobian.topRows(rows.rows).setZero();
    error_ = 0;
    for (int i = 0; i < rows.rows; ++i) {
      const Way& way = ways_[static_cast<std::size_t>(i)];
      const double error = way.reference - tick.robot.q()[way.joint];
      rows.jacobian(i, way.joint) = 1;
      rows.force[i] = stiffness_ * error + damping_ * (way.speed - tick.robot.qd()[way.joint]);
      error_ = std::max(error_, std::abs(error));
    }
  }

  const std::vector<Way>& ways_;
  double stiffness_, damping_;
};

void Enclose::registerIn(Registry& registry) {
  ElementRow row;
  row.name = "enclose";
  row.description = "Closes fingers by positions, joint after joint or all together, until they touch.";
  row.source = "thesis 4.4.2";
  row.attributes = {
      {.name = "joints", .type = ValueType::joints, .required = true, .description = "Those that close."},
      {.name = "to", .type = ValueType::reals, .unit = "rad", .default_text = "1.6",
       .description = "Where they would end without an object; one number, or one a joint in the robot's order."},
      {.name = "on", .type = ValueType::port, .required = true, .description = "What touches, e.g. touch.all.",
       .port_type = "contact-set"},
      {.name = "order", .type = ValueType::choice, .default_text = "successive",
       .description = "From base to tip, or all at once.", .choices = {"successive", "together"}},
      {.name = "speed", .type = ValueType::real, .unit = "rad/s", .default_text = "0.5", .description = "Of each joint.",
       .lower = 0, .lower_open = true},
      {.name = "threshold", .type = ValueType::real, .unit = "N", .default_text = "0.05",
       .description = "A touch of this force stops the joints before it.", .lower = 0},
      {.name = "stiffness", .type = ValueType::real, .unit = "N m/rad", .default_text = "1", .description = "k.",
       .lower = 0},
      {.name = "damping", .type = ValueType::real, .unit = "N m s/rad", .default_text = "0.02", .description = "d.",
       .lower = 0},
  };
  registry.addController(row, [](const BuildContext& context) {
    std::unique_ptr<Enclose> enclose(new Enclose(context));
    ControlledLevel level;
    level.tasks.push_back({"close", std::make_unique<Springs>(context, enclose->ways_)});
    level.controller = std::move(enclose);
    return level;
  });
}

Enclose::Enclose(const BuildContext& context)
    : contacts_(context.port<ContactSet>("on")),
      successive_(context.values.text("order") == "successive"),
      speed_(context.values.real("speed")),
      threshold_(context.values.real("threshold")) {
  const std::vector<int> joints = context.joints("joints");
  const std::vector<double>& to = context.values.numbers("to");
  if (to.size() != 1 && to.size() != joints.size())
    throw ElementError("to", "to has " + std::to_string(to.size()) + " numbers, expected 1 or " +
                                 std::to_string(joints.size()) + " (one a joint)");
  for (std::size_t i = 0; i < joints.size(); ++i) {
    Way way;
    way.joint = joints[i];
    way.to = to[to.size() == 1 ? 0 : i];
    for (std::size_t other = 0; other < i; ++other)
      if (carries(context.model, joints[other], joints[i])) way.before.push_back(static_cast<int>(other));
    ways_.push_back(std::move(way));
  }
}

bool Enclose::touchesBeyond(const Tick& tick, int joint) const {
  return std::any_of(contacts_.contacts.begin(), contacts_.contacts.end(), [&](const Contact& contact) {
    return contact.force_N >= threshold_ && tick.robot.model().supports(joint, contact.frame);
  });
}

void Enclose::doUpdate(const Tick& tick) {
  if (!started_)
    for (Way& way : ways_) way.reference = tick.robot.q()[way.joint];
  started_ = true;
  stopped_ = 0;
  for (Way& way : ways_) {
    const auto stopped = [&](int other) { return ways_[static_cast<std::size_t>(other)].stopped; };
    const bool waits = successive_ && !std::all_of(way.before.begin(), way.before.end(), stopped);
    if (!waits && !way.stopped) way.stopped = way.reference == way.to || touchesBeyond(tick, way.joint);
    way.speed = 0;
    if (!waits && !way.stopped) {
      const double left = way.to - way.reference;
      way.speed = std::copysign(std::min(speed_, std::abs(left) / tick.dt), left);
      way.reference += tick.dt * way.speed;
      if (std::abs(way.to - way.reference) < 1e-12) way.reference = way.to;
    }
    stopped_ += way.stopped;
  }
}

void Enclose::Way::archive(Archive& archive) {
  archive("reference", reference);
  archive("speed", speed);
  archive("stopped", stopped);
}

void Enclose::doArchive(Archive& archive) {
  archive("ways", ways_);
  archive("started", started_);
  archive("stopped", stopped_);
}

void Enclose::columns(std::vector<LogColumn>& columns) const { columns.push_back({"stopped", &stopped_}); }

}  // namespace tactus::plugins
