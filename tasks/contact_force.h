#pragma once

#include <limits>
#include <optional>
#include <vector>

#include "framework/control/registry.h"
#include "tasks/force_excess.h"

namespace tactus::tasks {

/// `contact-force`: keeps a light normal force at every contact of a set (thesis 4.3.2).
///
/// One row a contact, J = nᵀJ_c with n out of the robot, equality: lower levels may not disturb it.
/// With `friction` μ there are three rows a contact, n, t₁ and t₂: the contact does not slide either, and back ends with
/// friction cones keep its force inside of ‖(f_t1, f_t2)‖ ≤ μ f_n.  t₁ = n × x̂ normalised (n × ŷ where |n_x| ≥ 0.9),
/// t₂ = n × t₁, axes of the world; their reference is 0.
/// The reference is f_n, less a one-sided feedback where the measured force f is too high:
///   F = max(f_n − k_f · LP(f − f_t)₊, F_min),  LP a first-order filter, f_t the threshold.
/// It frees a finger that is jammed between an edge and its own stop, which the open-loop law keeps pressing.
class ContactForce final : public control::Task {
 public:
  explicit ContactForce(const control::BuildContext& context);
  static void registerIn(control::Registry& registry);

  bool displacement(const dynamics::DynamicsCache& from, const dynamics::DynamicsCache& to,
                    Eigen::Ref<Eigen::VectorXd> dx) const override;
  void columns(std::vector<control::LogColumn>& columns) const override;

 private:
  void doUpdate(const control::Tick& tick, control::TickTask& rows) override;
  void doArchive(control::Archive& archive) override;

  int rowsPerContact() const { return friction_ ? 3 : 1; }

  const control::ContactSet& contacts_;
  std::optional<double> friction_;                                 ///< μ
  double force_, feedback_, min_force_;
  double force_max_ = std::numeric_limits<double>::infinity();
  ForceExcess excess_;                                             ///< over f_t
  double lowest_reference_ = 0;
};

}  // namespace tactus::tasks
