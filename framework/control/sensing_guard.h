#pragma once

#include <vector>

#include "framework/control/archive.h"
#include "framework/control/sensed.h"
#include "framework/dynamics/model.h"

namespace tactus::control {

/// What was wrong with what a tick sensed.
struct SensingRecord {
  int joints_held = 0;                                             ///< coordinates q̇ whose last good values stand in
  int contacts_ignored = 0;
  bool blind = false;                                              ///< some joint is unknown for longer than `hold`
};

/// Stands between the plant and the controller: nothing passes that is not a number.
///
/// Joints are counted by their coordinates q̇; those of a ball or a floating base are lost together.
///
/// - A joint whose q or q̇ is not finite, or beyond 1e6 (rad, m, per s), is *lost*: its last good q and q̇ stand in.
///   Where q or q̇ has the wrong size, all joints are.  Once a joint has been lost for longer than `hold` seconds, or
///   was never sensed, the controller is blind: its state is then q as last known, and q̇ = 0.
/// - A contact whose point, normal or force is not finite or beyond 1e6, or whose link the robot does not have, is
///   ignored.  A patch of skin that falls silent cannot be told from one that touches nothing.
/// - A time that is not finite, or falls behind, is taken as one period after the last one.
///
/// Takes no memory in a tick of up to `contact_capacity` contacts.
class SensingGuard {
 public:
  static constexpr int contact_capacity = 1024;

  SensingGuard(const dynamics::Model& model, int links, double hold, double period);
  /// `dof` joints with one coordinate each.
  SensingGuard(int dof, int links, double hold, double period);

  /// `raw` itself where nothing is wrong with it, else what may be used of it; valid until the next call.
  const Sensed& check(const Sensed& raw);
  const SensingRecord& record() const { return record_; }
  bool isLost(int joint) const { return lost_[static_cast<std::size_t>(joint)].now; }
  /// False while some joint has never been sensed.
  bool knowsState() const { return never_sensed_ == 0; }
  /// Links of the contacts that this tick ignored; −1 for one that is no link.
  const std::vector<int>& ignoredLinks() const { return ignored_links_; }
  void archive(Archive& archive);

 private:
  struct Joint {
    int position, position_count;                                  // into q, of the joint that the coordinate belongs to
    int coordinate, coordinate_count;                              // into q̇
    bool now = false;
    bool ever_good = false;
    double lost_for = 0;                                           // s
  };
  bool checkJoints(const Sensed& raw);
  bool checkContacts(const Sensed& raw);
  bool isUsable(const ContactRecord& contact) const;

  int links_;
  double hold_;
  double period_;
  std::vector<Joint> lost_;
  int never_sensed_;
  bool has_time_ = false;
  Sensed known_;                                                   // last good values, answered where some are wrong
  std::vector<int> ignored_links_;
  SensingRecord record_;
};

}  // namespace tactus::control
