#pragma once

#include <Eigen/Geometry>

/// Spatial (6-D) vector algebra, Featherstone, Rigid Body Dynamics Algorithms (2008), ch. 2.
///
/// Every 6-vector has its linear rows first; the book has the angular ones first.  A vector is expressed in the
/// axes of some frame and taken about its origin O: a motion vector is (velocity of the body point now at O,
/// angular velocity), a force vector is (force, moment about O).  SI units.
namespace tactus::dynamics {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

/// A spatial force, an element of F⁶.
struct ForceVector {
  Vector6d coordinates;

  ForceVector() = default;
  explicit ForceVector(const Vector6d& coordinates) : coordinates(coordinates) {}
  ForceVector(const Eigen::Vector3d& force, const Eigen::Vector3d& moment) { coordinates << force, moment; }
  static ForceVector Zero() { return ForceVector(Vector6d::Zero()); }

  auto force() const { return coordinates.head<3>(); }
  auto moment() const { return coordinates.tail<3>(); }

  ForceVector& operator+=(const ForceVector& other) {
    coordinates += other.coordinates;
    return *this;
  }
  friend ForceVector operator+(const ForceVector& a, const ForceVector& b) {
    return ForceVector(Vector6d(a.coordinates + b.coordinates));
  }
};

/// A spatial velocity or acceleration, an element of M⁶.
struct MotionVector {
  Vector6d coordinates;

  MotionVector() = default;
  explicit MotionVector(const Vector6d& coordinates) : coordinates(coordinates) {}
  MotionVector(const Eigen::Vector3d& linear, const Eigen::Vector3d& angular) { coordinates << linear, angular; }
  static MotionVector Zero() { return MotionVector(Vector6d::Zero()); }

  auto linear() const { return coordinates.head<3>(); }
  auto angular() const { return coordinates.tail<3>(); }

  /// Velocity of the body point now at p.
  Eigen::Vector3d at(const Eigen::Vector3d& p) const { return linear() + angular().cross(p); }

  /// Scalar product M⁶ × F⁶: power, when this is a velocity.
  double dot(const ForceVector& f) const { return coordinates.dot(f.coordinates); }

  /// v × m, (2.33): rate of change of m when it is fixed to a body that moves with v.
  MotionVector cross(const MotionVector& m) const {
    return {angular().cross(m.linear()) + linear().cross(m.angular()), angular().cross(m.angular())};
  }
  /// v ×* f, (2.34).
  ForceVector cross(const ForceVector& f) const {
    return {angular().cross(f.force()), angular().cross(f.moment()) + linear().cross(f.force())};
  }

  MotionVector& operator+=(const MotionVector& other) {
    coordinates += other.coordinates;
    return *this;
  }
  friend MotionVector operator+(const MotionVector& a, const MotionVector& b) {
    return MotionVector(Vector6d(a.coordinates + b.coordinates));
  }
  friend MotionVector operator*(const MotionVector& m, double s) { return MotionVector(Vector6d(m.coordinates * s)); }
};

/// The Plücker transform of a pose X_AB: takes the coordinates of vectors given in B to A (2.24, 2.25).
MotionVector transform(const Eigen::Isometry3d& X_AB, const MotionVector& m_B);
ForceVector transform(const Eigen::Isometry3d& X_AB, const ForceVector& f_B);

/// Inertia of a rigid body about the origin of its frame, (2.63): ten numbers that add up when bodies are joined.
struct RigidBodyInertia {
  double mass = 0;                                                 ///< m, kg
  Eigen::Vector3d first_moment = Eigen::Vector3d::Zero();          ///< h = m c, kg m
  Eigen::Matrix3d rotational = Eigen::Matrix3d::Zero();            ///< about the origin, kg m²

  /// From what is usually written down: `inertia` about the centre of mass `c`.
  static RigidBodyInertia aboutCentreOfMass(double mass, const Eigen::Vector3d& c, const Eigen::Matrix3d& inertia);

  Eigen::Vector3d centreOfMass() const;                            ///< h / m; the origin when m = 0
  Eigen::Matrix3d inertiaAboutCentreOfMass() const;
  Matrix6d matrix() const;

  /// The same body seen from A, when X is the pose X_AB of the frame that this inertia is given in.
  RigidBodyInertia transformed(const Eigen::Matrix3d& R_AB, const Eigen::Vector3d& p_AB) const;
  RigidBodyInertia transformed(const Eigen::Isometry3d& X_AB) const;

  RigidBodyInertia& operator+=(const RigidBodyInertia& other) {
    mass += other.mass;
    first_moment += other.first_moment;
    rotational += other.rotational;
    return *this;
  }
  /// Momentum I v, or the force I a.
  friend ForceVector operator*(const RigidBodyInertia& I, const MotionVector& v) {
    return {I.mass * v.linear() + v.angular().cross(I.first_moment),
            I.rotational * v.angular() + I.first_moment.cross(v.linear())};
  }
};

}  // namespace tactus::dynamics
