#pragma once

#include <vector>

#include "framework/control/registry.h"

namespace tactus::tasks {

/// `joint-limits`: keeps joints a margin away from their stops.
///
/// Where joint i is closer than `margin` to a limit: one inequality row J = ±e_iᵀ towards the limit, with own force
/// F = −k · depth − d · (speed towards the limit)₊, depth counted from the margin.  Lower levels may move the joint
/// away from its stop, not towards it.
class JointLimits final : public control::Task {
 public:
  explicit JointLimits(const control::BuildContext& context);
  static void registerIn(control::Registry& registry);

  bool displacement(const dynamics::DynamicsCache& from, const dynamics::DynamicsCache& to,
                    Eigen::Ref<Eigen::VectorXd> dx) const override;

 private:
  JointLimits(const control::BuildContext& context, std::vector<int> joints);
  void doUpdate(const control::Tick& tick, control::TickTask& rows) override;
  /// How deep joint i is inside its margin (≤ 0: not at all), and the sign of the limit that is nearer.
  struct Depth {
    double depth;
    double towards;
  };
  Depth depthOf(int i, double q) const;

  std::vector<int> joints_;
  double margin_, stiffness_, damping_;
  Eigen::VectorXd lower_, upper_;                                  ///< rad or m, dof
};

}  // namespace tactus::tasks
