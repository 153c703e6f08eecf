#pragma once

#include <vector>

#include "framework/control/contact_set.h"
#include "framework/control/registry.h"

namespace tactus::plugins {

/// The controller `enclose`: closes fingers round something by positions, the thesis's two heuristics (4.4.2).
///
/// Each joint goes at `speed` from where it is at first to its place in `to`, and stops for good when a link that it
/// moves touches something with `threshold` or more.  Joints of which one carries the other are one finger.
///   order="successive"  Enclose1: a joint waits until those before it in its finger have stopped or arrived.
///   order="together"    Enclose2: all of them at once.
/// The level has one task, `close`: a row a joint, F = k (q_r − q) + d (q̇_r − q̇).
class Enclose final : public control::LevelController {
 public:
  static void registerIn(control::Registry& registry);

  void columns(std::vector<control::LogColumn>& columns) const override;

 private:
  class Springs;

  /// One joint on its way.
  struct Way {
    int joint = 0;
    double to = 0;                                                 ///< rad
    std::vector<int> before;                                       ///< places in ways_ of the joints that carry it
    double reference = 0;                                          ///< q_r, rad
    double speed = 0;                                              ///< q̇_r, rad/s
    bool stopped = false;                                          ///< or arrived
    void archive(control::Archive& archive);
  };

  explicit Enclose(const control::BuildContext& context);
  void doUpdate(const control::Tick& tick) override;
  void doArchive(control::Archive& archive) override;
  bool touchesBeyond(const control::Tick& tick, int joint) const;

  const control::ContactSet& contacts_;
  std::vector<Way> ways_;
  bool successive_;
  double speed_, threshold_;
  bool started_ = false;
  double stopped_ = 0;                                             // joints, for the log
};

}  // namespace tactus::plugins
