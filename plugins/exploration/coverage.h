#pragma once

#include <limits>
#include <vector>

#include "framework/control/registry.h"
#include "framework/runtime/csv_writer.h"
#include "plugins/exploration/surface_samples.h"

namespace tactus::exploration {

/// The recorder `coverage`: how much of an object's surface has been touched.
///
/// Points of its surface are drawn evenly; those that a desired link could touch with its pad count (see Reach).  A point is
/// covered from the first time that a touched point lies within `radius` of it.  Figures:
///
/// | metric           | definition                                                                    |
/// |------------------|-------------------------------------------------------------------------------|
/// | coverage         | covered part of the points that can be reached                                |
/// | coverage_all     | covered part of all points                                                    |
/// | reachable        | part of all points that can be reached                                        |
/// | coverage_half_s  | time at which half of those that can be reached were covered; none before     |
///
/// Files: coverage.csv, `time` (s) and `coverage`, twice a second; surface.csv, the points, with `reachable` 0 or 1 and
/// `covered_at` (s, −1 for never).  Objects are taken where they stand at the start.
class Coverage final : public control::Observer {
 public:
  explicit Coverage(const control::RecorderContext& context);
  static void registerIn(control::Registry& registry);

  void observe(const control::ObservedTick& tick) override;
  void close() override;
  void metrics(std::vector<control::Metric>& metrics) const override;

 private:
  struct Point {
    SurfaceSample sample;
    bool reachable = true;
    double covered_at = -1;                                        ///< s
  };
  void sample();
  double covered() const;

  const control::TouchedPoints& touched_;
  description::Robot robot_;
  dynamics::Model model_;
  description::Scene scene_;
  Eigen::VectorXd start_q_;
  ReachOptions reach_;
  std::vector<int> objects_;                                       ///< of the scene
  int count_;
  bool sampled_ = false;
  double radius_;
  std::vector<Point> points_;                                      ///< from the first tick on
  std::size_t seen_ = 0;                                           ///< touched points that were looked at
  int reachable_ = 0, covered_reachable_ = 0, covered_all_ = 0;
  double half_time_ = std::numeric_limits<double>::quiet_NaN();
  double next_row_ = 0;
  std::string folder_;
  runtime::CsvWriter file_;
};

}  // namespace tactus::exploration
