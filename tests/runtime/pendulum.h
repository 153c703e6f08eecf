#pragma once

#include <cmath>

#include "framework/control/controller.h"
#include "framework/runtime/plant.h"

/// The smallest whole chain: a pendulum, a spring task, a back end that applies the task's torque.
namespace tactus::testing {

inline constexpr double pendulum_mass = 2;                         // kg
inline constexpr double pendulum_length = 0.5;                     // m
inline constexpr double pendulum_inertia = 0.001;                  // kg m², about the bob's own centre
inline constexpr double gravity = 9.81;                            // m/s²

/// A bob on a massless rod that turns about the world's y axis and hangs along −z at q = 0.
inline description::Robot pendulum() {
  description::Robot robot;
  robot.name = "pendulum";
  robot.links.resize(2);
  robot.links[0].name = "base";
  robot.links[1].name = "bob";
  robot.links[1].has_inertial = true;
  robot.links[1].mass = pendulum_mass;
  robot.links[1].centre_of_mass = Eigen::Vector3d(0, 0, -pendulum_length);
  robot.links[1].inertia = pendulum_inertia * Eigen::Matrix3d::Identity();
  description::Joint joint;
  joint.name = "hinge";
  joint.type = description::JointType::revolute;
  joint.parent = 0;
  joint.child = 1;
  joint.axis = Eigen::Vector3d::UnitY();
  joint.effort = 100;
  robot.joints.push_back(joint);
  return robot;
}

/// Spring and damper towards an angle.
class Spring final : public control::Task {
 public:
  explicit Spring(double target) : Task(control::Relation::equality, 1), target_(target) {}
  void columns(std::vector<control::LogColumn>& columns) const override { columns.push_back({"speed", &speed_}); }

 private:
  void doUpdate(const control::Tick& tick, control::TickTask& rows) override {
    error_ = std::abs(target_ - tick.sensed.q[0]);
    speed_ = tick.sensed.qd[0];
    rows.rows = 1;
    rows.jacobian(0, 0) = 1;
    rows.force[0] = 20 * (target_ - tick.sensed.q[0]) - 5 * speed_;
  }
  double target_;
  double speed_ = 0;
};

/// Counts its ticks.
class TickCounter final : public control::Signal {
 public:
  void columns(std::vector<control::LogColumn>& columns) const override { columns.push_back({"count", &count_}); }

 private:
  void doUpdate(const control::Tick&) override { ++count_; }
  const void* doPort(std::string_view) const override { return &count_; }
  double count_ = 0;
};

/// τ = Σ JᵀF.  Reports failure in the ticks from `fails_from` on.
class SumOfTasks final : public control::BackEnd {
 public:
  explicit SumOfTasks(bool with_kkt = false, long fails_from = -1)
      : BackEnd({}), with_kkt_(with_kkt), fails_from_(fails_from) {}

 private:
  void doPrepare(const control::TickProblem&) override {}
  void doSolve(const control::TickProblem& problem, control::TickSolution& solution) override {
    solution.torque.setZero(problem.dof);
    for (const control::TickLevel& level : problem.levels) {
      for (const control::TickTask& task : level.tasks) solution.torque += task.J().transpose() * task.F();
    }
    const bool fails = fails_from_ >= 0 && ticks_ >= fails_from_;
    solution.status = fails ? control::Status::failed : control::Status::ok;
    solution.rank_deficient_levels = ticks_ % 4 == 0;
    solution.has_kkt = with_kkt_;
    solution.kkt.stationarity = 1e-9 * static_cast<double>(++ticks_);
  }
  bool with_kkt_;
  long fails_from_;
  long ticks_ = 0;
};

/// I q̈ = τ − m g l sin q, semi-implicit Euler in steps of 1 ms.
class PendulumPlant final : public runtime::Plant {
 public:
  PendulumPlant() {
    sensed_.q = Eigen::VectorXd::Zero(1);
    sensed_.qd = Eigen::VectorXd::Zero(1);
  }
  const control::Sensed& sense() const override { return sensed_; }
  void advance(const Eigen::VectorXd& torque, double duration) override {
    const double inertia = pendulum_mass * pendulum_length * pendulum_length + pendulum_inertia;
    if (sensed_.time >= breaks_at) throw runtime::PlantError("the rod broke");
    sensed_.qd[0] += duration / inertia *
                     (torque[0] - pendulum_mass * gravity * pendulum_length * std::sin(sensed_.q[0]));
    sensed_.q[0] += duration * sensed_.qd[0];
    sensed_.time += duration;
  }
  double breaks_at = INFINITY;                                     ///< s

 private:
  control::Sensed sensed_;
};

inline std::unique_ptr<control::Controller> pendulumController(double target, bool with_kkt = false,
                                                               long fails_from = -1,
                                                               const description::Robot& robot = pendulum()) {
  std::vector<control::NamedSignal> signals;
  signals.push_back({"clock", std::make_unique<TickCounter>()});
  std::vector<control::Level> levels(1);
  levels[0].tasks.push_back({"lift", std::make_unique<Spring>(target)});
  return std::make_unique<control::Controller>(std::make_shared<dynamics::Model>(robot), std::move(signals),
                                               std::move(levels), std::make_unique<SumOfTasks>(with_kkt, fails_from),
                                               0.001, Eigen::Vector3d(0, 0, -gravity));
}

}  // namespace tactus::testing
