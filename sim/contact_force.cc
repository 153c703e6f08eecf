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

}  // namespace

struct ContactForce::Point {
  Eigen::Vector3d p_P;                                             // on the capsule's axis
  geometry::SignedDistance nearest;
  double depth;
  double weight;
};

ContactForce::ContactForce(const std::vector<LinkFeature>& features, const description::Scene& scene, int bodies,
                           const ContactOptions& options)
    : options_(options), features_(features), wrenches_(bodies) {
  for (int i = 0; i < static_cast<int>(scene.objects.size()); ++i) {
    const description::Object& object = scene.objects[i];
    for (const description::Primitive& primitive : object.primitives) {
      const Eigen::Isometry3d X_WP = object.pose * primitive.pose;
      primitives_.push_back({i, primitive.shape, X_WP.linear(), X_WP.translation(), primitive.shape->boundingRadius(),
                             object.material, {}});
    }
  }
  for (ScenePrimitive& one : primitives_)
    for (int j = 0; j < static_cast<int>(primitives_.size()); ++j) {
      const ScenePrimitive& other = primitives_[j];
      const bool near = (other.p_WP - one.p_WP).norm() <= other.bounding_radius + one.bounding_radius;
      if (&other != &one && near) one.overlapping.push_back(j);
    }
  bristles_.assign(capacity(), Bristles::Zero());
  bent_.reserve(capacity());
  touches_.reserve(capacity());
}

void ContactForce::evaluate(const std::vector<BodyMotion>& bodies, double h) {
  touches_.clear();
  std::fill(wrenches_.begin(), wrenches_.end(), BodyWrench());
  for (int f = 0; f < static_cast<int>(features_.size()); ++f) {
    const LinkFeature& feature = features_[f];
    const BodyMotion& body = bodies[feature.body];
    const Eigen::Vector3d middle_W = body.p_WB + body.R_WB * (0.5 * (feature.from + feature.to));
    const double reach = feature.radius + 0.5 * (feature.to - feature.from).norm();
    for (int p = 0; p < static_cast<int>(primitives_.size()); ++p) {
      const ScenePrimitive& primitive = primitives_[p];
      const double limit = reach + primitive.bounding_radius;
      if ((middle_W - primitive.p_WP).squaredNorm() > limit * limit) continue;
      touchPair(f, p, body, h);
    }
  }
}

void ContactForce::touchPair(int f, int p, const BodyMotion& body, double h) {
  const LinkFeature& feature = features_[f];
  const ScenePrimitive& primitive = primitives_[p];
  const geometry::Shape& shape = *primitive.shape;
  const Eigen::Vector3d a = primitive.R_WP.transpose() * (body.p_WB + body.R_WB * feature.from - primitive.p_WP);
  const Eigen::Vector3d axis = primitive.R_WP.transpose() * (body.R_WB * (feature.to - feature.from));
  const Eigen::Vector3d b = a + axis;
  const double length = axis.norm();
  const double radius = feature.radius;
  if (shape.distance(a + 0.5 * axis).distance > radius + 0.5 * length) return;

  Point ends[2] = {{a, shape.distance(a), 0, 1}, {b, shape.distance(b), 0, 1}};
  for (Point& end : ends) end.depth = radius - end.nearest.distance;
  Point interior = {};
  double t = 0;
  const bool has_interior = length > 0 && findInteriorPoint(shape, a, b, radius, ends[0].depth, ends[1].depth, t,
                                                            interior.nearest);
  const bool has_end[2] = {ends[0].depth > 0, length > 0 && ends[1].depth > 0};
  if (!has_end[0] && !has_end[1] && !has_interior) return;

  touches_.push_back(Touch{.feature = f, .primitive = p});
  Touch& touch = touches_.back();
  for (int i = 0; i < 2; ++i)
    if (has_end[i]) press(ends[i], primitive, body, h, i, touch);
  if (has_interior) {
    interior.p_P = a + t * axis;
    interior.depth = radius - interior.nearest.distance;
    interior.weight = 4 * t * (1 - t);
    press(interior, primitive, body, h, 2, touch);
  }
  if (touch.depth == 0) touches_.pop_back();                       // wholly buried
}

