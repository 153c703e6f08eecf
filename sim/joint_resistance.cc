#include "sim/joint_resistance.h"

#include <algorithm>

namespace tactus::sim {

JointResistance::JointResistance(const description::Robot& robot, const Eigen::VectorXd& inertia, double step)
    : step_(step) {
  const std::vector<int> moving = robot.movingJoints();
  for (int i = 0; i < static_cast<int>(moving.size()); ++i) {
    const description::Joint& joint = robot.joints[moving[i]];
    axes_.push_back({.lower = joint.lower,
                     .upper = joint.upper,
                     .damping = joint.damping,
                     .own_friction = joint.friction,
                     .stiffness = 0.05 * inertia[i] / (step * step),
                     .stop_damping = 0.22 * inertia[i] / step});
  }
}

void JointResistance::setAddedFriction(const Eigen::VectorXd& friction) {
  for (int i = 0; i < static_cast<int>(axes_.size()); ++i) {
    Axis& axis = axes_[i];
    axis.friction = axis.own_friction + friction[i];
    if (axis.friction <= 0) axis.bend = axis.next_bend = 0;
  }
}

void JointResistance::add(const Eigen::VectorXd& q, const Eigen::VectorXd& qd, Eigen::VectorXd& torque) {
  for (int i = 0; i < static_cast<int>(axes_.size()); ++i) {
    Axis& axis = axes_[i];
    torque[i] -= axis.damping * qd[i];
    if (q[i] < axis.lower)
      torque[i] += std::max(0.0, axis.stiffness * (axis.lower - q[i]) - axis.stop_damping * qd[i]);
    else if (q[i] > axis.upper)
      torque[i] += std::min(0.0, axis.stiffness * (axis.upper - q[i]) - axis.stop_damping * qd[i]);
    if (axis.friction > 0) {
      const double bend_limit = axis.friction / axis.stiffness;
      axis.next_bend = std::clamp(axis.bend + step_ * qd[i], -bend_limit, bend_limit);
      torque[i] -= std::clamp(axis.stiffness * axis.next_bend + axis.stop_damping * qd[i], -axis.friction,
                              axis.friction);
    }
  }
}

void JointResistance::commit() {
  for (Axis& axis : axes_) axis.bend = axis.next_bend;
}

void JointResistance::archive(control::Archive& archive) {
  std::vector<double> bends;
  for (const Axis& axis : axes_) bends.push_back(axis.bend);
  archive("bends", bends);
  for (std::size_t i = 0; i < axes_.size(); ++i) axes_[i].bend = bends[i];
}

}  // namespace tactus::sim
