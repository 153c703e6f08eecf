#include "framework/dynamics/spatial.h"

namespace tactus::dynamics {
namespace {

Eigen::Matrix3d skew(const Eigen::Vector3d& a) {
  Eigen::Matrix3d matrix;
  matrix << 0, -a.z(), a.y(), a.z(), 0, -a.x(), -a.y(), a.x(), 0;
  return matrix;
}

}  // namespace

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
  RigidBodyInertia I_A;
  const Eigen::Vector3d rotated_moment = R_AB * first_moment;
  I_A.mass = mass;
  I_A.first_moment = rotated_moment + mass * p_AB;
  // The parallel-axis theorem for an inertia that is not about the centre of mass, with k = R h + m p / 2:
  // I_A = R I Rᵀ + 2 (p·k) 1 − k pᵀ − p kᵀ.
  const Eigen::Vector3d& p = p_AB;
  const Eigen::Vector3d k = rotated_moment + 0.5 * mass * p;
  const Eigen::Matrix3d RI = R_AB * rotational;
  const double kx_px = 2 * k.x() * p.x(), ky_py = 2 * k.y() * p.y(), kz_pz = 2 * k.z() * p.z();
  Eigen::Matrix3d& I = I_A.rotational;
  I(0, 0) = RI.row(0).dot(R_AB.row(0)) + ky_py + kz_pz;
  I(1, 1) = RI.row(1).dot(R_AB.row(1)) + kx_px + kz_pz;
  I(2, 2) = RI.row(2).dot(R_AB.row(2)) + kx_px + ky_py;
  I(1, 0) = I(0, 1) = RI.row(1).dot(R_AB.row(0)) - k.x() * p.y() - k.y() * p.x();
  I(2, 0) = I(0, 2) = RI.row(2).dot(R_AB.row(0)) - k.x() * p.z() - k.z() * p.x();
  I(2, 1) = I(1, 2) = RI.row(2).dot(R_AB.row(1)) - k.y() * p.z() - k.z() * p.y();
  return I_A;
}

RigidBodyInertia RigidBodyInertia::transformed(const Eigen::Isometry3d& X_AB) const {
  return transformed(X_AB.linear(), X_AB.translation());
}

}  // namespace tactus::dynamics