void ContactForce::press(const Point& point, const ScenePrimitive& primitive, const BodyMotion& body, double h,
                         int slot, Touch& touch) {
  const Eigen::Vector3d surface_P = point.p_P - point.nearest.distance * point.nearest.gradient;
  const Eigen::Vector3d surface_W = primitive.p_WP + primitive.R_WP * surface_P;
  const Eigen::Vector3d normal_W = -(primitive.R_WP * point.nearest.gradient);
  const double share = point.weight * exposure(primitive, surface_W);
  if (share <= 0) return;

  const description::ContactMaterial& material = primitive.material;
  const Eigen::Vector3d arm_W = surface_W - body.p_WB;
  const Eigen::Vector3d velocity_W = body.linear_W + body.angular_W.cross(arm_W);
  const double depth_rate = velocity_W.dot(normal_W);
  const double stiffness = share * material.stiffness;
  const double normal_N = std::clamp(stiffness * point.depth * (1 + material.dissipation * depth_rate), 0.0,
                                     options_.force_limit);

  const Eigen::Vector3d slip_W = velocity_W - depth_rate * normal_W;
  const double friction_N = material.friction * normal_N;
  const double bristle_stiffness = options_.bristle_stiffness_ratio * stiffness;
  Eigen::Vector3d bend_W = bristles_[pairIndex(touch)].col(slot) + h * slip_W;
  bend_W -= bend_W.dot(normal_W) * normal_W;                       // the normal turns as the point moves
  const double elastic_N = bristle_stiffness * bend_W.norm();
  if (elastic_N > friction_N) bend_W *= friction_N / elastic_N;
  Eigen::Vector3d friction_W = bristle_stiffness * (bend_W + options_.bristle_relaxation * slip_W);
  const double asked_N = friction_W.norm();
  if (asked_N > friction_N) friction_W *= friction_N / asked_N;

  BodyWrench& wrench = wrenches_[features_[touch.feature].body];
  const Eigen::Vector3d force_W = normal_N * normal_W + friction_W;
  wrench.force_W -= force_W;
  wrench.torque_W -= arm_W.cross(force_W);
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

double ContactForce::exposure(const ScenePrimitive& primitive, const Eigen::Vector3d& surface_point_W) const {
  double exposure = 1;
  for (int j : primitive.overlapping) {
    const ScenePrimitive& other = primitives_[j];
    const Eigen::Vector3d offset_W = surface_point_W - other.p_WP;
    if (offset_W.squaredNorm() > other.bounding_radius * other.bounding_radius) continue;
    const double burial = -other.shape->distance(other.R_WP.transpose() * offset_W).distance;
    exposure *= smoothFall(burial / options_.burial_fade);
  }
  return exposure;
}

void ContactForce::commit() {
  for (int pair : bent_) bristles_[pair].setZero();
  bent_.clear();
  for (const Touch& touch : touches_) {
    bristles_[pairIndex(touch)] = touch.bristles;
    bent_.push_back(pairIndex(touch));
  }
}

void ContactForce::read(std::vector<control::ContactRecord>& records) const {
  records.clear();
  for (const Touch& touch : touches_) {
    const ScenePrimitive& primitive = primitives_[touch.primitive];
    control::ContactRecord record;
    record.link = features_[touch.feature].link;
    record.object = primitive.object;
    record.depth = touch.depth;
    record.point_W = touch.deepest_point_W;
    record.normal_W = touch.deepest_normal_W;
    const double normal_norm_N = touch.normal_force_W.norm();
    if (touch.weight_N > 0 && normal_norm_N > 0) {
      // The mean of several points of a curved surface lies under it: bring it back up.
      const Eigen::Vector3d mean_P =
          primitive.R_WP.transpose() * (touch.weighted_point_W / touch.weight_N - primitive.p_WP);
      const geometry::SignedDistance nearest = primitive.shape->distance(mean_P);
      record.point_W = primitive.p_WP + primitive.R_WP * (mean_P - nearest.distance * nearest.gradient);
      record.normal_W = touch.normal_force_W / normal_norm_N;
    }
    const Eigen::Vector3d force_W = touch.normal_force_W + touch.friction_force_W;
    record.force_N = force_W.dot(record.normal_W);
    record.friction_W = force_W - record.force_N * record.normal_W;
    records.push_back(record);
  }
}

}  // namespace tactus::sim
