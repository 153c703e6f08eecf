#pragma once

#include <vector>

#include "framework/control/registry.h"
#include "framework/runtime/contact_metrics.h"
#include "plugins/grasp/grasp_wrench_space.h"

namespace tactus::plugins {

/// The measure `grasp-quality`: how a hand holds an object at the end of a run.  Its figures, `<name>_…`:
///
/// | figure       | definition                                                                                   |
/// |--------------|----------------------------------------------------------------------------------------------|
/// | contacts     | mean number of links that touch the object (runtime::TouchSwitch on the sum of a link's forces) |
/// | force_mean_N | mean of the forces of such links                                                             |
/// | force_max_N  | mean over ticks of the largest                                                               |
/// | epsilon      | of the grasp wrench space, at the last tick; one contact a link, in the middle of its touches |
/// | volume       | of it                                                                                        |
///
/// The first three over the last `window` seconds.  Torques are about the object's centre (of mass where it has one,
/// else its origin), over the greatest distance of its surface from there, from bounding balls.
class GraspQualityMeasure final : public control::Measure {
 public:
  explicit GraspQualityMeasure(const control::MeasureContext& context);
  static void registerIn(control::Registry& registry);

  void columns(std::vector<control::LogColumn>& columns) const override;
  void metrics(std::vector<control::Metric>& metrics) const override;

 private:
  /// Of one link in this tick.
  struct Touch {
    double force_N = 0;
    Eigen::Vector3d moment = Eigen::Vector3d::Zero();              ///< Σ f p, N m, object frame
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();              ///< Σ f n, N, object frame
    runtime::TouchSwitch on;
    void archive(control::Archive& archive);
  };
  /// Of one tick of the window.
  struct Moment {
    double contacts = 0, force_sum_N = 0, force_max_N = 0;
    void archive(control::Archive& archive);
  };

  void doObserve(const control::ObservedTick& tick) override;
  void doArchive(control::Archive& archive) override;
  std::vector<GraspContact> contacts() const;

  int object_;
  Eigen::Isometry3d pose_;                                         // of the object, where it does not move
  GraspWrenchOptions options_;
  double period_;                                                  // s
  std::vector<Touch> touches_;                                     // of each link
  std::vector<Moment> window_;                                     // a ring, of the last ticks
  long ticks_ = 0;
  double contacts_now_ = 0;
};

}  // namespace tactus::plugins
