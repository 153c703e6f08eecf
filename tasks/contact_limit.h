#pragma once

#include "framework/control/registry.h"
#include "tasks/force_excess.h"

namespace tactus::tasks {

/// `contact-limit`: a contact that nobody wants may break but must not be pressed harder (thesis 4.2.9).
///
/// One inequality row a contact, J = nᵀJ_c.  Without `max-force` its own force is 0.  With it, a one-sided feedback
/// backs off while the measured force f exceeds f_max: F = max(−k_f · LP(f − f_max)₊, −F_limit); the thesis promises
/// bounded undesired forces, its equations alone do not give them.
class ContactLimit final : public control::Task {
 public:
  explicit ContactLimit(const control::BuildContext& context);
  static void registerIn(control::Registry& registry);

  bool displacement(const dynamics::DynamicsCache& from, const dynamics::DynamicsCache& to,
                    Eigen::Ref<Eigen::VectorXd> dx) const override;

 private:
  void doUpdate(const control::Tick& tick, control::TickTask& rows) override;
  void doArchive(control::Archive& archive) override;

  const control::ContactSet& contacts_;
  double feedback_, back_off_limit_;
  ForceExcess excess_;                                             ///< over f_max
};

}  // namespace tactus::tasks
