#pragma once

#include <cstdint>
#include <vector>

#include "framework/control/registry.h"
#include "framework/geometry/compound.h"
#include "framework/runtime/contact_metrics.h"
#include "plugins/posture-search/posture_search.h"

namespace tactus::plugins {

/// The measure `contact-optimum`: how many links touch the scene at the end of a run, and how many could (thesis 4.4.2,
/// experiment 4, whose optimum is found by moving the finger by hand).  Its figures, `<name>_…`:
///
/// | figure  | definition                                                                                      |
/// |---------|-------------------------------------------------------------------------------------------------|
/// | reached | links that touch with the side that feels (runtime::TouchSwitch on the sum of such forces) in more |
/// |         | than half of the ticks of the last `window` seconds                                             |
/// | optimum | the most that any posture allows (PostureSearch), the other joints and all objects as they are then |
/// | missed  | optimum − reached; below 0 where things give way                                                |
/// | q_JOINT | rad, of each joint that is searched: a posture with that optimum                                |
class ContactOptimum final : public control::Measure {
 public:
  explicit ContactOptimum(const control::MeasureContext& context);
  static void registerIn(control::Registry& registry);

  void columns(std::vector<control::LogColumn>& columns) const override;
  void metrics(std::vector<control::Metric>& metrics) const override;

 private:
  /// Of one link that should touch.
  struct Touch {
    double force_N = 0;                                            ///< with the side that feels, in this tick
    runtime::TouchSwitch on;
    void archive(control::Archive& archive);
  };

  void doObserve(const control::ObservedTick& tick) override;
  void doArchive(control::Archive& archive) override;
  int reached() const;
  geometry::Compound world() const;

  description::Robot robot_;
  const description::Scene& scene_;
  dynamics::Model model_;
  dynamics::Workspace workspace_;
  PostureSearchOptions options_;
  double period_;                                                  // s
  std::vector<Touch> touches_;                                     // of each of options_.links
  std::vector<std::uint32_t> window_;                              // a ring, of the last ticks: a bit a link
  std::vector<Eigen::Isometry3d> objects_;                         // their poses in the last tick
  Eigen::VectorXd q_;                                              // in the last tick
  long ticks_ = 0;
  double touching_now_ = 0;
  mutable long searched_at_ = -1;                                  // ticks_ when optimum_ was found
  mutable PostureFound optimum_;
};

}  // namespace tactus::plugins
