#include "plugins/exploration/coverage.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tactus::exploration {

using namespace control;

namespace {
constexpr double none = std::numeric_limits<double>::quiet_NaN();
}

void Coverage::registerIn(Registry& registry) {
  ElementRow row;
  row.name = "coverage";
  row.description = "How much of an object's surface has been touched, of what the robot can reach.";
  row.source = "thesis 4.4.1 (coverage of the reconstruction)";
  row.attributes = {
      {.name = "of", .type = ValueType::object, .description = "The object; not given: each of the scene that has ends."},
      {.name = "from", .type = ValueType::port, .required = true, .description = "Touched points, e.g. touch.points.",
       .port_type = "touched-points"},
      {.name = "radius", .type = ValueType::real, .unit = "m", .default_text = "0.01",
       .description = "A point of the surface is covered when a touched one is as near as this.", .lower = 0,
       .lower_open = true},
      {.name = "samples", .type = ValueType::integer, .default_text = "1000",
       .description = "Points of an object's surface, drawn evenly.", .lower = 1, .upper = 100000},
      {.name = "links", .type = ValueType::links, .required = true,
       .description = "What one of these links can reach with its pad, by inverse kinematics, counts as reachable."},
      {.name = "pad-axis", .type = ValueType::reals, .unit = "1", .default_text = "1 0 0",
       .description = "Axis of these links that faces what they touch.", .count = 3},
      {.name = "clear", .type = ValueType::links, .default_text = "none",
       .description = "Links that must touch nothing while one of the others is there.", .choices = {"none"}},
  };
  registry.addMeasure(row, [](const MeasureContext& context) { return std::make_unique<Coverage>(context); });
}

bool Coverage::Point::upward() const { return sample.normal_W.z() >= std::sqrt(0.5); }

Coverage::Coverage(const MeasureContext& context)
    : touched_(context.port<TouchedPoints>("from")), radius_(context.values.real("radius")), half_covered_s_(none) {
  ReachOptions options;
  options.links = context.frames("links");
  options.clear = context.frames("clear");
  const Eigen::Vector3d axis = context.values.vector3("pad-axis");
  if (axis.norm() < 1e-9) throw ElementError("pad-axis", "pad-axis must not be a zero vector");
  options.pad_axis = axis.normalized();
  Reach reach(context.robot, context.scene, context.model, context.start_q, options);
  const int count = context.values.integer("samples");
  for (int i = 0; i < static_cast<int>(context.scene.objects.size()); ++i) {
    const description::Object& object = context.scene.objects[static_cast<std::size_t>(i)];
    if (context.values.has("of") && object.name != context.values.text("of")) continue;
    for (const SurfaceSample& sample : sampleSurface(context.scene, i, count)) points_.push_back({sample, reach(sample)});
  }
  reachable_ = static_cast<int>(std::count_if(points_.begin(), points_.end(), [](const Point& p) { return p.reachable; }));
  covered_ = reachable_ > 0 ? 0 : none;
}

void Coverage::doObserve(const ObservedTick& tick) {
  if (seen_ == touched_.points.size()) return;
  for (; seen_ < touched_.points.size(); ++seen_) {
    const Eigen::Vector3d& touched_W = touched_.points[seen_].point_W;
    for (Point& point : points_) {
      if (!point.covered && (point.sample.point_W - touched_W).squaredNorm() <= radius_ * radius_) point.covered = true;
    }
  }
  covered_ = covered([](const Point& point) { return point.reachable; });
  if (std::isnan(half_covered_s_) && covered_ >= 0.5) half_covered_s_ = tick.truth.time;
}

template <class Predicate>
double Coverage::covered(Predicate counts) const {
  int all = 0, met = 0;
  for (const Point& point : points_) {
    if (!counts(point)) continue;
    ++all;
    met += point.covered;
  }
  return all > 0 ? static_cast<double>(met) / all : none;
}

void Coverage::doArchive(Archive& archive) {
  std::vector<bool> covered_points;
  for (const Point& point : points_) covered_points.push_back(point.covered);
  archive("covered-points", covered_points);
  for (std::size_t i = 0; i < points_.size(); ++i) points_[i].covered = covered_points[i];
  archive("seen", seen_);
  archive("covered", covered_);
  archive("half-covered", half_covered_s_);
}

void Coverage::columns(std::vector<LogColumn>& columns) const { columns.push_back({"covered", &covered_}); }

void Coverage::metrics(std::vector<Metric>& metrics) const {
  metrics.push_back({"covered", covered_});
  metrics.push_back({"covered_upward", covered([](const Point& point) { return point.reachable && point.upward(); })});
  metrics.push_back({"covered_sideward", covered([](const Point& point) { return point.reachable && !point.upward(); })});
  metrics.push_back({"covered_all", covered([](const Point&) { return true; })});
  metrics.push_back({"reachable", points_.empty() ? none : static_cast<double>(reachable_) / static_cast<double>(points_.size())});
  metrics.push_back({"half_covered_s", half_covered_s_});
}

}  // namespace tactus::exploration
