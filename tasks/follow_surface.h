#pragma once

#include <optional>
#include <vector>

#include "framework/control/registry.h"

namespace tactus::tasks {

/// `follow-surface`: moves a hand along an unknown surface from key position to key position (thesis, appendix A.1).
///
/// Each tick, from the contacts alone:
/// 1. the median normal n_m, the normalised mean of the two most different contact normals (A.1.1), low-passed;
/// 2. the wanted orientation: the frame's `normal-axis` on n_m, its `forward-axis` on its own projection onto the
///    plane ⟂ n_m (A.1.2, A.1.3), leaned by `tilt` so that the forward end goes into the surface.  With `lean` the normal
///    axis stays as near to the first approach: fingers that hang over an edge feel only the side, and would draw the
///    hand over it to where the arm is at its stop;
/// 3. the wanted position p_r: towards the key p_f, within the plane ⟂ n_m, a step `reach` ahead, less when nearer
///    than `near` (A.1.4–A.1.6), and less the more a contact presses: by 1 − 3s² + 2s³, s the largest force, low-passed,
///    between `yield-from` and `yield-until`.  What is jammed is then not pushed on by the sweep;
/// 4. the wrench F = K x_e − D ẋ (A.1.7–A.1.11) with no stiffness along the normal, on the frame Jacobian J_e (6 rows,
///    linear first, world axes).  K and D stand in the frame of A.1.3, not in the hand's: the two differ by `tilt`,
///    and a hand that leans would be lifted or pressed by its own sweep.
/// Without contact the frame approaches along the last normal at `approach-speed`.
///
/// The forward axis may be held to a `heading`, to one a key, `headings`, or to that of the place that a signal names.  It
/// then runs no more than `turn-reach` ahead of the hand, and never through `turn-avoids`, where the arm may be at its stop:
/// the hand turns the other way round.  A key of the list with a heading of its own is not passed before the hand has turned
/// to within `turn-reach` of it.
///
/// The keys are a list, `along`, or come from a signal, `towards`, which then says when to go on.
/// A key of the list counts as passed when its tangential distance falls below `key-threshold` while in contact.  It is given up
/// when `stall-time` goes by without `stall-progress` towards it: a finger caught at an edge must not hold the sweep.
class FollowSurface final : public control::Task {
 public:
  explicit FollowSurface(const control::BuildContext& context);
  static void registerIn(control::Registry& registry);

  bool displacement(const dynamics::DynamicsCache& from, const dynamics::DynamicsCache& to,
                    Eigen::Ref<Eigen::VectorXd> dx) const override;
  void columns(std::vector<control::LogColumn>& columns) const override;
  void marks(std::vector<control::Mark>& marks) const override;
  void metrics(std::vector<control::Metric>& metrics) const override;

 private:
  void doUpdate(const control::Tick& tick, control::TickTask& rows) override;
  void doArchive(control::Archive& archive) override;
  void updateNormal(double dt);
  void updatePull(double dt);
  Eigen::Matrix3d wantedOrientation(const Eigen::Matrix3d& R_WH) const;
  Eigen::Vector3d wantedNormal() const;
  double turnFrom(const Eigen::Vector3d& from_W, const Eigen::Vector3d& to_W) const;
  double leftToTurn(const Eigen::Matrix3d& R_WH) const;
  void advanceKey(double time, double way);
  const Eigen::Vector3d& key() const;
  Eigen::Vector3d heading() const;

  const control::ContactSet& contacts_;
  const control::ContactSet& yield_contacts_;
  int frame_;
  const control::Place* towards_ = nullptr;                        ///< null: the keys
  std::vector<Eigen::Vector3d> keys_W_;
  Eigen::Matrix3d R_EH_;                                           ///< columns: normal axis, forward axis, their cross product
  double reach_, near_, key_threshold_, yield_filter_, normal_filter_, tilt_;
  double yield_from_ = description::infinity, yield_until_ = description::infinity;
  double stiffness_, damping_, damping_normal_, turn_stiffness_, yaw_stiffness_, turn_damping_;
  double approach_speed_, stall_time_, stall_progress_;
  bool has_heading_;
  Eigen::Vector3d heading_W_;
  std::vector<Eigen::Vector3d> headings_W_;                        ///< one a key, or none
  double turn_reach_ = description::infinity;
  std::optional<Eigen::Vector3d> turn_avoids_W_;
  Eigen::Vector3d approach_W_;
  double lean_ = description::infinity;

  Eigen::Vector3d normal_W_;                                       ///< n_m, filtered
  double pressed_ = 0;                                             ///< N, filtered
  double pull_ = 1;                                                ///< share of the reach that is left
  int key_index_ = 0;
  double nearest_ = 0;                                             ///< least tangential distance to the key so far, m
  double progress_time_ = 0;                                       ///< s, when it last fell by stall-progress
  bool key_started_ = false;
  double key_start_time_ = 0;                                      ///< s
  double keys_passed_ = 0, keys_given_up_ = 0, key_number_ = 0;
  double given_up_s_ = 0;                                          ///< spent on keys that were given up
  double last_key_time_ = 0;
  double distance_ = 0;
  Eigen::Vector3d key_W_ = Eigen::Vector3d::Zero(), reference_W_ = Eigen::Vector3d::Zero();  ///< p_f, p_r of this tick
};

}  // namespace tactus::tasks
