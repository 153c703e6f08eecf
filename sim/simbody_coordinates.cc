#include "sim/simbody_coordinates.h"

#include <Eigen/Geometry>

namespace tactus::sim {
namespace {

using description::JointType;

/// How many of a joint's numbers, in q or q̇, stand before those that Simbody has first.
int leading(JointType type) {
  switch (type) {
    case JointType::planar: return 2;                              // x, y | angle
    case JointType::floating: return 3;                            // x, y, z | rotation
    default: return 0;
  }
}

bool turnsFreely(JointType type) { return type == JointType::spherical || type == JointType::floating; }

}  // namespace

void SimbodyCoordinates::add(SimTK::MobilizedBodyIndex body, JointType type) {
  joints_.push_back({body, type, position_count_, dof_});
  position_count_ += description::positionCount(type);
  dof_ += description::velocityCount(type);
}

void SimbodyCoordinates::setState(const SimTK::SimbodyMatterSubsystem& matter, const Eigen::VectorXd& q,
                                  const Eigen::VectorXd& qd, SimTK::State& state) const {
  auto simbody_q = toEigen(state.updQ());
  for (const Joint& joint : joints_) {
    const int count = description::positionCount(joint.type), before = leading(joint.type), after = count - before;
    auto to = simbody_q.segment(matter.getMobilizedBody(joint.body).getFirstQIndex(state), count);
    to.head(after) = q.segment(joint.position + before, after);
    to.tail(before) = q.segment(joint.position, before);
  }
  toEigen(state.updU()) = speedMatrix(matter, state) * qd;
}

Eigen::VectorXd SimbodyCoordinates::positions(const SimTK::SimbodyMatterSubsystem& matter, const SimTK::State& state,
                                              const SimTK::Vector& simbody_q) const {
  Eigen::VectorXd q(position_count_);
  for (const Joint& joint : joints_) {
    const int count = description::positionCount(joint.type), before = leading(joint.type), after = count - before;
    const auto from = toEigen(simbody_q).segment(matter.getMobilizedBody(joint.body).getFirstQIndex(state), count);
    q.segment(joint.position + before, after) = from.head(after);
    q.segment(joint.position, before) = from.tail(before);
  }
  return q;
}

Eigen::MatrixXd SimbodyCoordinates::speedMatrix(const SimTK::SimbodyMatterSubsystem& matter,
                                                const SimTK::State& state) const {
  Eigen::MatrixXd T = Eigen::MatrixXd::Zero(dof_, dof_);
  const auto simbody_q = toEigen(state.getQ());
  for (const Joint& joint : joints_) {
    const SimTK::MobilizedBody& body = matter.getMobilizedBody(joint.body);
    const int count = description::velocityCount(joint.type), before = leading(joint.type), after = count - before;
    const int u = body.getFirstUIndex(state);
    auto rotations = T.block(u, joint.coordinate + before, after, after);
    if (turnsFreely(joint.type)) {
      const auto w_xyz = simbody_q.segment<4>(body.getFirstQIndex(state));
      rotations = Eigen::Quaterniond(w_xyz[0], w_xyz[1], w_xyz[2], w_xyz[3]).normalized().toRotationMatrix();
    } else {
      rotations.setIdentity();
    }
    T.block(u + after, joint.coordinate, before, before).setIdentity();
  }
  return T;
}

}  // namespace tactus::sim
