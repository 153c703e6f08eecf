#include "tasks/ds.h"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>

#include "framework/control/displacement.h"

namespace tactus::tasks {

using namespace control;

namespace {

/// 0 below `from`, 1 above `to`, smooth between.
double rise(double x, double from, double to) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

double fall(double x, double from, double to) { return 1 - rise(x, from, to); }

}  // namespace

void DynamicalSystem::registerIn(Registry& registry) {
  ElementRow row;
  row.name = "ds";
  row.kind = ElementKind::task;
  row.description = "Tracks passively the velocity of a linear dynamical system with the origin of a link.";
  row.source = "thesis 5.5; Kronander & Billard 2016";
  row.attributes = {
      {.name = "frame", .type = ValueType::link, .required = true, .description = "The link."},
      {.name = "target", .type = ValueType::reals, .unit = "m", .required = true,
       .description = "Attractor x*, world axes.", .count = 3, .in_world = InWorld::positions, .reached_by = "frame"},
      {.name = "matrix", .type = ValueType::reals, .unit = "1/s", .default_text = "-1 0 0 0 -1 0 0 0 -1",
       .description = "A, by rows; its symmetric part must be negative definite.", .count = 9,
       .in_world = InWorld::matrix},
      {.name = "damping-along", .type = ValueType::real, .unit = "N s/m", .default_text = "130",
       .description = "λ₁, along the field (thesis: 130).", .lower = 0, .lower_open = true},
      {.name = "damping-across", .type = ValueType::real, .unit = "N s/m", .default_text = "130",
       .description = "λ₂, across the field.", .lower = 0, .lower_open = true},
      {.name = "tank", .type = ValueType::real, .unit = "J", .default_text = "0.5",
       .description = "Energy in the tank at the start.", .lower = 0},
      {.name = "tank-max", .type = ValueType::real, .unit = "J", .default_text = "1",
       .description = "s̄, the tank's size.", .lower = 0, .lower_open = true},
      {.name = "blend", .type = ValueType::real, .unit = "m^2/s^2", .default_text = "0.0005",
       .description = "dz, width over which the rest of the field comes back when it takes energy out.", .lower = 0,
       .lower_open = true},
  };
  registry.addTask(row, [](const BuildContext& context) { return std::make_unique<DynamicalSystem>(context); });
}

DynamicalSystem::DynamicalSystem(const BuildContext& context)
    : Task(Relation::equality, 3),
      frame_(context.frame("frame")),
      target_W_(context.values.vector3("target")),
      lambda_along_(context.values.real("damping-along")),
      lambda_across_(context.values.real("damping-across")),
      tank_(context.values.real("tank")),
      tank_max_(context.values.real("tank-max")),
      blend_power_(context.values.real("blend")) {
  const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> A(context.values.numbers("matrix").data());
  conservative_ = 0.5 * (A + A.transpose());
  rest_ = 0.5 * (A - A.transpose());
  if (Eigen::LLT<Eigen::Matrix3d>(-conservative_).info() != Eigen::Success) {
    throw ElementError("matrix", "the symmetric part of matrix must be negative definite, or the field does not lead to the target");
  }
  if (tank_ > tank_max_) throw ElementError("tank", "tank must not be greater than tank-max");
}

void DynamicalSystem::doUpdate(const Tick& tick, TickTask& rows) {
  const Eigen::Vector3d p_W = tick.robot.framePose(frame_).translation();
  const Eigen::Vector3d velocity = tick.robot.frameVelocity(frame_).head<3>();
  const Eigen::Vector3d away = p_W - target_W_;
  const Eigen::Vector3d f_c = conservative_ * away;
  const Eigen::Vector3d f_R = rest_ * away;
  const Eigen::Vector3d f = f_c + f_R;
  const double speed = f.norm();
  if (speed > 1e-6) direction_W_ = f / speed;

  const Eigen::Vector3d braking =
      lambda_across_ * velocity + (lambda_along_ - lambda_across_) * direction_W_ * direction_W_.dot(velocity);

  const double z = velocity.dot(f_R);
  const double margin = 0.1 * tank_max_;
  const double available = rise(tank_, 0, margin);
  const double room = fall(tank_, tank_max_ - margin, tank_max_);
  double beta_s = available;
  double beta_R = available;
  if (z < 0) {
    beta_s = room;
    const double back = rise(-z, 0, blend_power_);
    beta_R = std::max(available + (1 - available) * back, beta_s);
  }
  tank_ += tick.dt * (room * velocity.dot(braking) - beta_s * lambda_along_ * z);
  tank_ = std::clamp(tank_, 0.0, tank_max_);

  rows.rows = 3;
  tick.robot.pointJacobian(frame_, p_W, rows.jacobian.topRows<3>());
  rows.force.head<3>() = -braking + lambda_along_ * (f_c + beta_R * f_R);
  error_ = (velocity - f).norm();
}

void DynamicalSystem::doArchive(Archive& archive) {
  archive("tank", tank_);
  archive("direction", direction_W_);
}

bool DynamicalSystem::displacement(const dynamics::DynamicsCache& from, const dynamics::DynamicsCache& to,
                                   Eigen::Ref<Eigen::VectorXd> dx) const {
  dx = frameDisplacement(from, to, frame_).head<3>();
  return true;
}

void DynamicalSystem::columns(std::vector<LogColumn>& columns) const { columns.push_back({"tank_J", &tank_}); }

void DynamicalSystem::marks(std::vector<Mark>& marks) const { marks.push_back({"target", &target_W_}); }

}  // namespace tactus::tasks
