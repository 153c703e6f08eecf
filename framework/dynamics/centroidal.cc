#include "framework/dynamics/centroidal.h"

namespace tactus::dynamics {
namespace {

Eigen::Vector3d firstMoment(const Model& model, const Workspace& workspace) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int i = 0; i < model.bodyCount(); ++i)
    if (model.parent(i) < 0) sum += workspace.bodies[i].composite.first_moment;
  return sum;
}

Vector6d about(const Eigen::Vector3d& c, const ForceVector& f) {
  Vector6d coordinates;
  coordinates << f.force(), f.moment() - c.cross(f.force());
  return coordinates;
}

/// Of all bodies, about the world origin.
template <class OfBody>
ForceVector sum(const Workspace& workspace, OfBody of_body) {
  ForceVector total = ForceVector::Zero();
  for (const BodyState& state : workspace.bodies) total += of_body(state);
  return total;
}

}  // namespace

double mass(const Model& model) {
  double sum = 0;
  for (const Model::Body& body : model.bodies()) sum += body.inertia.mass;
  return sum;
}

Eigen::Vector3d centreOfMass(const Model& model, const Workspace& workspace) {
  const double m = mass(model);
  return m > 0 ? Eigen::Vector3d(firstMoment(model, workspace) / m) : Eigen::Vector3d::Zero();
}

void centreOfMassJacobian(const Model& model, const Workspace& workspace, PointJacobianRef J) {
  const double m = mass(model);
  J.setZero();
  // A coordinate's share of the linear momentum is that of the subtree it moves.
  for (int i = 0; i < model.bodyCount(); ++i) {
    const BodyState& state = workspace.bodies[i];
    J.col(model.bodies()[i].coordinate) += (state.composite * state.axis).force() / m;
  }
}

void momentumMatrix(const Model& model, const Workspace& workspace, FrameJacobianRef A) {
  const Eigen::Vector3d c = centreOfMass(model, workspace);
  A.setZero();
  for (int i = 0; i < model.bodyCount(); ++i) {
    const BodyState& state = workspace.bodies[i];
    A.col(model.bodies()[i].coordinate) += about(c, state.composite * state.axis);
  }
}

Eigen::Vector3d centreOfMassVelocity(const Model& model, const Workspace& workspace) {
  return momentum(model, workspace).head<3>() / mass(model);
}

Eigen::Vector3d centreOfMassAccelerationBias(const Model& model, const Workspace& workspace) {
  return momentumRateBias(model, workspace).head<3>() / mass(model);
}

Vector6d momentum(const Model& model, const Workspace& workspace) {
  return about(centreOfMass(model, workspace),
               sum(workspace, [](const BodyState& state) { return state.inertia * state.velocity; }));
}

// C moves along with the linear momentum, so that the moments about C need no further term.
Vector6d momentumRateBias(const Model& model, const Workspace& workspace) {
  return about(centreOfMass(model, workspace), sum(workspace, [](const BodyState& state) {
                 return state.inertia * state.bias_acceleration + state.velocity.cross(state.inertia * state.velocity);
               }));
}

double kineticEnergy(const Model&, const Workspace& workspace) {
  double energy = 0;
  for (const BodyState& state : workspace.bodies) energy += 0.5 * state.velocity.dot(state.inertia * state.velocity);
  return energy;
}

double potentialEnergy(const Model& model, const Workspace& workspace, const Eigen::Vector3d& gravity_W) {
  return -gravity_W.dot(firstMoment(model, workspace));
}

}  // namespace tactus::dynamics
