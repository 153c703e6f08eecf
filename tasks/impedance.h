#pragma once

#include <optional>

#include "framework/control/registry.h"

namespace tactus::tasks {

/// `impedance`: a Cartesian spring and damper on a link (thesis A.1.7–A.1.9, A.1.11).
///
/// Rows: the Jacobian J_e of the link and its `point` (6 × dof, linear rows first, world axes); F = K x_e + D (ẋ_r − ẋ)
/// with x_e = (p_r − p, Ψ), p the point, Ψ the rotation towards the reference in world axes.  Stiffness and damping are
/// given per axis of `axes`: the world, or the link itself.  Without `position` (`orientation`) that of the first tick,
/// and of the first one after a pause, is held.
///
/// The reference stands at its goal, ẋ_r = 0; with `speed` (m/s) its position, with `turn-speed` (rad/s) its orientation
/// goes there on the shortest way, from where the link is in the first tick, and in the first one after a pause.
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
  /// Moves the reference on by a tick; its velocity, linear first.
  dynamics::Vector6d moveReference(const control::Tick& tick);

  int frame_;
  Eigen::Vector3d point_E_;                                        ///< m, link axes
  Eigen::Vector3d stiffness_, damping_, turn_stiffness_, turn_damping_;
  bool in_link_axes_;
  bool has_position_, has_orientation_;
  double speed_, turn_speed_;                                      ///< m/s, rad/s; ∞: the reference stands at its goal
  Eigen::Vector3d position_W_ = Eigen::Vector3d::Zero();           ///< goal
  Eigen::Matrix3d orientation_W_ = Eigen::Matrix3d::Identity();
  Eigen::Vector3d reference_position_W_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d reference_orientation_W_ = Eigen::Matrix3d::Identity();
  std::optional<double> last_update_;                              ///< s
};

}  // namespace tactus::tasks
