#include "framework/control/contact_set.h"

namespace tactus::control {

// There may be many: a list for each member, not for each point.
void archive(Archive& archive, TouchedPoints& touched) {
  std::vector<double> times, forces;
  std::vector<int> frames;
  std::vector<Eigen::Vector3d> points, normals;
  for (const TouchedPoint& point : touched.points) {
    times.push_back(point.time);
    frames.push_back(point.frame);
    points.push_back(point.point_W);
    normals.push_back(point.normal_W);
    forces.push_back(point.force_N);
  }
  archive.growing("time", times);
  for (auto* each : {&points, &normals}) each->resize(times.size());
  frames.resize(times.size());
  forces.resize(times.size());
  archive("frame", frames);
  archive("point", points);
  archive("normal", normals);
  archive("force", forces);
  touched.points.resize(times.size());
  for (std::size_t i = 0; i < times.size(); ++i)
    touched.points[i] = {times[i], frames[i], points[i], normals[i], forces[i]};
}

void archive(Archive& archive, FeatureEstimate& estimate) {
  archive("found", estimate.found);
  archive("position", estimate.position_W);
  archive("height", estimate.height);
  archive("points", estimate.points);
}

void archive(Archive& archive, Place& place) {
  archive("known", place.known);
  archive("number", place.number);
  archive("position", place.position_W);
}

}  // namespace tactus::control
