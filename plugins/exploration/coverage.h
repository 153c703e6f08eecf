#pragma once

#include <vector>

#include "framework/control/measure.h"
#include "framework/control/registry.h"
#include "plugins/exploration/surface_samples.h"

namespace tactus::exploration {

/// The measure `coverage`: how much of an object's surface has been touched.
///
/// Points of its surface are drawn evenly; those that a desired link could touch with its pad count (see Reach).  A point is
/// covered from the first time that a touched point lies within `radius` of it.  Figures, `<name>_…`:
///
/// | figure           | definition                                                                         |
/// |------------------|------------------------------------------------------------------------------------|
/// | covered          | covered part of the points that can be reached                                     |
/// | covered_upward   | the same of those whose outward normal is within 45° of the vertical               |
/// | covered_sideward | and of the others                                                                  |
/// | covered_all      | covered part of all points                                                         |
/// | reachable        | part of all points that can be reached                                             |
/// | half_covered_s   | time at which half of those that can be reached were covered                       |
///
/// NaN of what there is none of.  Column: `covered`.  Objects are taken where they stand at the start.
class Coverage final : public control::Measure {
 public:
  explicit Coverage(const control::MeasureContext& context);
  static void registerIn(control::Registry& registry);

  void columns(std::vector<control::LogColumn>& columns) const override;
  void metrics(std::vector<control::Metric>& metrics) const override;

 private:
  struct Point {
    SurfaceSample sample;
    bool reachable = true;
    bool covered = false;
    bool upward() const;
  };
  void doObserve(const control::ObservedTick& tick) override;
  void doArchive(control::Archive& archive) override;
  /// Covered part of the points of which `counts` is true.
  template <class Predicate>
  double covered(Predicate counts) const;

  const control::TouchedPoints& touched_;
  double radius_;
  std::vector<Point> points_;
  int reachable_ = 0;                                              ///< of them
  std::size_t seen_ = 0;                                           ///< touched points that were looked at
  double covered_;                                                 ///< of what can be reached
  double half_covered_s_;
};

}  // namespace tactus::exploration
