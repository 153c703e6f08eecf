#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "framework/geometry/shape.h"

namespace tactus::geometry {

struct PosedShape {
  std::shared_ptr<const Shape> shape;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();          ///< of the shape's frame in that of the whole
};

/// The union of shapes.  The distance is the least of theirs: outside as right as theirs; inside, where parts overlap,
/// the depth is a lower bound (the surface of one part may lie within another), and the foot p − distance · gradient
/// lies on the surface or inside.  `error()` is that of the worst part, and is kept outside.
class Compound final : public Shape {
 public:
  /// Throws std::invalid_argument when there are no parts.
  explicit Compound(std::vector<PosedShape> parts);

 private:
  struct Part {
    std::shared_ptr<const Shape> shape;
    Eigen::Matrix3d R;
    Eigen::Vector3d p;
    double bounding_radius;
  };
  SignedDistance doDistance(const Eigen::Vector3d& p) const override;
  /// None when a part has none.
  std::optional<Eigen::Vector3d> doSupport(const Eigen::Vector3d& n) const override;
  TriangleMesh doSurface() const override;

  std::vector<Part> parts_;
};

}  // namespace tactus::geometry
