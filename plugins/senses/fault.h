#pragma once

#include <vector>

#include "framework/control/registry.h"
#include "framework/dynamics/kinematics.h"

namespace tactus::plugins {

/// The sensor `<fault>`: from one time until another, what the sensors before it tell goes wrong.  It strikes contacts
/// of `links`, q and q̇ of `joints`, and all readings of the sensors named by `of`:
///
/// | kind      | contacts of `links`                    | `joints`                         | readings of `of`     |
/// |-----------|----------------------------------------|----------------------------------|----------------------|
/// | `dropped` | vanish                                 | –                                | 0                    |
/// | `stuck`   | stay as felt last, fixed to their link | q̂ stays as felt last, q̇ is 0   | stay as felt last    |
/// | `nan`     | point, normal and force are NaN        | q and q̇ are NaN                 | NaN                  |
/// | `jump`    | –                                      | `offset` is added to q           | –                    |
/// | `late`    | everything felt is what was felt `delay` seconds ago: contacts, joints, all readings before it   |
///
/// What was felt last is what was felt in the tick before `from`; in the first tick, what is felt then.  What is `late`
/// has at first what was felt at the start.  From `until` on all is as the sensors tell it again.
///
/// What becomes of it: docs/senses.md.  Port: `active`, 1 while it strikes.
class Fault final : public control::Sensor {
 public:
  explicit Fault(const control::SensorContext& context);
  static void registerIn(control::Registry& registry);
  const control::Sensor::Fault* fault() const override { return &told_; }

 private:
  enum class Kind { dropped, stuck, nan, jump, late };
  struct Reach {                                                   // readings of a sensor before this one
    Eigen::Index first, count;
  };
  struct Held {                                                    // a contact on its link, that felt last
    control::ContactRecord record;
    Eigen::Vector3d point_L, normal_L;
    void archive(control::Archive& archive) {
      archive("record", record);
      archive("point", point_L);
      archive("normal", normal_L);
    }
  };

  void doSense(const control::Sensed& truth, control::Sensed& felt, Eigen::Ref<Eigen::VectorXd> readings) override;
  void doArchive(control::Archive& archive) override;
  bool strikes(const control::ContactRecord& contact) const;
  void remember(const control::Sensed& felt);
  void drop(control::Sensed& felt) const;
  void stick(control::Sensed& felt);
  void loseNumbers(control::Sensed& felt) const;
  void jump(control::Sensed& felt) const;
  void tellLate(control::Sensed& felt);

  Kind kind_;
  control::Sensor::Fault told_;
  double from_, until_, offset_;                                   // s, s, rad or m
  double tolerance_;                                               // s
  std::vector<bool> links_;
  std::vector<int> joints_;
  std::vector<Reach> reaches_;
  bool started_ = false;

  dynamics::Model model_;                                          // of what is stuck
  dynamics::Workspace workspace_;
  std::vector<Held> held_;
  Eigen::VectorXd held_q_, held_readings_;

  std::vector<control::Sensed> past_;                              // of what is late: a ring, one entry a tick
  std::size_t ticks_ = 0;
};

}  // namespace tactus::plugins
