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

/// u + a × b, row by row: summed as vectors, Eigen keeps a × b in memory for an instant and the processor waits.
inline Eigen::Vector3d plusCross(const Eigen::Vector3d& u, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return {u[0] + (a[1] * b[2] - a[2] * b[1]), u[1] + (a[2] * b[0] - a[0] * b[2]), u[2] + (a[0] * b[1] - a[1] * b[0])};
}

/// A spatial force, an element of F⁶.
class ForceVector {
 public:
  ForceVector() = default;
  ForceVector(const Eigen::Vector3d& force, const Eigen::Vector3d& moment) : force_(force), moment_(moment) {}
  explicit ForceVector(const Vector6d& coordinates) : force_(coordinates.head<3>()), moment_(coordinates.tail<3>()) {}
  static ForceVector Zero() { return {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()}; }

  const Eigen::Vector3d& force() const { return force_; }
  const Eigen::Vector3d& moment() const { return moment_; }
  Vector6d coordinates() const { return (Vector6d() << force_, moment_).finished(); }

  ForceVector& operator+=(const ForceVector& other) {
    force_ += other.force_;
    moment_ += other.moment_;
    return *this;
  }
  ForceVector& operator-=(const ForceVector& other) {
    force_ -= other.force_;
    moment_ -= other.moment_;
    return *this;
  }
  friend ForceVector operator+(const ForceVector& a, const ForceVector& b) {
    return {a.force_ + b.force_, a.moment_ + b.moment_};
  }

 private:
  Eigen::Vector3d force_, moment_;
};

/// A spatial velocity or acceleration, an element of M⁶.
class MotionVector {
 public:
  MotionVector() = default;
  MotionVector(const Eigen::Vector3d& linear, const Eigen::Vector3d& angular) : linear_(linear), angular_(angular) {}
  explicit MotionVector(const Vector6d& coordinates)
      : linear_(coordinates.head<3>()), angular_(coordinates.tail<3>()) {}
  static MotionVector Zero() { return {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()}; }

  const Eigen::Vector3d& linear() const { return linear_; }
  const Eigen::Vector3d& angular() const { return angular_; }
  Vector6d coordinates() const { return (Vector6d() << linear_, angular_).finished(); }

  /// Velocity of the body point now at p.
  Eigen::Vector3d at(const Eigen::Vector3d& p) const { return plusCross(linear_, angular_, p); }

  /// Scalar product M⁶ × F⁶: power, when this is a velocity.
  double dot(const ForceVector& f) const { return linear_.dot(f.force()) + angular_.dot(f.moment()); }

  /// v × m, (2.33): rate of change of m when it is fixed to a body that moves with v.
  MotionVector cross(const MotionVector& m) const {
    return {plusCross(angular_.cross(m.linear_), linear_, m.angular_), angular_.cross(m.angular_)};
  }
  /// v ×* f, (2.34).
  ForceVector cross(const ForceVector& f) const {
    return {angular_.cross(f.force()), plusCross(angular_.cross(f.moment()), linear_, f.force())};
  }

  MotionVector& operator+=(const MotionVector& other) {
    linear_ += other.linear_;
    angular_ += other.angular_;
    return *this;
  }
  friend MotionVector operator+(const MotionVector& a, const MotionVector& b) {
    return {a.linear_ + b.linear_, a.angular_ + b.angular_};
  }
  friend MotionVector operator*(const MotionVector& m, double s) { return {m.linear_ * s, m.angular_ * s}; }

 private:
  Eigen::Vector3d linear_, angular_;
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
    return {plusCross(I.mass * v.linear(), v.angular(), I.first_moment),
            plusCross(I.rotational * v.angular(), I.first_moment, v.linear())};
  }
};

}  // namespace tactus::dynamics
