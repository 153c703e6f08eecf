#include "tasks/impedance.h"

#include "framework/control/displacement.h"
#include "tasks/orientation_error.h"

namespace tactus::tasks {

using namespace control;

void Impedance::registerIn(Registry& registry) {
  ElementRow row;
  row.name = "impedance";
  row.kind = ElementKind::task;
  row.description = "Cartesian spring and damper on position and orientation of a link.";
  row.source = "thesis A.1.7-A.1.11";
  row.attributes = {
      {.name = "frame", .type = ValueType::link, .required = true, .description = "The link."},
      {.name = "position", .type = ValueType::reals, .unit = "m",
       .description = "Reference position of the link's origin, world axes; not given: that of the first tick.",
       .count = 3, .in_world = InWorld::positions, .reached_by = "frame"},
      {.name = "orientation", .type = ValueType::reals, .unit = "rad",
       .description = "Reference roll, pitch, yaw (fixed axes); not given: that of the first tick.", .count = 3,
       .in_world = InWorld::orientation},
      {.name = "stiffness", .type = ValueType::reals, .unit = "N/m", .default_text = "300 300 300",
       .description = "k_p per axis.", .lower = 0, .count = 3},
      {.name = "damping", .type = ValueType::reals, .unit = "N s/m", .default_text = "300 300 300",
       .description = "d_p per axis.", .lower = 0, .count = 3},
      {.name = "rotation-stiffness", .type = ValueType::reals, .unit = "N m/rad", .default_text = "10 10 10",
       .description = "k_r per axis.", .lower = 0, .count = 3},
      {.name = "rotation-damping", .type = ValueType::reals, .unit = "N m s/rad", .default_text = "3 3 3",
       .description = "d_r per axis.", .lower = 0, .count = 3},
      {.name = "axes", .type = ValueType::choice, .default_text = "world",
       .description = "Axes in which stiffness and damping are given.", .choices = {"world", "link"}},
  };
  registry.addTask(row, [](const BuildContext& context) { return std::make_unique<Impedance>(context); });
}

Impedance::Impedance(const BuildContext& context)
    : Task(Relation::equality, 6),
      frame_(context.frame("frame")),
      stiffness_(context.values.vector3("stiffness")),
      damping_(context.values.vector3("damping")),
      turn_stiffness_(context.values.vector3("rotation-stiffness")),
      turn_damping_(context.values.vector3("rotation-damping")),
      in_link_axes_(context.values.text("axes") == "link"),
      has_position_(context.values.has("position")),
      has_orientation_(context.values.has("orientation")) {
  if (has_position_) position_W_ = context.values.vector3("position");
  if (has_orientation_) {
    const Eigen::Vector3d rpy = context.values.vector3("orientation");
    orientation_W_ = (Eigen::AngleAxisd(rpy[2], Eigen::Vector3d::UnitZ()) *
                      Eigen::AngleAxisd(rpy[1], Eigen::Vector3d::UnitY()) *
                      Eigen::AngleAxisd(rpy[0], Eigen::Vector3d::UnitX()))
                         .toRotationMatrix();
  }
}

void Impedance::doUpdate(const Tick& tick, TickTask& rows) {
  const Eigen::Isometry3d X_WE = tick.robot.framePose(frame_);
  if (!has_position_) position_W_ = X_WE.translation();
  if (!has_orientation_) orientation_W_ = X_WE.linear();
  has_position_ = has_orientation_ = true;

  const Eigen::Vector3d p_e = position_W_ - X_WE.translation();
  const Eigen::Vector3d turn = orientationError(X_WE.linear(), orientation_W_);
  const dynamics::Vector6d velocity = tick.robot.frameVelocity(frame_);
  const Eigen::Matrix3d R_WA = in_link_axes_ ? Eigen::Matrix3d(X_WE.linear()) : Eigen::Matrix3d::Identity();
  const auto perAxis = [&](const Eigen::Vector3d& gains, const Eigen::Vector3d& v_W) {
    return Eigen::Vector3d(R_WA * gains.cwiseProduct(R_WA.transpose() * v_W));
  };

  rows.rows = 6;
  tick.robot.frameJacobian(frame_, rows.jacobian.topRows<6>());
  rows.force.head<3>() = perAxis(stiffness_, p_e) - perAxis(damping_, velocity.head<3>());
  rows.force.segment<3>(3) = perAxis(turn_stiffness_, turn) - perAxis(turn_damping_, velocity.tail<3>());
  error_ = p_e.norm();
}

void Impedance::marks(std::vector<Mark>& marks) const { marks.push_back({"reference", &position_W_}); }

void Impedance::doArchive(Archive& archive) {
  archive("has-position", has_position_);
  archive("has-orientation", has_orientation_);
  archive("position", position_W_);
  archive("orientation", orientation_W_);
}

bool Impedance::displacement(const dynamics::DynamicsCache& from, const dynamics::DynamicsCache& to,
                             Eigen::Ref<Eigen::VectorXd> dx) const {
  dx = frameDisplacement(from, to, frame_);
  return true;
}

}  // namespace tactus::tasks
