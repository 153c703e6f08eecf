#include "plugins/exploration/coverage.h"

#include <algorithm>
#include <cmath>

namespace tactus::exploration {

using namespace control;

namespace {
constexpr double row_interval = 0.5;                               // s
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
  registry.addRecorder(row, [](const RecorderContext& context) { return std::make_unique<Coverage>(context); });
}

Coverage::Coverage(const RecorderContext& context)
    : touched_(context.port<TouchedPoints>("from")),
      robot_(context.robot),
      model_(robot_),
      scene_(context.scene),
      start_q_(context.start_q),
      count_(context.values.integer("samples")),
      radius_(context.values.real("radius")),
      folder_(context.folder),
      file_(folder_ + "/coverage.csv", {"time", "coverage"}) {
  for (int i = 0; i < static_cast<int>(scene_.objects.size()); ++i)
    if (!context.values.has("of") || scene_.objects[static_cast<std::size_t>(i)].name == context.values.text("of"))
      objects_.push_back(i);
  reach_.links = context.frames("links");
  reach_.clear = context.frames("clear");
  const Eigen::Vector3d axis = context.values.vector3("pad-axis");
  if (axis.norm() < 1e-9) throw ElementError("pad-axis", "pad-axis must not be a zero vector");
  reach_.pad_axis = axis.normalized();
}

void Coverage::sample() {
  Reach reach(robot_, scene_, model_, start_q_, reach_);
  sampled_ = true;
  for (int object : objects_)
    for (const SurfaceSample& sample : sampleSurface(scene_, object, count_)) {
      points_.push_back({sample, reach(sample)});
      reachable_ += points_.back().reachable;
    }
}

double Coverage::covered() const {
  return reachable_ > 0 ? static_cast<double>(covered_reachable_) / reachable_ : std::numeric_limits<double>::quiet_NaN();
}

void Coverage::observe(const ObservedTick& tick) {
  const double time = tick.truth.time;
  if (!sampled_) sample();
  for (; seen_ < touched_.points.size(); ++seen_) {
    const Eigen::Vector3d& touched_W = touched_.points[seen_].point_W;
    for (Point& point : points_) {
      if (point.covered_at >= 0 || (point.sample.point_W - touched_W).squaredNorm() > radius_ * radius_) continue;
      point.covered_at = touched_.points[seen_].time;
      ++covered_all_;
      covered_reachable_ += point.reachable;
    }
  }
  if (std::isnan(half_time_) && covered() >= 0.5) half_time_ = time;
  if (time < next_row_ - 1e-9) return;
  next_row_ = time + row_interval;
  file_ << time << (reachable_ > 0 ? covered() : 0);
  file_.endRow();
}

void Coverage::close() {
  file_.close();
  runtime::CsvWriter surface(folder_ + "/surface.csv",
                             {"x", "y", "z", "normal_x", "normal_y", "normal_z", "reachable", "covered_at"});
  for (const Point& point : points_) {
    for (const Eigen::Vector3d* v : {&point.sample.point_W, &point.sample.normal_W})
      for (int i = 0; i < 3; ++i) surface << (*v)[i];
    surface << (point.reachable ? 1.0 : 0.0) << point.covered_at;
    surface.endRow();
  }
  surface.close();
}

void Coverage::metrics(std::vector<Metric>& metrics) const {
  const double all = std::max<double>(1, static_cast<double>(points_.size()));
  metrics.push_back({"coverage", covered()});
  metrics.push_back({"coverage_all", covered_all_ / all});
  metrics.push_back({"reachable", reachable_ / all});
  metrics.push_back({"coverage_half_s", half_time_});
}

}  // namespace tactus::exploration
