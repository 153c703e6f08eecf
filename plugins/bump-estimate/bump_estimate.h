#pragma once

#include <cstdint>
#include <vector>

#include "framework/control/registry.h"

namespace tactus::plugins {

/// The signal `bump-estimate`: finds a round bump on a flat surface from touched points alone.
///
/// 1. The surface: the plane with most touched points within `tolerance` (random sample consensus, Fischler & Bolles
///    1981, with a fixed seed), refined by least squares; it faces against the contact normals.
/// 2. The bump: the points higher than `min-height` above it; fewer than `min-points` mean that none was found.
/// 3. Its shape: the sphere through them, algebraic least squares, then Gauss–Newton on the distances with points far
///    off left out.  Where no sensible sphere comes out (its top is not near the highest point), the highest point
///    stands for the top.
/// Port `estimate`: the bump's highest point, and its height above the plane.
class BumpEstimate final : public control::Signal {
 public:
  explicit BumpEstimate(const control::BuildContext& context);
  static void registerIn(control::Registry& registry);

  void columns(std::vector<control::LogColumn>& columns) const override;

 private:
  struct Plane {
    Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();             ///< unit, out of the surface
    double offset = 0;                                             ///< normal · p on the plane
  };
  struct Sphere {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    double radius = 0;
  };

  void doUpdate(const control::Tick& tick) override;
  const void* doPort(std::string_view name) const override;
  void doArchive(control::Archive& archive) override;
  void estimate();
  bool fitPlane(Plane& plane);
  bool fitSphere(Sphere& sphere);

  const control::TouchedPoints& touched_;
  double min_height_, tolerance_, interval_;
  int min_points_;
  double next_time_ = 0;
  std::uint64_t random_ = 1;
  std::vector<Eigen::Vector3d> feature_;                           ///< points above the plane, reserved
  control::FeatureEstimate result_;
  double found_ = 0, x_ = 0, y_ = 0, z_ = 0;
};

}  // namespace tactus::plugins
