#pragma once

#include "framework/control/registry.h"

namespace probe {

/// `<probe.lens>`: what two equal balls have in common, its rim in the plane z = 0.  Convex; distances are exact.
///
/// With the rim's radius a and the thickness t the balls have the radius R = (a² + (t/2)²)/t, and their centres lie
/// c = R − t/2 below and above the rim's.  By symmetry a point is looked at from above: what is nearest to it lies on
/// the cap, along the ray from the ball's centre below, where that ray leaves the ball above z = 0; else on the rim.
class Lens final : public tactus::geometry::Shape {
 public:
  /// m; throws std::invalid_argument when the thickness is more than the rim's diameter.
  Lens(double radius, double thickness);
  static void registerIn(tactus::control::Registry& registry);

 private:
  tactus::geometry::SignedDistance doDistance(const Eigen::Vector3d& p) const override;

  double rim_;                                                     // a
  double ball_;                                                    // R
  double centre_;                                                  // c
};

}  // namespace probe
