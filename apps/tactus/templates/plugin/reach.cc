#include "reach.h"

#include "framework/control/displacement.h"

using namespace tactus::control;

// What may stand in a stack.  Types, ranges, units, defaults and names of links are checked from this table, and
// `tactus explain @NAME@.reach` shows it.
void Reach::registerIn(Registry& registry) {
  ElementRow row;
  row.name = "@NAME@.reach";
  row.description = "Pulls a link to a target with a bounded force.";
  row.attributes = {
      {.name = "frame", .type = ValueType::link, .required = true, .description = "The link whose origin is pulled."},
      {.name = "target", .type = ValueType::reals, .unit = "m", .required = true,
       .description = "x_t, world axes.", .count = 3, .in_world = InWorld::positions},
      {.name = "stiffness", .type = ValueType::real, .unit = "N/m", .default_text = "200",
       .description = "k.", .lower = 0},
      {.name = "damping", .type = ValueType::real, .unit = "N s/m", .default_text = "60",
       .description = "d.", .lower = 0},
      {.name = "max-force", .type = ValueType::real, .unit = "N", .default_text = "20",
       .description = "Most force of the spring.", .lower = 0, .lower_open = true},
  };
  registry.addTask(row, [](const BuildContext& context) { return std::make_unique<Reach>(context); });
}

Reach::Reach(const BuildContext& context)
    : Task(Relation::equality, 3),                                 // at most three rows
      frame_(context.frame("frame")),
      target_W_(context.values.vector3("target")),
      stiffness_(context.values.real("stiffness")),
      damping_(context.values.real("damping")),
      max_force_(context.values.real("max-force")) {}

// Called every tick: fills `rows`, takes no memory.
void Reach::doUpdate(const Tick& tick, TickTask& rows) {
  const Eigen::Vector3d x = tick.robot.framePose(frame_).translation();
  const Eigen::Vector3d velocity = tick.robot.pointVelocity(frame_, x);
  const Eigen::Vector3d away = target_W_ - x;

  Eigen::Vector3d spring = stiffness_ * away;
  if (spring.norm() > max_force_) spring *= max_force_ / spring.norm();

  rows.rows = 3;
  tick.robot.pointJacobian(frame_, x, rows.jacobian.topRows<3>());
  rows.force.head<3>() = spring - damping_ * velocity;
  error_ = away.norm();                                            // m, task/NAME/error in the log
  pull_N_ = spring.norm();
}

// What J is the derivative of: lets `tactus plugins check` hold it against differences.
bool Reach::displacement(const tactus::dynamics::DynamicsCache& from, const tactus::dynamics::DynamicsCache& to,
                         Eigen::Ref<Eigen::VectorXd> dx) const {
  dx = pointDisplacement(from, to, frame_, from.framePose(frame_).translation());
  return true;
}

void Reach::columns(std::vector<LogColumn>& columns) const { columns.push_back({"pull_N", &pull_N_}); }
