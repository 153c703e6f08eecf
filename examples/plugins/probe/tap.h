#pragma once

#include <vector>

#include "framework/control/registry.h"

namespace probe {

/// `<probe.tap>`: taps with one joint after the other, and owns its level while it does.
///
/// Each joint has a task of its own, one equality row that swings it from where it was at first by `by` and back,
/// F = k (q_r − q) − d q̇, q_r a raised cosine of the time within its turn.  Only the joint whose turn it is takes part.
/// When `felt` passes `stop-at` it goes back the way that it came.  The joints of `hold` are kept by a built-in
/// `<posture>` all the time.
class Tap final : public tactus::control::LevelController {
 public:
  static void registerIn(tactus::control::Registry& registry);

  void columns(std::vector<tactus::control::LogColumn>& columns) const override;
  void metrics(std::vector<tactus::control::Metric>& metrics) const override;

 private:
  explicit Tap(const tactus::control::BuildContext& context);
  void doUpdate(const tactus::control::Tick& tick) override;
  void doArchive(tactus::control::Archive& archive) override;

  std::vector<double> active_;                                     // by joint: 1 while it is its turn
  double period_;                                                  // s, of a turn
  const double* felt_ = nullptr;                                   // N
  double stop_at_;                                                 // N
  double phase_ = 0;                                               // s, in this turn
  size_t turn_ = 0;
  double turn_column_ = 0;                                         // turn_, for the log
  int touches_ = 0;
};

}  // namespace probe
