#pragma once

#include <vector>

#include "framework/control/registry.h"

namespace tactus::tasks {

/// `posture`: a spring and damper on joints, F = k (q_r − q) + d (q̇_r − q̇), one equality row J = e_iᵀ a joint.
///
/// With joints="free" it acts on the set K of 4.3.1: joints whose kinematic chains (from the base through the joint
/// to a fingertip) carry no contact and no desired contact, and all joints once nothing has been touched for `delay`.
/// `among` narrows that to some joints.  The reference q_r stands at q_0, which is `q`, else the configuration of the first
/// tick, or swings about it: q_r = q_0 + a sin 2πft, a `swing`, f `swing-rate`.  Fingers that swing to the side meet what
/// lies between the lines that they would draw otherwise.
class Posture final : public control::Task {
 public:
  explicit Posture(const control::BuildContext& context);
  static void registerIn(control::Registry& registry);

  bool displacement(const dynamics::DynamicsCache& from, const dynamics::DynamicsCache& to,
                    Eigen::Ref<Eigen::VectorXd> dx) const override;

 private:
  Posture(const control::BuildContext& context, std::vector<int> joints);
  void doUpdate(const control::Tick& tick, control::TickTask& rows) override;
  void doArchive(control::Archive& archive) override;
  bool isFree(int index) const;

  std::vector<int> joints_;
  Eigen::VectorXd stiffness_, damping_;                            ///< by position in joints_
  Eigen::VectorXd swing_;                                          ///< a, rad, by position in joints_
  double swing_frequency_;                                         ///< 2πf, rad/s
  Eigen::VectorXd reference_;                                      ///< q_0, by position in joints_
  bool has_reference_ = false;
  // For joints="free" only:
  const control::ContactSet* contacts_ = nullptr;
  double delay_ = 0;
  double last_touch_ = 0;
  bool touched_ = false;
  std::vector<std::vector<int>> chain_frames_;                     ///< frames on a chain through joints_[k]
  std::vector<char> carries_desired_;                              ///< by position in joints_
  std::vector<char> in_contact_;                                   ///< by frame, this tick
};

}  // namespace tactus::tasks
