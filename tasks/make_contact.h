#pragma once

#include <optional>
#include <vector>

#include "framework/control/registry.h"

namespace tactus::tasks {

/// `make-contact`: brings links that should touch, but do not, to the surface felt by the others
/// (thesis 4.3.3–4.3.5, 4.4.1).
///
/// For each missing contact j, three rows J_d^j with F = K_d x_e + D_d ẋ_e, x_e = p_r − p.  The reference p_r starts
/// at p when the link becomes missing and moves with v = λ (n + u)/‖n + u‖, where n is the normal of the closest
/// contact and u the unit vector from p to its point (both unit vectors: as printed, 4.4.1 adds metres to one).
/// Where n and u cancel, v = λ n.  ‖x_e‖ is bounded: a blocked link must not wind its reference up.
/// Without any contact nobody knows where the surface is, and the task has no rows (C = ∅ in 4.3.1).
///
/// To grasp, the hand's own shape says where the object is (4.4.2): with `patch` and `opposing-patch`, the dominant links
/// of a grasp, v = λ d, d the unit vector from the middle of the one to that of the other; v = −λ d of `opposing` links,
/// those on the other one's side.  Then contacts are not needed.
class MakeContact final : public control::Task {
 public:
  explicit MakeContact(const control::BuildContext& context);
  static void registerIn(control::Registry& registry);

  bool displacement(const dynamics::DynamicsCache& from, const dynamics::DynamicsCache& to,
                    Eigen::Ref<Eigen::VectorXd> dx) const override;

 private:
  struct Reference {
    bool active = false;
    Eigen::Vector3d position_W = Eigen::Vector3d::Zero();
    void archive(control::Archive& archive) {
      archive("active", active);
      archive("position", position_W);
    }
  };

  void doUpdate(const control::Tick& tick, control::TickTask& rows) override;
  void doArchive(control::Archive& archive) override;
  struct Opposition {
    int patch = -1, other = -1;                                    ///< frames
    Eigen::Vector3d middle_P, middle_O;                            ///< of each, in its frame
    std::vector<bool> opposing;                                    ///< by frame
  };

  Eigen::Vector3d desiredVelocity(const control::Tick& tick, const control::MissingContact& missing) const;
  Eigen::Vector3d towardsSurface(const Eigen::Vector3d& point_W) const;

  const control::MissingSet& missing_;
  double stiffness_, damping_, speed_, bound_;
  std::optional<Opposition> opposition_;
  std::vector<Reference> references_;                              ///< by slot
  std::vector<char> seen_;                                         ///< by slot
};

}  // namespace tactus::tasks
