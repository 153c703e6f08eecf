#include "admittance.h"

#include "framework/control/displacement.h"

namespace wrist {

using namespace tactus::control;

void Admittance::registerIn(Registry& registry) {
  ElementRow row;
  row.name = "wrist.admittance";
  row.description =
      "Gives way to the wrench at the wrist like a mass, damper and spring; presses where the spring is zero.";
  row.source = "Hogan 1985; Siciliano & Villani 1999, 3.2; Seraji 1994";
  row.attributes = {
      {.name = "frame", .type = ValueType::link, .required = true, .description = "The link that gives way."},
      {.name = "wrench", .type = ValueType::port, .required = true, .description = "What it feels, e.g. ft.wrench.",
       .port_type = "wrist.wrench"},
      {.name = "mass", .type = ValueType::reals, .unit = "kg", .default_text = "4 4 4",
       .description = "M, per axis of the world.", .lower = 0, .lower_open = true, .count = 3},
      {.name = "damping", .type = ValueType::reals, .unit = "N s/m", .default_text = "120 120 120",
       .description = "D, per axis of the world; D dt/M stays below 1.", .lower = 0, .lower_open = true, .count = 3},
      {.name = "stiffness", .type = ValueType::reals, .unit = "N/m", .default_text = "300 300 300",
       .description = "K, per axis of the world; 0: the axis gives way altogether.", .lower = 0, .count = 3},
      {.name = "force", .type = ValueType::reals, .unit = "N", .default_text = "0 0 0",
       .description = "f_d, wanted on the world, world axes.", .count = 3, .in_world = InWorld::directions},
      {.name = "speed", .type = ValueType::real, .unit = "m/s", .default_text = "0.1",
       .description = "Largest speed of giving way.", .lower = 0, .lower_open = true},
      {.name = "track-stiffness", .type = ValueType::real, .unit = "N/m", .default_text = "600",
       .description = "k, of the inner loop.", .lower = 0},
      {.name = "track-damping", .type = ValueType::real, .unit = "N s/m", .default_text = "80",
       .description = "d.", .lower = 0},
      {.name = "rotation-stiffness", .type = ValueType::real, .unit = "N m/rad", .default_text = "20",
       .description = "k_r.", .lower = 0},
      {.name = "rotation-damping", .type = ValueType::real, .unit = "N m s/rad", .default_text = "2",
       .description = "d_r.", .lower = 0},
  };
  registry.addTask(row, [](const BuildContext& context) { return std::make_unique<Admittance>(context); });
}

Admittance::Admittance(const BuildContext& context)
    : Task(Relation::equality, 6),
      frame_(context.frame("frame")),
      wrench_(context.port<Wrench>("wrench")),
      mass_(context.values.vector3("mass")),
      damping_(context.values.vector3("damping")),
      stiffness_(context.values.vector3("stiffness")),
      wanted_W_(context.values.vector3("force")),
      speed_(context.values.real("speed")),
      track_stiffness_(context.values.real("track-stiffness")),
      track_damping_(context.values.real("track-damping")),
      turn_stiffness_(context.values.real("rotation-stiffness")),
      turn_damping_(context.values.real("rotation-damping")) {
  if ((damping_.cwiseQuotient(mass_) * context.control_period).maxCoeff() >= 1)
    throw ElementError("damping", "damping / mass must be below the control rate, or the compliant frame rings");
}

void Admittance::moveCompliantFrame(double dt) {
  const Eigen::Vector3d force =
      wrench_.force_W + wanted_W_ - damping_.cwiseProduct(e_rate_) - stiffness_.cwiseProduct(e_);
  e_rate_ += dt * force.cwiseQuotient(mass_);
  if (e_rate_.norm() > speed_) e_rate_ *= speed_ / e_rate_.norm();
  e_ += dt * e_rate_;
}

void Admittance::doUpdate(const Tick& tick, TickTask& rows) {
  const Eigen::Isometry3d X_WE = tick.robot.framePose(frame_);
  if (!started_) {
    reference_W_ = X_WE.translation();
    orientation_W_ = X_WE.linear();
    started_ = true;
  }
  moveCompliantFrame(tick.dt);

  const tactus::dynamics::Vector6d velocity = tick.robot.frameVelocity(frame_);
  const Eigen::Vector3d away = reference_W_ + e_ - X_WE.translation();
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(orientation_W_ * X_WE.linear().transpose()));

  rows.rows = 6;
  tick.robot.frameJacobian(frame_, rows.jacobian.topRows<6>());
  rows.force.head<3>() = track_stiffness_ * away - track_damping_ * (velocity.head<3>() - e_rate_);
  rows.force.segment<3>(3) = turn_stiffness_ * turn.angle() * turn.axis() - turn_damping_ * velocity.tail<3>();
  error_ = away.norm();
  given_way_ = e_.norm();
}

bool Admittance::displacement(const tactus::dynamics::DynamicsCache& from, const tactus::dynamics::DynamicsCache& to,
                              Eigen::Ref<Eigen::VectorXd> dx) const {
  dx = frameDisplacement(from, to, frame_);
  return true;
}

void Admittance::doArchive(Archive& archive) {
  archive("started", started_);
  archive("reference", reference_W_);
  archive("orientation", orientation_W_);
  archive("e", e_);
  archive("e-rate", e_rate_);
  archive("given-way", given_way_);
}

void Admittance::columns(std::vector<LogColumn>& columns) const { columns.push_back({"given_way_m", &given_way_}); }

}  // namespace wrist
