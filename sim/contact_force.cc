#include "sim/contact_force.h"

#include <algorithm>
#include <cmath>

namespace tactus::sim {
namespace {

/// 1 for x ≤ 0, 0 for x ≥ 1, with zero slope at both.
double smoothFall(double x) {
  const double s = std::clamp(x, 0.0, 1.0);
  return 1 - s * s * (3 - 2 * s);
}

/// The t in (0, 1) that makes 4t(1−t) δ(t)² greatest, δ(t) = r − d(a + t (b − a)) concave, and the distance there.
/// A stationary point solves F(t) = (1−2t) δ + 2t(1−t) δ' = 0, where F falls through zero; false position
/// (Illinois) between points that touch, bisection towards the touching part otherwise.  False: nothing touches.
bool findInteriorPoint(const geometry::Shape& shape, const Eigen::Vector3d& a, const Eigen::Vector3d& b, double radius,
                       double depth_a, double depth_b, double& t, geometry::SignedDistance& nearest) {
  constexpr int max_iterations = 60;
  constexpr double t_tolerance = 1e-9;
  const Eigen::Vector3d axis = b - a;
  double low = 0, high = 1;
  double F_low = std::max(depth_a, 0.0), F_high = std::min(-depth_b, 0.0);  // zero: not known, bisect
  int last_side = 0;
  for (int i = 0; i < max_iterations; ++i) {
    t = F_low > 0 && F_high < 0 ? (low * F_high - high * F_low) / (F_high - F_low) : 0.5 * (low + high);
    nearest = shape.distance(a + t * axis);
    const double depth = radius - nearest.distance;
    const double slope = -nearest.gradient.dot(axis);
    if (depth <= 0) {
      const double end = slope > 0 ? high : low;
      if (depth + slope * (end - t) <= 0) return false;            // concave: the tangent bounds δ from above
      (slope > 0 ? low : high) = t;
      (slope > 0 ? F_low : F_high) = 0;
      last_side = 0;
    } else {
      const double F = (1 - 2 * t) * depth + 2 * t * (1 - t) * slope;
      if (F > 0) {
        low = t;
        F_low = F;
        if (last_side > 0) F_high *= 0.5;
        last_side = 1;
      } else if (F < 0) {
        high = t;
        F_high = F;
        if (last_side < 0) F_low *= 0.5;
        last_side = -1;
      } else {
        return true;
      }
      if (std::abs(F) < t_tolerance * depth) return true;
    }
    if (high - low < t_tolerance) return depth > 0;
  }
  return radius - nearest.distance > 0;
}

constexpr int most_maxima = 3;

/// Maxima of f(t) = 4t(1−t) δ(t)², δ > 0, the greatest first.
struct Maxima {
  int count = 0;
  double t[most_maxima];
  double prominence[most_maxima];                                  // 1 of the greatest; 0 where one is about to vanish
};

void findMaxima(const geometry::Shape& shape, const Eigen::Vector3d& a, const Eigen::Vector3d& b, double radius,
                Maxima& maxima) {
  constexpr int samples = 17;
  const Eigen::Vector3d axis = b - a;
  double f[samples];
  for (int i = 0; i < samples; ++i) {
    const double t = static_cast<double>(i) / (samples - 1);
    const double depth = std::max(0.0, radius - shape.distance(a + t * axis).distance);
    f[i] = 4 * t * (1 - t) * depth * depth;
  }
  struct Peak {
    int at;
    double height;
  };
  Peak peaks[samples / 2];
  int count = 0;
  for (int i = 1; i + 1 < samples; ++i)
    if (f[i] > 0 && f[i] > f[i - 1] && f[i] >= f[i + 1]) peaks[count++] = {i, f[i]};
  std::sort(peaks, peaks + count, [](const Peak& one, const Peak& other) {
    return one.height > other.height || (one.height == other.height && one.at < other.at);
  });
  count = std::min(count, most_maxima);
  for (int k = 0; k < count; ++k) {
    // The derivative of f over 4 δ falls through zero between the neighbours.
    double low = static_cast<double>(peaks[k].at - 1) / (samples - 1), high = low + 2.0 / (samples - 1);
    for (int i = 0; i < 40 && high - low > 1e-9; ++i) {
      const double t = 0.5 * (low + high);
      const geometry::SignedDistance nearest = shape.distance(a + t * axis);
      const double depth = radius - nearest.distance, slope = -nearest.gradient.dot(axis);
      const double F = depth > 0 ? (1 - 2 * t) * depth + 2 * t * (1 - t) * slope : slope;
      (F > 0 ? low : high) = t;
    }
    maxima.t[k] = 0.5 * (low + high);
    maxima.prominence[k] = 1;
    for (int j = 0; j < k; ++j) {
      double saddle = peaks[k].height;
      for (int i = std::min(peaks[j].at, peaks[k].at); i <= std::max(peaks[j].at, peaks[k].at); ++i)
        saddle = std::min(saddle, f[i]);
      const double stands_out = (peaks[k].height - saddle) / (0.2 * peaks[k].height);
      maxima.prominence[k] = std::min(maxima.prominence[k], 1 - smoothFall(stands_out));
    }
  }
  maxima.count = count;
}

}  // namespace

struct ContactForce::Point {
  Eigen::Vector3d p_P;                                             // on the feature's axis
  geometry::SignedDistance nearest;
  double depth;
  double weight;
  double t;
};

namespace {

std::vector<Collider> collidersOf(const description::Scene& scene) {
  std::vector<Collider> colliders;
  for (int i = 0; i < static_cast<int>(scene.objects.size()); ++i)
    for (Collider& collider : objectColliders(scene.objects[i], i)) {
      collider.pose = scene.objects[i].pose * collider.pose;
      colliders.push_back(std::move(collider));
    }
  return colliders;
}

std::vector<SurfacePair> everyPair(const std::vector<Feature>& features, const std::vector<Collider>& colliders,
                                   const description::Scene& scene) {
  std::vector<SurfacePair> pairs;
  for (int f = 0; f < static_cast<int>(features.size()); ++f)
    for (int c = 0; c < static_cast<int>(colliders.size()); ++c)
      pairs.push_back({f, c, description::materialOf(scene, partyOf(features[f].owner), partyOf(colliders[c].owner),
                                                     scene.objects[colliders[c].owner.object].material)});
  return pairs;
}

}  // namespace

ContactForce::ContactForce(const std::vector<Feature>& features, const description::Scene& scene, int bodies,
                           const ContactOptions& options)
    : ContactForce(features, collidersOf(scene), everyPair(features, collidersOf(scene), scene), bodies, options) {}

ContactForce::ContactForce(std::vector<Feature> features, std::vector<Collider> colliders, std::vector<SurfacePair> pairs,
                           int bodies, const ContactOptions& options)
    : options_(options),
      features_(std::move(features)),
      colliders_(std::move(colliders)),
      pairs_(std::move(pairs)),
      burying_(colliders_.size()),
      posed_(colliders_.size()),
      wrenches_(bodies) {
  for (size_t i = 0; i < colliders_.size(); ++i) {
    const Collider& one = colliders_[i];
    posed_[i] = {one.pose.linear(), one.pose.translation()};
    for (size_t j = 0; j < colliders_.size(); ++j) {
      const Collider& other = colliders_[j];
      const double reach = one.shape->boundingRadius() + other.shape->boundingRadius();
      const bool near = (other.pose.translation() - one.pose.translation()).norm() <= reach;
      if (i != j && one.body == other.body && near) burying_[i].push_back(static_cast<int>(j));
    }
  }
  bristles_.assign(pairs_.size(), Bristles::Zero());
  twists_ = bristles_;
  places_.assign(pairs_.size(), Eigen::Matrix<double, most_interior, 1>::Constant(std::nan("")));
  bent_.reserve(pairs_.size());
  touches_.reserve(pairs_.size());
}

const BodyMotion& ContactForce::motionOf(int body, const std::vector<BodyMotion>& bodies) const {
  static const BodyMotion at_rest;
  return body == world_body ? at_rest : bodies[static_cast<size_t>(body)];
}

void ContactForce::pose(const std::vector<BodyMotion>& bodies) {
  for (size_t i = 0; i < colliders_.size(); ++i) {
    const Collider& collider = colliders_[i];
    if (collider.body == world_body) continue;
    const BodyMotion& body = bodies[static_cast<size_t>(collider.body)];
    posed_[i] = {body.R_WB * collider.pose.linear(), body.p_WB + body.R_WB * collider.pose.translation()};
  }
}

void ContactForce::evaluate(const std::vector<BodyMotion>& bodies, double h) {
  touches_.clear();
  std::fill(wrenches_.begin(), wrenches_.end(), BodyWrench());
  pose(bodies);
  for (int i = 0; i < static_cast<int>(pairs_.size()); ++i) {
    const Feature& feature = features_[pairs_[i].feature];
    const Collider& collider = colliders_[pairs_[i].collider];
    const BodyMotion& body = motionOf(feature.body, bodies);
    const geometry::Feeler& feeler = feature.feeler;
    const Eigen::Vector3d middle_W = body.p_WB + body.R_WB * (0.5 * (feeler.from + feeler.to));
    const double reach = feeler.radius + 0.5 * (feeler.to - feeler.from).norm() + collider.shape->boundingRadius();
    if ((middle_W - posed_[pairs_[i].collider].p_WP).squaredNorm() > reach * reach) continue;
    touchPair(i, body, motionOf(collider.body, bodies), h);
  }
}

void ContactForce::touchPair(int pair, const BodyMotion& of_feature, const BodyMotion& of_collider, double h) {
  const geometry::Feeler& feeler = features_[pairs_[pair].feature].feeler;
  const geometry::Shape& shape = *colliders_[pairs_[pair].collider].shape;
  const Posed& posed = posed_[pairs_[pair].collider];
  const Eigen::Vector3d a =
      posed.R_WP.transpose() * (of_feature.p_WB + of_feature.R_WB * feeler.from - posed.p_WP);
  const Eigen::Vector3d axis = posed.R_WP.transpose() * (of_feature.R_WB * (feeler.to - feeler.from));
  const Eigen::Vector3d b = a + axis;
  const double length = axis.norm();
  const double radius = feeler.radius;
  if (shape.distance(a + 0.5 * axis).distance > radius + 0.5 * length) return;

  Point ends[2] = {{a, shape.distance(a), 0, 1, 0}, {b, shape.distance(b), 0, 1, 1}};
  for (Point& end : ends) end.depth = radius - end.nearest.distance;
  Point interior[most_interior];
  const int count =
      length > 0 ? findInterior(shape, a, b, radius, ends[0].depth, ends[1].depth, interior) : 0;
  const bool has_end[2] = {feeler.ends && ends[0].depth > 0, feeler.ends && length > 0 && ends[1].depth > 0};
  if (!has_end[0] && !has_end[1] && count == 0) return;

  touches_.push_back(Touch{.pair = pair});
  Touch& touch = touches_.back();
  for (int i = 0; i < 2; ++i)
    if (has_end[i]) press(ends[i], pair, of_feature, of_collider, h, i, touch);
  int slots[most_interior];
  assignSlots(pair, count, interior, slots);
  for (int i = 0; i < count; ++i) {
    touch.places[slots[i]] = interior[i].t;
    press(interior[i], pair, of_feature, of_collider, h, 2 + slots[i], touch);
  }
  if (touch.depth == 0) touches_.pop_back();                       // wholly buried
}

int ContactForce::findInterior(const geometry::Shape& shape, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                               double radius, double depth_a, double depth_b, Point* points) const {
  const auto pointAt = [&](double t, const geometry::SignedDistance& nearest) -> Point {
    return {a + t * (b - a), nearest, radius - nearest.distance, 4 * t * (1 - t), t};
  };
  if (shape.isConvex()) {
    double t = 0;
    geometry::SignedDistance nearest;
    if (!findInteriorPoint(shape, a, b, radius, depth_a, depth_b, t, nearest)) return 0;
    points[0] = pointAt(t, nearest);
    return 1;
  }
  Maxima maxima;
  findMaxima(shape, a, b, radius, maxima);
  for (int i = 0; i < maxima.count; ++i) {
    points[i] = pointAt(maxima.t[i], shape.distance(a + maxima.t[i] * (b - a)));
    points[i].weight *= maxima.prominence[i];
  }
  return maxima.count;
}

/// Each point keeps the bristle of the last one nearest to it along the axis.
void ContactForce::assignSlots(int pair, int count, const Point* points, int* slots) const {
  bool taken[most_interior] = {};
  for (int i = 0; i < count; ++i) {
    int best = -1;
    double nearest = 0.1;                                          // of the axis: farther away it is another point
    for (int s = 0; s < most_interior; ++s) {
      const double apart = std::abs(points[i].t - places_[pair][s]);  // NaN: nothing stands there
      if (taken[s] || !(apart < nearest)) continue;
      nearest = apart;
      best = s;
    }
    for (int s = 0; s < most_interior && best < 0; ++s)
      if (!taken[s] && std::isnan(places_[pair][s])) best = s;
    for (int s = 0; s < most_interior && best < 0; ++s)
      if (!taken[s]) best = s;
    taken[best] = true;
    slots[i] = best;
  }
}

void ContactForce::press(const Point& point, int pair, const BodyMotion& of_feature, const BodyMotion& of_collider,
                         double h, int slot, Touch& touch) {
  const Feature& feature = features_[pairs_[pair].feature];
  const int c = pairs_[pair].collider;
  const Posed& posed = posed_[c];
  const Eigen::Vector3d surface_P = point.p_P - point.nearest.distance * point.nearest.gradient;
  const Eigen::Vector3d surface_W = posed.p_WP + posed.R_WP * surface_P;
  const Eigen::Vector3d normal_W = -(posed.R_WP * point.nearest.gradient);
  const double share = point.weight * feature.feeler.share * exposure(c, surface_W);
  if (share <= 0) return;

  const description::ContactMaterial& material = pairs_[pair].material;
  const Eigen::Vector3d arm_W = surface_W - of_feature.p_WB, other_arm_W = surface_W - of_collider.p_WB;
  const Eigen::Vector3d velocity_W = of_feature.linear_W + of_feature.angular_W.cross(arm_W) - of_collider.linear_W -
                                     of_collider.angular_W.cross(other_arm_W);
  const double depth_rate = velocity_W.dot(normal_W);
  const double stiffness = share * material.stiffness;
  const double normal_N = std::clamp(stiffness * point.depth * (1 + material.dissipation * depth_rate), 0.0,
                                     options_.force_limit);

  const Eigen::Vector3d slip_W = velocity_W - depth_rate * normal_W;
  const double friction_N = material.friction * normal_N;
  const double bristle_stiffness = options_.bristle_stiffness_ratio * stiffness;
  const bool stays = slot < 2 || std::abs(point.t - places_[pair][slot - 2]) < 0.1;
  Eigen::Vector3d bend_W = Eigen::Vector3d::Zero();
  if (stays) bend_W = bristles_[pair].col(slot);
  bend_W += h * (slip_W + of_collider.angular_W.cross(bend_W));
  bend_W -= bend_W.dot(normal_W) * normal_W;                       // the normal turns as the point moves
  const double elastic_N = bristle_stiffness * bend_W.norm();
  if (elastic_N > friction_N) bend_W *= friction_N / elastic_N;
  Eigen::Vector3d friction_W = bristle_stiffness * (bend_W + options_.bristle_relaxation * slip_W);
  const double asked_N = friction_W.norm();
  if (asked_N > friction_N) friction_W *= friction_N / asked_N;

  Eigen::Vector3d torque_W = Eigen::Vector3d::Zero();              // of the feature's body on the collider's
  if (material.rolling > 0 && feature.feeler.radius > 0) {
    const double rolling_Nm = material.rolling * normal_N;
    const double twist_stiffness = bristle_stiffness * feature.feeler.radius * feature.feeler.radius;
    const Eigen::Vector3d turning_W = of_feature.angular_W - of_collider.angular_W;
    Eigen::Vector3d twist_W = Eigen::Vector3d::Zero();
    if (stays) twist_W = twists_[pair].col(slot);
    twist_W += h * (turning_W + of_collider.angular_W.cross(twist_W));
    const double elastic_Nm = twist_stiffness * twist_W.norm();
    if (elastic_Nm > rolling_Nm) twist_W *= rolling_Nm / elastic_Nm;
    torque_W = twist_stiffness * (twist_W + options_.bristle_relaxation * turning_W);
    const double asked_Nm = torque_W.norm();
    if (asked_Nm > rolling_Nm) torque_W *= rolling_Nm / asked_Nm;
    touch.twists.col(slot) = twist_W;
  }

  const Eigen::Vector3d force_W = normal_N * normal_W + friction_W;
  if (feature.body != world_body) {
    BodyWrench& wrench = wrenches_[feature.body];
    wrench.force_W -= force_W;
    wrench.torque_W -= arm_W.cross(force_W) + torque_W;
  }
  if (colliders_[c].body != world_body) {
    BodyWrench& wrench = wrenches_[colliders_[c].body];
    wrench.force_W += force_W;
    wrench.torque_W += other_arm_W.cross(force_W) + torque_W;
  }
  touch.bristles.col(slot) = bend_W;
  touch.weight_N += normal_N;
  touch.weighted_point_W += normal_N * surface_W;
  touch.normal_force_W += normal_N * normal_W;
  touch.friction_force_W += friction_W;
  if (point.depth > touch.depth) {
    touch.depth = point.depth;
    touch.deepest_point_W = surface_W;
    touch.deepest_normal_W = normal_W;
  }
}

double ContactForce::exposure(int collider, const Eigen::Vector3d& surface_point_W) const {
  double exposure = 1;
  for (int j : burying_[collider]) {
    const geometry::Shape& other = *colliders_[j].shape;
    const Eigen::Vector3d offset_W = surface_point_W - posed_[j].p_WP;
    if (offset_W.squaredNorm() > other.boundingRadius() * other.boundingRadius()) continue;
    const double burial = -other.distance(posed_[j].R_WP.transpose() * offset_W).distance;
    exposure *= smoothFall(burial / options_.burial_fade);
  }
  return exposure;
}

void ContactForce::clear() {
  for (int pair : bent_) {
    bristles_[pair].setZero();
    twists_[pair].setZero();
    places_[pair].setConstant(std::nan(""));
  }
  bent_.clear();
}

void ContactForce::commit() {
  clear();
  for (const Touch& touch : touches_) {
    bristles_[touch.pair] = touch.bristles;
    twists_[touch.pair] = touch.twists;
    places_[touch.pair] = touch.places;
    bent_.push_back(touch.pair);
  }
}

void ContactForce::archive(control::Archive& archive) {
  std::size_t pairs = pairs_.size();
  archive("pairs", pairs);
  if (pairs != pairs_.size())
    throw control::StateError("the state is of " + std::to_string(pairs) + " pairs of surfaces, this scene and robot have " +
                              std::to_string(pairs_.size()));
  std::vector<Bent> all;
  for (int pair : bent_) all.push_back({pair, bristles_[pair], twists_[pair], places_[pair]});
  archive.growing("bent", all);
  if (!archive.restores()) return;
  for (const Bent& bent : all)
    if (bent.pair < 0 || bent.pair >= static_cast<int>(pairs_.size()))
      throw control::StateError("the state has bristles of a pair of surfaces that there is not");
  clear();
  for (const Bent& bent : all) {
    bristles_[bent.pair] = bent.bristles;
    twists_[bent.pair] = bent.twists;
    places_[bent.pair] = bent.places;
    bent_.push_back(bent.pair);
  }
}

void ContactForce::read(std::vector<control::ContactRecord>& records) const {
  records.clear();
  for (const Touch& touch : touches_) {
    const SurfacePair& pair = pairs_[touch.pair];
    const Owner &by = features_[pair.feature].owner, &on = colliders_[pair.collider].owner;
    if (by.link < 0 && on.link < 0) continue;                      // objects among themselves
    control::ContactRecord record;
    record.depth = touch.depth;
    record.point_W = touch.deepest_point_W;
    record.normal_W = touch.deepest_normal_W;
    const double normal_norm_N = touch.normal_force_W.norm();
    if (touch.weight_N > 0 && normal_norm_N > 0) {
      // The mean of several points of a curved surface lies under it: bring it back up.
      const Posed& posed = posed_[pair.collider];
      const Eigen::Vector3d mean_P = posed.R_WP.transpose() * (touch.weighted_point_W / touch.weight_N - posed.p_WP);
      const geometry::SignedDistance nearest = colliders_[pair.collider].shape->distance(mean_P);
      record.point_W = posed.p_WP + posed.R_WP * (mean_P - nearest.distance * nearest.gradient);
      record.normal_W = touch.normal_force_W / normal_norm_N;
    }
    const Eigen::Vector3d force_W = touch.normal_force_W + touch.friction_force_W;
    record.force_N = force_W.dot(record.normal_W);
    record.friction_W = force_W - record.force_N * record.normal_W;
    record.link = by.link;
    record.object = on.object;
    record.other_link = on.link;
    if (by.link < 0) {                                             // an object's feature on a link: seen from the link
      record.link = on.link;
      record.object = by.object;
      record.other_link = -1;
      record.normal_W = -record.normal_W;
      record.friction_W = -record.friction_W;
    }
    records.push_back(record);
  }
}

}  // namespace tactus::sim
