#include "framework/dynamics/spatial.h"

#include "framework/dynamics/skew.h"

namespace tactus::dynamics {

MotionVector transform(const Eigen::Isometry3d& X_AB, const MotionVector& m_B) {
  const Eigen::Vector3d angular = X_AB.linear() * m_B.angular();
  return {X_AB.linear() * m_B.linear() + X_AB.translation().cross(angular), angular};
}

ForceVector transform(const Eigen::Isometry3d& X_AB, const ForceVector& f_B) {
  const Eigen::Vector3d force = X_AB.linear() * f_B.force();
  return {force, X_AB.linear() * f_B.moment() + X_AB.translation().cross(force)};
}

RigidBodyInertia RigidBodyInertia::aboutCentreOfMass(double mass, const Eigen::Vector3d& c,
                                                     const Eigen::Matrix3d& inertia) {
  const Eigen::Matrix3d c_cross = skew(c);
  return {mass, mass * c, inertia - mass * c_cross * c_cross};
}

Eigen::Vector3d RigidBodyInertia::centreOfMass() const {
  if (mass == 0) return Eigen::Vector3d::Zero();
  return first_moment / mass;
}

Eigen::Matrix3d RigidBodyInertia::inertiaAboutCentreOfMass() const {
  return rotational + skew(first_moment) * skew(centreOfMass());
}

Matrix6d RigidBodyInertia::matrix() const {
  const Eigen::Matrix3d h_cross = skew(first_moment);
  Matrix6d I;
  I << mass * Eigen::Matrix3d::Identity(), -h_cross, h_cross, rotational;
  return I;
}

RigidBodyInertia RigidBodyInertia::transformed(const Eigen::Matrix3d& R_AB, const Eigen::Vector3d& p_AB) const {
  // The parallel-axis theorem for an inertia that is not about the centre of mass, with k = R h + m p / 2:
  // I_A = R I Rᵀ + 2 (p·k) 1 − k pᵀ − p kᵀ.  Column by column: so it becomes packed arithmetic.
  const Eigen::Matrix3d &R = R_AB, &I = rotational;
  const Eigen::Vector3d& p = p_AB;
  const Eigen::Vector3d rotated_moment = R * first_moment;
  const Eigen::Vector3d k = rotated_moment + 0.5 * mass * p;
  const Eigen::Vector3d RI_0 = R.col(0) * I(0, 0) + R.col(1) * I(1, 0) + R.col(2) * I(2, 0);
  const Eigen::Vector3d RI_1 = R.col(0) * I(0, 1) + R.col(1) * I(1, 1) + R.col(2) * I(2, 1);
  const Eigen::Vector3d RI_2 = R.col(0) * I(0, 2) + R.col(1) * I(1, 2) + R.col(2) * I(2, 2);
  const double twice_pk = 2 * p.dot(k);
  RigidBodyInertia I_A;
  I_A.mass = mass;
  I_A.first_moment = rotated_moment + mass * p;
  for (int j = 0; j < 3; ++j) {
    I_A.rotational.col(j) = RI_0 * R(j, 0) + RI_1 * R(j, 1) + RI_2 * R(j, 2) - k * p[j] - p * k[j];
    I_A.rotational(j, j) += twice_pk;
  }
  return I_A;
}

RigidBodyInertia RigidBodyInertia::transformed(const Eigen::Isometry3d& X_AB) const {
  return transformed(X_AB.linear(), X_AB.translation());
}

}  // namespace tactus::dynamics
