#pragma once

#include "framework/control/registry.h"

/// `<plane.fit>`: the plane through all points touched so far, by total least squares (Pearson 1901).
///
/// With the points p_i (m, world axes), their mean p̄ and scatter S = Σ (p_i − p̄)(p_i − p̄)ᵀ, the plane that is
/// nearest to them in the sense of Σ dist² goes through p̄, and its normal n is the eigenvector of the smallest
/// eigenvalue λ₀ of S; n is turned so that it points against the mean contact normal, out of the surface.  Mean and
/// scatter are updated point by point (Welford 1962), so a tick costs the same however many points there are:
///
///   p̄ ← p̄ + (p − p̄)/N,   S ← S + (p − p̄_old)(p − p̄_new)ᵀ.
///
/// Ports: `known` 1 once there are `min-points` that are no line, λ₁ > `spread`² N; `tilt` the angle between n and the
/// vertical; `height` of the plane at p̄; `rms` = √(λ₀/N), how flat it is.
class PlaneFit final : public tactus::control::Signal {
 public:
  explicit PlaneFit(const tactus::control::BuildContext& context);
  static void registerIn(tactus::control::Registry& registry);

  void columns(std::vector<tactus::control::LogColumn>& columns) const override;

 private:
  void doUpdate(const tactus::control::Tick& tick) override;
  const void* doPort(std::string_view name) const override;
  void doArchive(tactus::control::Archive& archive) override;
  void add(const tactus::control::TouchedPoint& touched);
  void fit();

  const tactus::control::TouchedPoints& points_;
  std::size_t min_points_;
  double spread_;                                                  // m
  std::size_t seen_ = 0;
  Eigen::Vector3d mean_ = Eigen::Vector3d::Zero();                 // p̄, m
  Eigen::Matrix3d scatter_ = Eigen::Matrix3d::Zero();              // S, m²
  Eigen::Vector3d normals_ = Eigen::Vector3d::Zero();              // sum, out of the robot
  double known_ = 0, tilt_ = 0, height_ = 0, rms_ = 0;
};
