#pragma once

#include "framework/geometry/shape.h"

/// The convex solids that have a name.  Each has its origin in its middle, but for the plane; distances are exact.
/// The constructors throw std::invalid_argument for a length that is not finite and above 0.
namespace tactus::geometry {

/// The half space below z = 0; its outward normal is +z.
class Plane final : public Shape {
 public:
  Plane();

 private:
  SignedDistance doDistance(const Eigen::Vector3d& p) const override;
  std::optional<Eigen::Vector3d> doSupport(const Eigen::Vector3d& n) const override;
  TriangleMesh doSurface() const override;
};

class Box final : public Shape {
 public:
  /// Full edge lengths, m.
  explicit Box(const Eigen::Vector3d& size);
  const Eigen::Vector3d& size() const { return size_; }

 private:
  SignedDistance doDistance(const Eigen::Vector3d& p) const override;
  std::optional<Eigen::Vector3d> doSupport(const Eigen::Vector3d& n) const override;
  TriangleMesh doSurface() const override;
  /// Its 8 corners, the insides of its 12 edges, so that edge meets edge, and 4 points inside each face, on which a
  /// box stands that is flush with another one.
  std::vector<Feeler> doFeelers() const override;
  Eigen::Vector3d size_;
};

class Sphere final : public Shape {
 public:
  explicit Sphere(double radius);
  double radius() const { return boundingRadius(); }

 private:
  SignedDistance doDistance(const Eigen::Vector3d& p) const override;
  std::optional<Eigen::Vector3d> doSupport(const Eigen::Vector3d& n) const override;
  TriangleMesh doSurface() const override;
  /// Itself.
  std::vector<Feeler> doFeelers() const override;
};

/// Axis along z.
class Cylinder final : public Shape {
 public:
  /// `length` is the full height, m.
  Cylinder(double radius, double length);
  double radius() const { return radius_; }
  double length() const { return length_; }

 private:
  SignedDistance doDistance(const Eigen::Vector3d& p) const override;
  std::optional<Eigen::Vector3d> doSupport(const Eigen::Vector3d& n) const override;
  TriangleMesh doSurface() const override;
  /// Two rims of 24 points, each with a third of the stiffness: rolling on its side it rises and falls by
  /// r (1 − cos 7.5°) < 0.009 r, which slows it down; and 6 points inside each end, on which it stands flush on another one.
  std::vector<Feeler> doFeelers() const override;
  double radius_;
  double length_;
};

/// Axis along z.
class Capsule final : public Shape {
 public:
  /// `length` is that of the straight part, m.
  Capsule(double radius, double length);
  double radius() const { return radius_; }
  double length() const { return length_; }

 private:
  SignedDistance doDistance(const Eigen::Vector3d& p) const override;
  std::optional<Eigen::Vector3d> doSupport(const Eigen::Vector3d& n) const override;
  TriangleMesh doSurface() const override;
  /// Itself.
  std::vector<Feeler> doFeelers() const override;
  double radius_;
  double length_;
};

}  // namespace tactus::geometry
