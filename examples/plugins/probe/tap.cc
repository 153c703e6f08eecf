#include "tap.h"

#include <cmath>
#include <numbers>

namespace probe {

using namespace tactus::control;

namespace {

/// Swings one joint; `phase` is the time within the joint's turn.
class Swing final : public Task {
 public:
  Swing(int joint, const BuildContext& context, const double& phase)
      : Task(Relation::equality, 1),
        joint_(joint),
        by_(context.values.real("by")),
        period_(context.values.real("every")),
        stiffness_(context.values.real("stiffness")),
        damping_(context.values.real("damping")),
        phase_(phase) {}

 private:
  void doUpdate(const Tick& tick, TickTask& rows) override {
    const double q = tick.robot.q()[joint_];
    if (std::isnan(start_)) start_ = q;
    const double wanted = start_ + by_ * 0.5 * (1 - std::cos(2 * std::numbers::pi * phase_ / period_));
    rows.rows = 1;
    rows.jacobian.row(0).setZero();
    rows.jacobian(0, joint_) = 1;
    rows.force[0] = stiffness_ * (wanted - q) - damping_ * tick.robot.qd()[joint_];
    error_ = std::abs(wanted - q);
  }
  void doArchive(Archive& archive) override { archive("start", start_); }

  int joint_;
  double by_, period_, stiffness_, damping_;
  const double& phase_;
  double start_ = std::nan("");                                    // rad, where it was in its first turn
};

}  // namespace

void Tap::registerIn(Registry& registry) {
  ElementRow row;
  row.name = "probe.tap";
  row.description = "Taps with one joint after the other.";
  row.attributes = {
      {.name = "joints", .type = ValueType::joints, .required = true, .description = "They tap in their order."},
      {.name = "by", .type = ValueType::real, .unit = "rad", .default_text = "0.5", .description = "How far."},
      {.name = "every", .type = ValueType::real, .unit = "s", .default_text = "1", .description = "Time of a turn.",
       .lower = 0, .lower_open = true},
      {.name = "stiffness", .type = ValueType::real, .unit = "N m/rad", .default_text = "0.5", .description = "k.",
       .lower = 0},
      {.name = "damping", .type = ValueType::real, .unit = "N m s/rad", .default_text = "0.02", .description = "d.",
       .lower = 0},
      {.name = "felt", .type = ValueType::port, .unit = "N", .description = "A force that says: it touches.",
       .port_type = "scalar"},
      {.name = "stop-at", .type = ValueType::real, .unit = "N", .default_text = "0.2",
       .description = "The joint goes back when `felt` passes this.", .lower = 0},
      {.name = "hold", .type = ValueType::joints, .description = "Joints that keep their posture meanwhile."},
  };
  registry.addController(row, [](const BuildContext& context) {
    std::unique_ptr<Tap> tap(new Tap(context));
    ControlledLevel level;
    const std::vector<int> joints = context.joints("joints");
    for (size_t i = 0; i < joints.size(); ++i)
      level.tasks.push_back({context.model.jointNames()[static_cast<size_t>(joints[i])],
                             std::make_unique<Swing>(joints[i], context, tap->phase_), &tap->active_[i]});
    if (context.values.has("hold"))
      level.tasks.push_back({"hold", context.task("posture", {{"joints", context.values.text("hold")},
                                                              {"stiffness", "50"}, {"damping", "10"}})});
    level.controller = std::move(tap);
    return level;
  });
}

Tap::Tap(const BuildContext& context)
    : active_(context.joints("joints").size(), 0),
      period_(context.values.real("every")),
      felt_(context.values.has("felt") ? &context.port<double>("felt") : nullptr),
      stop_at_(context.values.real("stop-at")) {
  if (active_.empty()) throw ElementError("joints", "it needs a joint to tap with");
}

void Tap::doUpdate(const Tick& tick) {
  const bool touches = felt_ && *felt_ > stop_at_ && phase_ < 0.5 * period_;  // on its way back it may still touch
  touches_ += touches;
  if (touches) phase_ = period_ - phase_;                          // back along the same way
  phase_ += tick.dt;
  if (phase_ >= period_) {
    phase_ = 0;
    turn_ = (turn_ + 1) % active_.size();
  }
  for (size_t i = 0; i < active_.size(); ++i) active_[i] = i == turn_;
  turn_column_ = static_cast<double>(turn_);
}

void Tap::doArchive(Archive& archive) {
  archive("active", active_);
  archive("phase", phase_);
  archive("turn", turn_);
  archive("turn-column", turn_column_);
  archive("touches", touches_);
}

void Tap::columns(std::vector<LogColumn>& columns) const {
  columns.push_back({"turn", &turn_column_});
  columns.push_back({"phase_s", &phase_});
}

void Tap::metrics(std::vector<Metric>& metrics) const { metrics.push_back({"taps", static_cast<double>(touches_)}); }

}  // namespace probe
