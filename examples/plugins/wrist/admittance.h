#pragma once

#include "framework/control/registry.h"
#include "wrench.h"

namespace wrist {

/// `<wrist.admittance>`: a hand that gives way to what it feels at the wrist, with a mass, a damper and a spring of
/// one's choice, and presses with a wanted force where the spring is zero.
///
/// The outer loop moves a compliant frame x_c away from the reference x_r by e, per axis of the world (Hogan 1985;
/// Siciliano & Villani, Robot Force Control, 1999, sec. 3.2; Seraji 1994 for the force set-point):
///
///   M ë + D ė + K e = f + f_d        f: what the world does to the hand (N), f_d: the force wanted on the world
///
/// integrated by semi-implicit Euler steps.  At rest K e = f + f_d: in a stiff axis the hand stands K⁻¹f beside x_r, in
/// one with K = 0 it moves until f = −f_d, so that it presses with f_d.  Without contact such an axis drifts with
/// f_d / D; `speed` bounds ‖ė‖.
///
/// The inner loop is a spring and damper towards x_c, and holds the orientation of the first tick; six equality rows,
/// the frame Jacobian (linear rows first, world axes):
///
///   F = ( k (x_c − x) − d (ẋ − ė),   k_r Ψ − d_r ω )
///
/// How light M may be is bounded by the inertia that the arm has at its hand: too light a wish rings on a stiff table
/// (Colgate & Hogan 1988).
class Admittance final : public tactus::control::Task {
 public:
  explicit Admittance(const tactus::control::BuildContext& context);
  static void registerIn(tactus::control::Registry& registry);

  bool displacement(const tactus::dynamics::DynamicsCache& from, const tactus::dynamics::DynamicsCache& to,
                    Eigen::Ref<Eigen::VectorXd> dx) const override;
  void columns(std::vector<tactus::control::LogColumn>& columns) const override;

 private:
  void doUpdate(const tactus::control::Tick& tick, tactus::control::TickTask& rows) override;
  void doArchive(tactus::control::Archive& archive) override;
  void moveCompliantFrame(double dt);

  int frame_;
  const Wrench& wrench_;
  Eigen::Vector3d mass_, damping_, stiffness_;                     // kg, N s/m, N/m
  Eigen::Vector3d wanted_W_;                                       // f_d, N
  double speed_;                                                   // m/s
  double track_stiffness_, track_damping_, turn_stiffness_, turn_damping_;

  bool started_ = false;
  Eigen::Vector3d reference_W_ = Eigen::Vector3d::Zero();          // x_r, m
  Eigen::Matrix3d orientation_W_ = Eigen::Matrix3d::Identity();
  Eigen::Vector3d e_ = Eigen::Vector3d::Zero(), e_rate_ = Eigen::Vector3d::Zero();
  double given_way_ = 0;                                           // ‖e‖, m
};

}  // namespace wrist
