#pragma once

#include "framework/control/registry.h"

namespace tactus::tasks {

/// `ds`: tracks passively the velocity field of a linear dynamical system f(x) = A (x − x*) with the origin of a link
/// (Kronander & Billard 2016; the tank of this class keeps its claims where the usual one does not).
///
/// u = −D ẋ + λ₁ f_c + β_R λ₁ f_R,  D = λ₂ I + (λ₁ − λ₂) f fᵀ/‖f‖², so that D f = λ₁ f.
/// f_c = A_s (x − x*) comes from the potential V = −½ (x − x*)ᵀ A_s (x − x*); the rest f_R = A_a (x − x*), with the
/// skew part A_a, may inject energy and pays for it from a tank s ∈ [0, s̄], z = ẋᵀ f_R:
///   ṡ = α ẋᵀDẋ − β_s λ₁ z,  α = fall(s; s̄−δ, s̄),
///   z ≥ 0: β_s = β_R = rise(s; 0, δ);  z < 0: β_s = fall(s; s̄−δ, s̄), β_R from rise(s) to 1 over −dz < z < 0, ≥ β_s,
/// with δ = s̄/10 and rise, fall smoothsteps.  Then W = kinetic energy + λ₁ V + s obeys Ẇ ≤ ẋᵀF_ext.
/// Below a speed of 1e-6 m/s of the field the last direction of f is kept in D.
class DynamicalSystem final : public control::Task {
 public:
  explicit DynamicalSystem(const control::BuildContext& context);
  static void registerIn(control::Registry& registry);

  bool displacement(const dynamics::DynamicsCache& from, const dynamics::DynamicsCache& to,
                    Eigen::Ref<Eigen::VectorXd> dx) const override;
  void columns(std::vector<control::LogColumn>& columns) const override;
  void marks(std::vector<control::Mark>& marks) const override;
  double tank() const { return tank_; }                            ///< J

 private:
  void doUpdate(const control::Tick& tick, control::TickTask& rows) override;
  void doArchive(control::Archive& archive) override;

  int frame_;
  Eigen::Vector3d target_W_;
  Eigen::Matrix3d conservative_, rest_;                            ///< A_s, A_a, 1/s
  double lambda_along_, lambda_across_;                            ///< λ₁, λ₂, N s/m
  double tank_, tank_max_;                                         ///< J
  double blend_power_;                                             ///< dz, of ẋᵀf_R, m²/s²
  Eigen::Vector3d direction_W_ = Eigen::Vector3d::UnitX();         ///< last direction of f
};

}  // namespace tactus::tasks
