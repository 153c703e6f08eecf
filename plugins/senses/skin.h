#pragma once

#include <optional>

#include "framework/control/registry.h"
#include "framework/dynamics/kinematics.h"
#include "framework/geometry/compound.h"
#include "plugins/senses/sampler.h"
#include "plugins/senses/taxel_patch.h"
#include "plugins/senses/taxel_response.h"

namespace tactus::plugins {

/// The sensor `<skin>`: patches of taxels on links, and the contacts that are read out of them.
///
///   truth.contacts ─ TaxelPatch::press ─ TaxelResponse ─ Sampler ─ TaxelPatch::read ─▶ felt.contacts
///
/// Contacts press the taxels where the true joints have the links.  What is read, in link axes, is put into the world
/// where the *felt* joints have them, as a robot would: `<encoders>` stand before the skin in the stack.  In `felt` the
/// true contacts of all its links vanish, what presses beside the taxels too; those that are read follow after all
/// others, link by link in the order of the robot.  Of them the robot knows no object (−1), no depth and no friction.
/// Contacts that another skin read stay: a link may have several patches.  With `perfect` the true contacts stay as
/// they are.
///
/// Where the robot touches itself, taxels of both links are pressed, which cannot tell by what.  A contact that the
/// felt joints put within `self-margin` of a link that may touch its own is told as one with that link, the nearest:
/// what lies between two links that nearly touch is taken for one of them.
///
/// Ports: `force`, the sum of all taxels; `active`, how many are above 0; `taxels`, all of them, link by link.
class Skin final : public control::Sensor {
 public:
  explicit Skin(const control::SensorContext& context);
  static void registerIn(control::Registry& registry);

  int count(const control::PortRow& port) const override;

 private:
  struct Patch {
    int link;
    int first;                                                     // of its taxels, among all
    TaxelPatch taxels;
  };

  void doSense(const control::Sensed& truth, control::Sensed& felt, Eigen::Ref<Eigen::VectorXd> readings) override;
  void doArchive(control::Archive& archive) override;
  void press(const control::Sensed& truth);
  void read();
  void pressOn(int link, const control::ContactRecord& contact);
  void replaceContacts(control::Sensed& felt);
  /// The link that touches `link` at this place, −1 = none; joints as in workspace_.
  int touchedAt(int link, const Eigen::Vector3d& point_W) const;
  /// Index into patches_, −1 = none.
  int patchOf(int link) const;

  dynamics::Model model_;
  dynamics::Workspace workspace_;
  std::vector<Patch> patches_;
  std::vector<int> patch_of_;                                      // by link, −1 = none
  std::optional<TaxelResponse> response_;                          // of all taxels
  std::optional<Sampler> sampler_;
  Eigen::VectorXd pressed_N_;
  struct LinkContact {
    int link;
    TaxelContact contact;
    void archive(control::Archive& archive) {
      archive("link", link);
      archive("position", contact.place.position_L);
      archive("normal", contact.place.normal_L);
      archive("force", contact.force_N);
    }
  };
  std::vector<LinkContact> contacts_;                              // read last
  std::vector<TaxelContact> read_;
  struct Solid {
    int link;
    geometry::PosedShape shape;                                    // link frame
  };
  std::vector<std::vector<Solid>> near_;                           // by link: of those that may touch it
  double self_margin_;
  double count_per_N_;                                             // of what `taxels` tells
  int min_taxels_;
  double min_force_;
  bool perfect_;
};

}  // namespace tactus::plugins
