#pragma once

#include "framework/control/registry.h"

namespace tactus::tasks {

/// `impedance`: a Cartesian spring and damper on a link (thesis A.1.7–A.1.9, A.1.11).
///
/// Rows: the frame Jacobian J_e (6 × dof, linear rows first, world axes); F = K x_e − D ẋ with
/// x_e = (p_r − p, Ψ), Ψ the rotation towards the reference in world axes.  Stiffness and damping are given per axis of
/// `axes`: the world, or the link itself.  Without `position` (`orientation`) the pose of the first tick is held.
class Impedance final : public control::Task {
 public:
  explicit Impedance(const control::BuildContext& context);
  static void registerIn(control::Registry& registry);

  bool displacement(const dynamics::DynamicsCache& from, const dynamics::DynamicsCache& to,
                    Eigen::Ref<Eigen::VectorXd> dx) const override;
  void marks(std::vector<control::Mark>& marks) const override;

 private:
  void doUpdate(const control::Tick& tick, control::TickTask& rows) override;
  void doArchive(control::Archive& archive) override;

  int frame_;
  Eigen::Vector3d stiffness_, damping_, turn_stiffness_, turn_damping_;
  bool in_link_axes_;
  bool has_position_, has_orientation_;
  Eigen::Vector3d position_W_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d orientation_W_ = Eigen::Matrix3d::Identity();
};

}  // namespace tactus::tasks
