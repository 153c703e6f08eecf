#include "tasks/joint_limits.h"

#include <algorithm>

namespace tactus::tasks {

using namespace control;

void JointLimits::registerIn(Registry& registry) {
  ElementRow row;
  row.name = "joint-limits";
  row.kind = ElementKind::task;
  row.description = "Keeps joints a margin away from their stops.";
  row.source = "thesis 4.2 (multiple priorities); Khatib 1987";
  row.attributes = {
      {.name = "joints", .type = ValueType::joints, .description = "Joints or joint groups; not given: all."},
      {.name = "margin", .type = ValueType::real, .unit = "rad", .default_text = "0.05",
       .description = "Distance from the stop at which the row begins.", .lower = 0},
      {.name = "stiffness", .type = ValueType::real, .unit = "N m/rad", .default_text = "1",
       .description = "k, on the depth inside the margin.", .lower = 0},
      {.name = "damping", .type = ValueType::real, .unit = "N m s/rad", .default_text = "0.02",
       .description = "d, on the speed towards the stop.", .lower = 0},
  };
  registry.addTask(row, [](const BuildContext& context) { return std::make_unique<JointLimits>(context); });
}

namespace {

std::vector<int> limitedJoints(const BuildContext& context) {
  std::vector<int> joints;
  if (context.values.has("joints")) {
    joints = context.joints("joints");
  } else {
    for (int i = 0; i < context.model.dof(); ++i) joints.push_back(i);
  }
  return joints;
}

}  // namespace

JointLimits::JointLimits(const BuildContext& context) : JointLimits(context, limitedJoints(context)) {}

JointLimits::JointLimits(const BuildContext& context, std::vector<int> joints)
    : Task(Relation::inequality, static_cast<int>(joints.size())),
      joints_(std::move(joints)),
      margin_(context.values.real("margin")),
      stiffness_(context.values.real("stiffness")),
      damping_(context.values.real("damping")),
      lower_(context.model.lower()),
      upper_(context.model.upper()) {
  for (const int i : joints_) {
    if (2 * margin_ >= upper_[i] - lower_[i]) {
      throw ElementError("margin", "twice the margin leaves no room between the limits of joint '" +
                                       context.model.jointNames()[i] + "'");
    }
  }
}

JointLimits::Depth JointLimits::depthOf(int i, double q) const {
  const double above = q - (upper_[i] - margin_);
  const double below = (lower_[i] + margin_) - q;
  return {std::max(above, below), above > below ? 1.0 : -1.0};
}

void JointLimits::doUpdate(const Tick& tick, TickTask& rows) {
  rows.rows = 0;
  error_ = 0;
  for (const int i : joints_) {
    const auto [depth, towards] = depthOf(i, tick.robot.q()[i]);
    if (depth <= 0) continue;
    const double speed = std::max(towards * tick.robot.qd()[i], 0.0);
    rows.jacobian.row(rows.rows).setZero();
    rows.jacobian(rows.rows, i) = towards;
    rows.force[rows.rows] = -stiffness_ * depth - damping_ * speed;
    ++rows.rows;
    error_ = std::max(error_, depth);
  }
}

bool JointLimits::displacement(const dynamics::DynamicsCache& from, const dynamics::DynamicsCache& to,
                               Eigen::Ref<Eigen::VectorXd> dx) const {
  int row = 0;
  for (const int i : joints_) {
    const auto [depth, towards] = depthOf(i, from.q()[i]);
    if (depth > 0) dx[row++] = towards * (to.q()[i] - from.q()[i]);
  }
  return true;
}

}  // namespace tactus::tasks
