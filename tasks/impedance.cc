#include "tasks/impedance.h"

#include <limits>

#include "framework/control/displacement.h"
#include "tasks/orientation_error.h"

namespace tactus::tasks {

using namespace control;

namespace {
constexpr double infinity = std::numeric_limits<double>::infinity();
}

void Impedance::registerIn(Registry& registry) {
  ElementRow row;
  row.name = "impedance";
  row.kind = ElementKind::task;
  row.description = "Cartesian spring and damper on position and orientation of a link.";
  row.source = "thesis A.1.7-A.1.11";
  row.attributes = {
      {.name = "frame", .type = ValueType::link, .required = true, .description = "The link."},
      {.name = "position", .type = ValueType::reals, .unit = "m",
       .description = "Reference position of the link's point, world axes; not given: where it is when the task begins to "
                      "take part.",
       .count = 3, .in_world = InWorld::positions, .reached_by = "frame"},
      {.name = "orientation", .type = ValueType::reals, .unit = "rad",
       .description = "Reference roll, pitch, yaw (fixed axes); not given: those when the task begins to take part.",
       .count = 3, .in_world = InWorld::orientation},
      {.name = "point", .type = ValueType::reals, .unit = "m", .default_text = "0 0 0",
       .description = "The point of the link, in its axes; not given: its origin.", .count = 3},
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
      {.name = "speed", .type = ValueType::real, .unit = "m/s",
       .description = "The reference goes to its position at this speed, from where the link is when the task begins to "
                      "take part; not given: it stands there at once.",
       .lower = 0, .lower_open = true},
      {.name = "turn-speed", .type = ValueType::real, .unit = "rad/s",
       .description = "The same of its orientation.", .lower = 0, .lower_open = true},
  };
  registry.addTask(row, [](const BuildContext& context) { return std::make_unique<Impedance>(context); });
}

Impedance::Impedance(const BuildContext& context)
    : Task(Relation::equality, 6),
      frame_(context.frame("frame")),
      point_E_(context.values.vector3("point")),
      stiffness_(context.values.vector3("stiffness")),
      damping_(context.values.vector3("damping")),
      turn_stiffness_(context.values.vector3("rotation-stiffness")),
      turn_damping_(context.values.vector3("rotation-damping")),
      in_link_axes_(context.values.text("axes") == "link"),
      has_position_(context.values.has("position")),
      has_orientation_(context.values.has("orientation")),
      speed_(context.values.has("speed") ? context.values.real("speed") : infinity),
      turn_speed_(context.values.has("turn-speed") ? context.values.real("turn-speed") : infinity) {
  if (has_position_) reference_position_W_ = position_W_ = context.values.vector3("position");
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
  const Eigen::Vector3d point_W = X_WE * point_E_;
  if (!last_update_ || tick.time - *last_update_ > 1.5 * tick.dt) {
    reference_position_W_ = point_W;
    reference_orientation_W_ = X_WE.linear();
    if (!has_position_) position_W_ = reference_position_W_;
    if (!has_orientation_) orientation_W_ = reference_orientation_W_;
  }
  last_update_ = tick.time;

  dynamics::Vector6d velocity_error = moveReference(tick);
  velocity_error.head<3>() -= tick.robot.pointVelocity(frame_, point_W);
  velocity_error.tail<3>() -= tick.robot.frameVelocity(frame_).tail<3>();
  const Eigen::Vector3d p_e = reference_position_W_ - point_W;
  const Eigen::Vector3d turn = orientationError(X_WE.linear(), reference_orientation_W_);
  const Eigen::Matrix3d R_WA = in_link_axes_ ? Eigen::Matrix3d(X_WE.linear()) : Eigen::Matrix3d::Identity();
  const auto perAxis = [&](const Eigen::Vector3d& gains, const Eigen::Vector3d& v_W) {
    return Eigen::Vector3d(R_WA * gains.cwiseProduct(R_WA.transpose() * v_W));
  };

  rows.rows = 6;
  tick.robot.frameJacobian(frame_, rows.jacobian.topRows<6>());
  tick.robot.pointJacobian(frame_, point_W, rows.jacobian.topRows<3>());
  rows.force.head<3>() = perAxis(stiffness_, p_e) + perAxis(damping_, velocity_error.head<3>());
  rows.force.segment<3>(3) = perAxis(turn_stiffness_, turn) + perAxis(turn_damping_, velocity_error.tail<3>());
  error_ = (position_W_ - point_W).norm();
}

dynamics::Vector6d Impedance::moveReference(const Tick& tick) {
  dynamics::Vector6d velocity = dynamics::Vector6d::Zero();
  const Eigen::Vector3d way = position_W_ - reference_position_W_;
  if (way.norm() <= speed_ * tick.dt) {
    reference_position_W_ = position_W_;
  } else {
    velocity.head<3>() = speed_ * way.normalized();
    reference_position_W_ += tick.dt * velocity.head<3>();
  }
  const Eigen::Vector3d turn = orientationError(reference_orientation_W_, orientation_W_);
  if (turn.norm() <= turn_speed_ * tick.dt) {
    reference_orientation_W_ = orientation_W_;
  } else {
    const Eigen::Vector3d axis = turn.normalized();
    velocity.tail<3>() = turn_speed_ * axis;
    reference_orientation_W_ = Eigen::AngleAxisd(turn_speed_ * tick.dt, axis) * reference_orientation_W_;
  }
  return velocity;
}

void Impedance::marks(std::vector<Mark>& marks) const { marks.push_back({"reference", &reference_position_W_}); }

void Impedance::doArchive(Archive& archive) {
  archive("position", position_W_);
  archive("orientation", orientation_W_);
  archive("reference-position", reference_position_W_);
  archive("reference-orientation", reference_orientation_W_);
  archive("last-update", last_update_);
}

bool Impedance::displacement(const dynamics::DynamicsCache& from, const dynamics::DynamicsCache& to,
                             Eigen::Ref<Eigen::VectorXd> dx) const {
  dx = frameDisplacement(from, to, frame_);
  dx.head<3>() = pointDisplacement(from, to, frame_, from.framePose(frame_) * point_E_);
  return true;
}

}  // namespace tactus::tasks
